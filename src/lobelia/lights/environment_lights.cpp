// Structured importance sampling of environments [Agarwal03: Agarwal, Ramamoorthi, Belongie and
// Jensen 2003, "Structured Importance Sampling of Environment Maps", SIGGRAPH].
//
// The sphere is divided into strata of about equal importance, energy x (solid angle)^(1/4)
// [Agarwal03 section 3, the metric with p = 1, q = 1/4: the power of the solid angle allows for
// occlusion, whose variance grows with a stratum's size]. One directional light stands for each,
// with the stratum's integrated radiance ("pre-integration" there), so that no energy is lost.
//
// Deviations:
//  - Strata are rectangles of latitude and longitude found by splitting the most important one
//    again and again at the median of its energy (as Debevec 2005 cuts), instead of thresholded
//    layers divided by Hochbaum-Shmoys centres: O(n log n), any count exactly, no level to choose.
//  - A light's direction is drawn in its stratum in proportion to luminance, not put in its middle:
//    the expected light distribution is then the environment's own (for one colour), and another
//    seed gives other directions.
//  - All environments of a scene (and constants) are sampled together, in the frame and at the
//    resolution of the first environment that has an image. Where they are of several light groups,
//    a stratum has one light for each, all in one direction.
#include <map>
#include <queue>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/lights/light_pass.h"

namespace lobelia {
namespace {

constexpr int kMaxGridWidth = 2048;  // wider images: each cell sums a block of their pixels
constexpr float kSolidAnglePower = 0.25f;
constexpr uint64_t kStream = 0x656e7669726f6eull;

bool isEnvironment(const Emitter& e) {
  return e.type == EmitterType::environment || e.type == EmitterType::constant;
}

struct Rect {
  int x0, y0, x1, y1;
};

// Radiance times solid angle over cells of latitude and longitude around the y axis of `frame`.
class SphereGrid {
 public:
  // radiance(d): Rgb
  template <class Radiance>
  SphereGrid(const Scene& scene, size_t count, const Radiance& radiance) {
    choose(scene, count);
    const size_t cells = static_cast<size_t>(width_) * static_cast<size_t>(height_);
    cells_.resize(cells);
    parallelFor(static_cast<size_t>(height_), 4, [&](size_t y) {
      for (int x = 0; x < width_; ++x)
        cells_[index(x, static_cast<int>(y))] = integrate(radiance, x, static_cast<int>(y));
    });
    sumLuminance();
  }

  Rect all() const { return {0, 0, width_, height_}; }
  // Sum of luminance x solid angle.
  double energy(const Rect& r) const {
    return sum(r.x1, r.y1) - sum(r.x0, r.y1) - sum(r.x1, r.y0) + sum(r.x0, r.y0);
  }
  double solidAngle(const Rect& r) const {
    return (r.x1 - r.x0) * (2.0 * kPi / width_) * (cosine(r.y0) - cosine(r.y1));
  }
  Rgb integral(const Rect& r) const {
    Vec3d total;
    for (int y = r.y0; y < r.y1; ++y)
      for (int x = r.x0; x < r.x1; ++x) {
        const Rgb c = cells_[index(x, y)];
        total += Vec3d(c.x, c.y, c.z);
      }
    return Rgb(static_cast<float>(total.x), static_cast<float>(total.y),
               static_cast<float>(total.z));
  }
  bool divisible(const Rect& r) const { return r.x1 - r.x0 > 1 || r.y1 - r.y0 > 1; }

