#include "lobelia/builtin/pile.h"

#include <algorithm>
#include <cmath>

namespace lobelia::builtin {

Pile::Pile(float halfSize, int cells, const std::function<float(Vec2f)>& ground)
    : half_(halfSize), size_(2 * halfSize / static_cast<float>(cells)), cells_(cells) {
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) height_.push_back(ground(centreOf(x, y)));
  blocked_.resize(height_.size());
}

Vec2f Pile::centreOf(int x, int y) const {
  return {(static_cast<float>(x) + 0.5f) * size_ - half_,
          (static_cast<float>(y) + 0.5f) * size_ - half_};
}

size_t Pile::cellOf(Vec2f at) const {
  const auto index = [&](float v) {
    return static_cast<size_t>(std::clamp(static_cast<int>((v + half_) / size_), 0, cells_ - 1));
  };
  return index(at.y) * static_cast<size_t>(cells_) + index(at.x);
}

// f(cell, offset from the centre).
template <class F>
void Pile::forCellsIn(Vec2f at, float radius, const F& f) const {
  const auto from = [&](float v) {
    return std::max(static_cast<int>((v - radius + half_) / size_), 0);
  };
  const auto to = [&](float v) {
    return std::min(static_cast<int>((v + radius + half_) / size_), cells_ - 1);
  };
  for (int y = from(at.y); y <= to(at.y); ++y)
    for (int x = from(at.x); x <= to(at.x); ++x) {
      const Vec2f d = centreOf(x, y) - at;
      if (d.x * d.x + d.y * d.y <= radius * radius)
        f(static_cast<size_t>(y) * static_cast<size_t>(cells_) + static_cast<size_t>(x), d);
    }
}

float Pile::heightAt(Vec2f at) const { return height_[cellOf(at)]; }

float Pile::meanHeight(Vec2f at, float radius) const {
  float sum = 0, count = 0;
  forCellsIn(at, radius, [&](size_t cell, Vec2f) { sum += height_[cell], ++count; });
  return count > 0 ? sum / count : heightAt(at);
}

bool Pile::isBlocked(Vec2f at) const { return blocked_[cellOf(at)]; }

void Pile::block(Vec2f at, float radius) {
  forCellsIn(at, radius, [&](size_t cell, Vec2f) { blocked_[cell] = true; });
}

Mat4 Pile::settle(Vec2f at, float radius, float halfThickness, float randomTilt, Rng& rng) {
  Vec2f slope;
  float squares = 0;
  forCellsIn(at, radius, [&](size_t cell, Vec2f d) {
    slope = slope + d * height_[cell];
    squares += d.x * d.x;
  });
  slope = squares > 0 ? slope * (1 / squares) : Vec2f();
  slope = slope + (rng.next2D() - Vec2f(0.5f, 0.5f)) * (2 * randomTilt);
  const float steepness = std::hypot(slope.x, slope.y);
  if (steepness > 1.1f) slope = slope * (1.1f / steepness);
  const Vec3f up = normalize(Vec3f(-slope.x, 1, -slope.y));
  // The disc's plane at the centre, as low as what is under it allows.
  float level = -1e4f;
  forCellsIn(at, radius * up.y, [&](size_t cell, Vec2f d) {
    level = std::max(level, height_[cell] - slope.x * d.x - slope.y * d.y);
  });
  if (level < -1e3f) level = heightAt(at);
  const float thickness = halfThickness / up.y;
  forCellsIn(at, radius * up.y, [&](size_t cell, Vec2f d) {
    height_[cell] = level + slope.x * d.x + slope.y * d.y + 2 * thickness;
  });
  const float spin = kTwoPi * rng.next1D();
  const Vec3f side = normalize(cross(Vec3f(std::cos(spin), 0, std::sin(spin)), up));
  const Vec3f ahead = cross(side, up);
  const Vec3f centre{at.x, level + thickness, at.y};
  Mat4 m;
  for (int i = 0; i < 3; ++i) {
    const auto row = static_cast<size_t>(i);
    m.m[row] = {static_cast<double>(side[i]), static_cast<double>(up[i]),
                static_cast<double>(ahead[i]), static_cast<double>(centre[i])};
  }
  return m;
}

}  // namespace lobelia::builtin
