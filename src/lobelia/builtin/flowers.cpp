#include "lobelia/builtin/flowers.h"

#include <cmath>

#include "lobelia/builtin/noise.h"

namespace lobelia::builtin {
namespace {

constexpr int kCells = 3;  // flowers along a side

struct Hit {
  FlowerPart part = FlowerPart::ground;
  float tone = 0;
};

// One flower of radius 1 at the origin, with two leaves and a curl of a stem.
Hit flowerAt(Vec2f p, int petals, float turn) {
  const float r = std::hypot(p.x, p.y), angle = std::atan2(p.y, p.x) + turn;
  if (r < 0.2f) return {FlowerPart::heart, r / 0.2f};
  const float wave = std::cos(0.5f * static_cast<float>(petals) * angle);
  const float edge = 0.55f + 0.42f * std::sqrt(std::abs(wave));
  if (r < edge) return {FlowerPart::petal, r / edge};
  for (const float side : {-1.f, 1.f}) {
    // A leaf between two arcs, pointing away from the flower.
    const float c = std::cos(turn + side * 1.1f), s = std::sin(turn + side * 1.1f);
    const Vec2f q{p.x * c + p.y * s - 1.15f, -p.x * s + p.y * c};
    const float half = 0.22f * (1 - sqr(q.x / 0.5f));
    if (std::abs(q.x) < 0.5f && std::abs(q.y) < half)
      return {FlowerPart::leaf, std::abs(q.y) < 0.025f ? 0.f : 1.f};
  }
  // A spiral that unrolls from the flower.
  const float lap = std::fmod(angle / kTwoPi + 4, 1.f);
  const float spiral = 1.02f + 0.55f * lap;
  if (lap < 0.62f && std::abs(r - spiral) < 0.045f * (1.2f - lap)) return {FlowerPart::stem, lap};
  return {};
}

}  // namespace

FlowerPart flowersAt(Vec2f uv, float* tone) {
  const Vec2f p = uv * static_cast<float>(kCells);
  const int i = static_cast<int>(std::floor(p.x)), j = static_cast<int>(std::floor(p.y));
  Hit best;
  for (int dj = -1; dj <= 1; ++dj)
    for (int di = -1; di <= 1; ++di) {
      const int x = (i + di + 2 * kCells) % kCells, y = (j + dj + 2 * kCells) % kCells;
      const auto random = [&](uint64_t k) { return cellRandom(x, y, 31 + k); };
      const Vec2f centre{static_cast<float>(i + di) + 0.5f + 0.24f * (random(0) - 0.5f),
                         static_cast<float>(j + dj) + 0.5f + 0.24f * (random(1) - 0.5f)};
      const float size = 0.27f + 0.09f * random(2);
      if (std::hypot(p.x - centre.x, p.y - centre.y) > 1.7f * size) continue;  // beyond its leaves
      const Hit hit = flowerAt((p - centre) * (1 / size), 5 + (x + y) % 2 * 3, kTwoPi * random(3));
      if (hit.part > best.part) best = hit;
    }
  *tone = best.tone;
  return best.part;
}

}  // namespace lobelia::builtin