  // Cuts across the longer side, where half of the energy lies on either side.
  void split(const Rect& r, Rect* a, Rect* b) const {
    const double middle = 0.5 * (r.y0 + r.y1) * kPi / height_;
    const double wide = (r.x1 - r.x0) * (2.0 * kPi / width_) * std::sin(middle);
    const double high = (r.y1 - r.y0) * (1.0 * kPi / height_);
    const bool acrossX = r.y1 - r.y0 <= 1 || (r.x1 - r.x0 > 1 && wide >= high);
    *a = *b = r;
    int& end = acrossX ? a->x1 : a->y1;
    int low = (acrossX ? r.x0 : r.y0) + 1, top = (acrossX ? r.x1 : r.y1) - 1;
    const double half = 0.5 * energy(r);
    while (low < top) {  // first cut with at least half of the energy before it
      end = (low + top) / 2;
      if (energy(*a) < half)
        low = end + 1;
      else
        top = end;
    }
    // The cut just before may balance better.
    const int first = (acrossX ? r.x0 : r.y0) + 1;
    end = low;
    const double after = std::abs(energy(*a) - half);
    if (low > first) {
      end = low - 1;
      if (std::abs(energy(*a) - half) >= after) end = low;
    }
    (acrossX ? b->x0 : b->y0) = end;
  }

  // A direction in r drawn in proportion to luminance.
  Vec3f sampleDirection(const Rect& r, Rng& rng) const {
    double left = rng.next1D() * energy(r);
    int y = r.y0, x = r.x0;
    for (; y < r.y1 - 1; ++y) {
      const double row = energy({r.x0, y, r.x1, y + 1});
      if (left < row) break;
      left -= row;
    }
    for (; x < r.x1 - 1; ++x) {
      const double cell = energy({x, y, x + 1, y + 1});
      if (left < cell) break;
      left -= cell;
    }
    const Vec2f u = rng.next2D();
    const double c = cosine(y) + (cosine(y + 1) - cosine(y)) * u.y;
    return direction((x + static_cast<double>(u.x)) * 2.0 * kPi / width_, c);
  }

 private:
  size_t index(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }
  double cosine(int y) const { return std::cos(y * (1.0 * kPi / height_)); }
  double sum(int x, int y) const {
    return sums_[static_cast<size_t>(y) * (static_cast<size_t>(width_) + 1) +
                 static_cast<size_t>(x)];
  }
  // phi as Mitsuba's maps have it, so that cells lie on the image's pixels.
  Vec3f direction(double phi, double cosTheta) const {
    const double sine = std::sqrt(std::max(0.0, 1 - cosTheta * cosTheta));
    const Vec3f local(static_cast<float>(std::sin(phi) * sine), static_cast<float>(cosTheta),
                      static_cast<float>(-std::cos(phi) * sine));
    return normalize(frame_.vector(local));
  }

  void choose(const Scene& scene, size_t count) {
    const double wanted = std::sqrt(64.0 * static_cast<double>(std::min<size_t>(count, 1u << 20)));
    const int least = std::clamp(static_cast<int>(wanted) * 2, 128, kMaxGridWidth);
    width_ = least;
    height_ = least / 2;
    for (const Emitter& e : scene.emitters) {
      if (e.type != EmitterType::environment || !e.image.valid()) continue;
      frame_ = e.toWorld;
      const Image& image = scene[e.image];
      if (image.width <= 0 || image.height <= 0) break;
      const int up = (least + image.width - 1) / image.width;
      block_ = (image.width + kMaxGridWidth - 1) / kMaxGridWidth;
      width_ = (image.width * up + block_ - 1) / block_;
      height_ = std::max(1, (image.height * up + block_ - 1) / block_);
      break;
    }
  }

  template <class Radiance>
  Rgb integrate(const Radiance& radiance, int x, int y) const {
    const double dPhi = 2.0 * kPi / width_ / block_, dTheta = 1.0 * kPi / height_ / block_;
    Vec3d total;
    for (int j = 0; j < block_; ++j) {
      const double theta = (y * block_ + j) * dTheta;
      const float solid = static_cast<float>(dPhi * (std::cos(theta) - std::cos(theta + dTheta)));
      for (int i = 0; i < block_; ++i) {
        const Rgb c =
            radiance(direction((x * block_ + i + 0.5) * dPhi, std::cos(theta + 0.5 * dTheta)));
        if (isFinite(c)) total += Vec3d(c.x, c.y, c.z) * static_cast<double>(solid);
      }
    }
    return Rgb(static_cast<float>(total.x), static_cast<float>(total.y),
               static_cast<float>(total.z));
  }

