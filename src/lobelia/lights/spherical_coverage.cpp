// Boundary correction of spherical lights (docs/manual.md): the photon light [Hasan09 eq. 2]
// spreads its power over pi r^2 whether or not so much surface lies within its sphere, which loses
// light at edges and in corners; here the power goes to what is there.
#include "lobelia/lights/spherical_coverage.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/lights/spherical_radius.h"

namespace lobelia {
namespace {

constexpr int kCellCount = kDiscCellCount;
constexpr float kHeight = 0.5f;       // of the rays' origin over the light, in radii
constexpr float kDepthRange = 0.35f;  // from the tangent plane, in radii: curved surface counts
constexpr float kLeastCosine = 0.5f;  // between the normals
constexpr float kNearlyWhole = 0.95f;

// Middle of a cell, in radii.
Vec2f cellMiddle(int bit) {
  const auto at = [](int i) { return (static_cast<float>(i) + 0.5f) * (2.f / kDiscCells) - 1; };
  return {at(bit % kDiscCells), at(bit / kDiscCells)};
}

std::array<float, kCellCount> measureShares();
// Area of a cell inside the disc over the disc's area.
const std::array<float, kCellCount>& cellShares() {
  static const std::array<float, kCellCount> shares = measureShares();
  return shares;
}

float coveredShare(const SphericalLight& light) {
  float share = 0;
  for (int bit = 0; bit < kCellCount; ++bit)
    if (coversCell(light, bit)) share += cellShares()[static_cast<size_t>(bit)];
  return share;
}

bool insideDisc(int bit) {
  const Vec2f m = cellMiddle(bit);
  return m.x * m.x + m.y * m.y < 1;
}

// Cells of the corners, whose middle is outside of the disc, share the answer of the next cell
// towards the middle whose middle is inside.
std::array<uint8_t, kCellCount> deputies() {
  std::array<uint8_t, kCellCount> result{};
  for (int bit = 0; bit < kCellCount; ++bit) {
    Vec2f m = cellMiddle(bit);
    const float length = std::sqrt(m.x * m.x + m.y * m.y);
    if (length > 1) m = {m.x / length * 0.95f, m.y / length * 0.95f};
    const auto index = [](float v) {
      return std::clamp(static_cast<int>((v + 1) * (kDiscCells / 2)), 0, kDiscCells - 1);
    };
    result[static_cast<size_t>(bit)] = static_cast<uint8_t>(index(m.y) * kDiscCells + index(m.x));
  }
  return result;
}

class CoverageTest {
 public:
  explicit CoverageTest(const Tracer& tracer) : tracer_(tracer), deputies_(deputies()) {}

  // Returns the number of rays.
  uint64_t cover(SphericalLight* light) const {
    const SurfacePoint at =
        surfacePoint(tracer_.scene(), {0, light->b1, light->b2, light->instance, light->triangle});
    const Vec3f n = litNormal(at, *light);
    const Frame frame = discFrame(n);
    const float r = light->radius;
    const Vec3f origin = light->p + n * (kHeight * r);
    uint64_t bits = 0, rays = 0;
    if (!tracer_.visible(offsetOrigin(at, n), origin)) {
      // In a gap narrower than half the radius: nothing above to look from.
      light->coverage[0] = light->coverage[1] = ~0u;
      return 1;
    }
    for (int first = 0; first < kCellCount; first += ShadowPacket::kSize) {
      ShadowPacket packet{};
      bool any = false;
      for (int lane = 0; lane < ShadowPacket::kSize; ++lane) {
        if (deputies_[static_cast<size_t>(first + lane)] != first + lane) continue;
        const Vec2f m = cellMiddle(first + lane);
        const Vec3f target = light->p + (frame.s * m.x + frame.t * m.y) * r;
        packet.set(lane, Ray{origin, normalize(target - origin), 0, 4 * r});
        any = true, ++rays;
      }
      if (!any) continue;
      std::optional<Hit> hits[ShadowPacket::kSize];
      tracer_.intersect(packet, true, hits);
      for (int lane = 0; lane < ShadowPacket::kSize; ++lane)
        if (packet.active[lane] != 0 && hits[lane] && onSurface(*light, n, *hits[lane]))
          bits |= uint64_t{1} << (first + lane);
    }
    uint64_t all = 0;
    for (int bit = 0; bit < kCellCount; ++bit)
      all |= (bits >> deputies_[static_cast<size_t>(bit)] & 1) << bit;
    // The light's own place is on the surface, whatever rounding says.
    all |= 0x0000001818000000ull;
    light->coverage[0] = static_cast<uint32_t>(all);
    light->coverage[1] = static_cast<uint32_t>(all >> 32);
    return rays + 1;
  }