  void sumLuminance() {
    const size_t pitch = static_cast<size_t>(width_) + 1;
    sums_.assign(pitch * (static_cast<size_t>(height_) + 1), 0.0);
    for (int y = 0; y < height_; ++y) {
      double row = 0;
      for (int x = 0; x < width_; ++x) {
        row += luminance(cells_[index(x, y)]);
        const size_t at = (static_cast<size_t>(y) + 1) * pitch + static_cast<size_t>(x) + 1;
        sums_[at] = sums_[at - pitch] + row;
      }
    }
  }

  Transform frame_;
  int width_ = 0, height_ = 0;
  int block_ = 1;  // pixels of the image across a cell
  std::vector<Rgb> cells_;
  std::vector<double> sums_;  // summed-area table of luminance, (width + 1) x (height + 1)
};

struct Stratum {
  double importance;
  size_t id;  // breaks ties
  Rect rect;
  bool operator<(const Stratum& o) const {
    return importance != o.importance ? importance < o.importance : id > o.id;
  }
};

}  // namespace

std::vector<DirectionalLight> environmentLights(const EmitterSampler& emitters, size_t count,
                                                uint64_t seed) {
  const Scene& scene = emitters.scene();
  const LightGroups& groups = emitters.groups();
  std::map<uint16_t, uint32_t> firsts;  // first environment of every group that has any
  for (uint32_t i = 0; i < scene.emitters.size(); ++i)
    if (isEnvironment(scene.emitters[i])) firsts.emplace(groups.of(i), i);
  if (count == 0 || firsts.empty()) return {};
  const SphereGrid grid(scene, count, [&](Vec3f d) { return emitters.environment(d); });
  if (!(grid.energy(grid.all()) > 0)) return {};

  std::priority_queue<Stratum> open;
  std::vector<Rect> done;  // single cells
  size_t made = 0;
  const auto add = [&](const Rect& r) {
    if (!grid.divisible(r)) return done.push_back(r);
    const double size = std::pow(grid.solidAngle(r), static_cast<double>(kSolidAnglePower));
    open.push({grid.energy(r) * size, made++, r});
  };
  add(grid.all());
  while (!open.empty() && open.size() + done.size() < count) {
    const Rect r = open.top().rect;
    open.pop();
    Rect a, b;
    grid.split(r, &a, &b);
    add(a), add(b);
  }
  for (; !open.empty(); open.pop()) done.push_back(open.top().rect);

  Rng rng(seed, kStream);
  std::vector<DirectionalLight> lights;
  lights.reserve(done.size());
  const auto addLights = [&](const SphereGrid& part, uint32_t emitter, auto&& directionOf) {
    for (size_t i = 0; i < done.size(); ++i) {
      const Rgb irradiance = part.integral(done[i]);
      if (maxComponent(irradiance) > 0) lights.push_back({directionOf(i), irradiance, emitter});
    }
  };
  if (firsts.size() == 1) {
    addLights(grid, firsts.begin()->second,
              [&](size_t i) { return grid.sampleDirection(done[i], rng); });
    return lights;
  }
  std::vector<Vec3f> directions;
  for (const Rect& r : done) directions.push_back(grid.sampleDirection(r, rng));
  for (const auto& [group, emitter] : firsts) {
    const size_t g = group;
    const SphereGrid part(scene, count, [&](Vec3f d) { return emitters.environment(d, g); });
    addLights(part, emitter, [&](size_t i) { return directions[i]; });
  }
  return lights;
}

std::vector<DirectionalLight> environmentLights(const Scene& scene, size_t count, uint64_t seed) {
  return environmentLights(EmitterSampler(scene, bounds(scene)), count, seed);
}

}  // namespace lobelia