 private:
  bool onSurface(const SphericalLight& light, Vec3f n, const Hit& hit) const {
    const SurfacePoint at = surfacePoint(tracer_.scene(), hit);
    return std::abs(dot(at.ng, n)) > kLeastCosine &&
           std::abs(dot(at.p - light.p, n)) < kDepthRange * light.radius;
  }

  const Tracer& tracer_;
  std::array<uint8_t, kCellCount> deputies_;
};

std::array<float, kCellCount> measureShares() {
  constexpr int kSteps = 64;  // per cell and axis; exact to 1e-4
  std::array<float, kCellCount> shares{};
  int total = 0;
  std::array<int, kCellCount> inside{};
  for (int y = 0; y < kDiscCells * kSteps; ++y) {
    for (int x = 0; x < kDiscCells * kSteps; ++x) {
      const auto at = [](int i) {
        return (static_cast<float>(i) + 0.5f) * (2.f / (kDiscCells * kSteps)) - 1;
      };
      if (sqr(at(x)) + sqr(at(y)) > 1) continue;
      ++inside[static_cast<size_t>(y / kSteps * kDiscCells + x / kSteps)];
      ++total;
    }
  }
  for (size_t i = 0; i < shares.size(); ++i)
    shares[i] = static_cast<float>(inside[i]) / static_cast<float>(total);
  return shares;
}

// The cell on the surface that takes the power of a cell that is not: its mirror image at the
// boundary by the nearest cell on the surface, or that cell itself.
int mirroredCell(const SphericalLight& light, int bit) {
  const int x = bit % kDiscCells, y = bit / kDiscCells;
  int nearest = -1, smallest = 1 << 20;
  for (int other = 0; other < kCellCount; ++other) {
    if (!coversCell(light, other) || !insideDisc(other)) continue;
    const int dx = other % kDiscCells - x, dy = other / kDiscCells - y;
    if (dx * dx + dy * dy < smallest) smallest = dx * dx + dy * dy, nearest = other;
  }
  const int nx = nearest % kDiscCells, ny = nearest / kDiscCells;
  const auto mirror = [](int from, int at) {  // at the edge of `at` that faces `from`
    return at == from ? at : 2 * at - from - (at > from ? 1 : -1);
  };
  const int mx = mirror(x, nx), my = mirror(y, ny);
  if (mx < 0 || mx >= kDiscCells || my < 0 || my >= kDiscCells) return nearest;
  const int mirrored = my * kDiscCells + mx;
  return coversCell(light, mirrored) && insideDisc(mirrored) ? mirrored : nearest;
}

}  // namespace

std::array<float, kDiscCellCount> cellWeights(const SphericalLight& light) {
  const std::array<float, kCellCount>& shares = cellShares();
  std::array<float, kCellCount> power{};
  for (int bit = 0; bit < kCellCount; ++bit)
    power[static_cast<size_t>(coversCell(light, bit) ? bit : mirroredCell(light, bit))] +=
        shares[static_cast<size_t>(bit)];
  std::array<float, kCellCount> weights;
  for (size_t i = 0; i < power.size(); ++i) weights[i] = shares[i] > 0 ? power[i] / shares[i] : 0.f;
  return weights;
}

void coverSurfaces(const Tracer& tracer, VirtualLights* lights, Context& context) {
  if (lights->sphereShading.indicator == SphereShading::Indicator::cosine) {
    for (SphericalLight& light : lights->spherical) light.coverage[0] = light.coverage[1] = ~0u;
    return;
  }
  const CoverageTest test(tracer);
  std::atomic<uint64_t> rays{0};
  constexpr size_t kBatch = 512;
  parallelFor((lights->spherical.size() + kBatch - 1) / kBatch, 1, [&](size_t b) {
    const size_t end = std::min((b + 1) * kBatch, lights->spherical.size());
    uint64_t count = 0;
    for (size_t i = b * kBatch; i < end; ++i) {
      SphericalLight& light = lights->spherical[i];
      count += test.cover(&light);
      const float share = coveredShare(light);
      if (share > kNearlyWhole) continue;
      light.radius *= std::sqrt(share);
      count += test.cover(&light);
    }
    rays += count;
  });
  context.statistics.addCount("path_rays", rays);
}

}  // namespace lobelia
