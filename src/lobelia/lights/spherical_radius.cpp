// [Hasan09 section 3.3]: "for each VSL, we search for 10 nearest neighbors, and we set the VSL
// radius to the resulting search radius multiplied by a user-specified constant".
//
// Deviations: neighbours count only on similarly oriented surface, so that spheres do not grow over
// the gap between two walls that both are dense with lights. Without a factor, where the paper
// takes 4 to 12 times the distance and leaves an automatic choice as "desirable", the radius is
// twice the distance (with the planar indicator smaller spheres have less error:
// docs/performance.md), and at most a share of the harmonic mean distance of what the light's
// surface sees, which is how far indirect light changes little [Ward88 section 3]: in creases,
// where lights are sparse, wide spheres blur contact shadows. But smaller spheres have more noise,
// which the mean over n independent sets has less of: the limit leaves n^(-1/3) of the former (of a
// single set all, and never less than 0.4). Passes shrink the radii further.
#include "lobelia/lights/spherical_radius.h"

#include <algorithm>
#include <limits>

#include "lobelia/base/parallel.h"
#include "lobelia/lights/place_tree.h"
#include "lobelia/scene/shading.h"

namespace lobelia {
namespace {

constexpr size_t kNeighbours = 10;
constexpr float kLeastCosine = 0.9f;

// When the user names no factor: radius over the tenth neighbour's distance; limit of the radius
// over the harmonic mean distance of other surface; the least share of the former that the limit
// leaves, of however many sets.
constexpr float kAutomaticFactor = 2.f;
constexpr float kOpenShare = 0.3f;
constexpr float kLeastShare = 0.4f;

using Tree = PlaceTree<SphericalLight>;

SurfacePoint surfaceOf(const Scene& scene, const SphericalLight& light) {
  return surfacePoint(scene, {0, light.b1, light.b2, light.instance, light.triangle});
}

// Harmonic mean distance of what a light's surface sees on the lit side, by a packet of rays in
// proportion to the cosine.
float harmonicMeanDistance(const Tracer& tracer, const SphericalLight& light) {
  constexpr int kRays = ShadowPacket::kSize;
  constexpr float kGoldenAngle = 2.39996323f;
  const SurfacePoint at = surfaceOf(tracer.scene(), light);
  const Vec3f n = litNormal(at, light), origin = offsetOrigin(at, n);
  const Frame frame = frameFromNormal(n);
  ShadowPacket packet{};
  for (int lane = 0; lane < kRays; ++lane) {
    const float u = (static_cast<float>(lane) + 0.5f) / kRays;
    const float phi = kGoldenAngle * static_cast<float>(lane), sine = std::sqrt(u);
    const Vec3f local{sine * std::cos(phi), sine * std::sin(phi), std::sqrt(1 - u)};
    packet.set(lane, Ray{origin, frame.toWorld(local), 0, 3e38f});
  }
  std::optional<Hit> hits[kRays];
  tracer.intersect(packet, true, hits);
  float sum = 0;
  for (const std::optional<Hit>& hit : hits)
    if (hit) sum += 1 / std::max(hit->t, 1e-20f);
  return sum > 0 ? kRays / sum : 3e38f;
}

// nanoflann's result set: the nearest that are oriented alike. After kMostVisited candidates it
// ends with what it has: a lone leaf among leaves of other directions would search the whole tree.
class OrientedNeighbours {
 public:
  OrientedNeighbours(const std::vector<uint32_t>& normals, uint32_t self, float leastCosine)
      : normals_(normals),
        normal_(decodeOctahedral(normals[self])),
        self_(self),
        leastCosine_(leastCosine) {}

  bool addPoint(float squaredDistance, uint32_t index) {
    ++visited_;
    if (index != self_ && dot(decodeOctahedral(normals_[index]), normal_) >= leastCosine_)
      insert(squaredDistance);
    return visited_ < kMostVisited;
  }
  float worstDist() const {
    if (visited_ >= kMostVisited) return 0;
    return full() ? squares_[kNeighbours - 1] : std::numeric_limits<float>::max();
  }
  bool full() const { return count_ == kNeighbours; }
  size_t size() const { return count_; }
  // Of the tenth, by the density of those found; 0 when none is.
  float distance() const {
    if (count_ == 0) return 0;
    return std::sqrt(squares_[count_ - 1] * static_cast<float>(kNeighbours) /
                     static_cast<float>(count_));
  }

 private:
  static constexpr size_t kMostVisited = 4096;
  void insert(float square) {
    if (full() && squares_[kNeighbours - 1] <= square) return;
    size_t i = full() ? kNeighbours - 1 : count_++;
    for (; i > 0 && squares_[i - 1] > square; --i) squares_[i] = squares_[i - 1];
    squares_[i] = square;
  }

  const std::vector<uint32_t>& normals_;
  Vec3f normal_;
  uint32_t self_;
  float leastCosine_;
  size_t count_ = 0, visited_ = 0;
  float squares_[kNeighbours] = {};
};

float searchDistance(const Tree& tree, const std::vector<SphericalLight>& lights,
                     const std::vector<uint32_t>& normals, uint32_t i) {
  const Vec3f p = lights[i].p;
  const float query[3] = {p.x, p.y, p.z};
  for (const float leastCosine : {kLeastCosine, -2.f}) {
    OrientedNeighbours found(normals, i, leastCosine);
    tree.index().findNeighbors(found, query, nanoflann::SearchParams());
    if (found.distance() > 0) return found.distance();
  }
  return 0;
}

}  // namespace

std::vector<float> tenthNeighbourDistances(const Tracer& tracer,
                                           const std::vector<SphericalLight>& lights) {
  const Scene& scene = tracer.scene();
  std::vector<float> distances(lights.size());
  if (lights.empty()) return distances;
  std::vector<uint32_t> normals(lights.size());
  parallelFor(lights.size(), 1024, [&](size_t i) {
    normals[i] = encodeOctahedral(litNormal(surfaceOf(scene, lights[i]), lights[i]));
  });
  const Tree tree(lights);
  parallelFor(lights.size(), 256, [&](size_t i) {
    distances[i] = searchDistance(tree, lights, normals, static_cast<uint32_t>(i));
  });
  // Lights at one and the same place must not shine from a point; one that is alone shines from a
  // good part of the scene.
  const float sceneRadius = std::max(tracer.bounds().radius(), 1e-12f);
  for (float& d : distances) d = d > 0 ? std::max(d, 1e-5f * sceneRadius) : 0.1f * sceneRadius;
  return distances;
}

Vec3f litNormal(const SurfacePoint& at, const SphericalLight& light) {
  return dot(at.ng, decodeOctahedral(light.arriving)) < 0 ? -at.ng : at.ng;
}

void chooseRadii(const Tracer& tracer, const LightSettings& settings, VirtualLights* lights,
                 Context& context) {
  std::vector<SphericalLight>& all = lights->spherical;
  const std::vector<float> distances = tenthNeighbourDistances(tracer, all);
  const bool automatic = !(settings.radiusFactor > 0);
  const float least = std::max(kLeastShare, 1 / std::cbrt(static_cast<float>(settings.sets)));
  parallelFor(all.size(), 256, [&](size_t i) {
    float radius = distances[i] * (automatic ? kAutomaticFactor : settings.radiusFactor);
    if (automatic && least < 1) {
      const float limit = kOpenShare * harmonicMeanDistance(tracer, all[i]);
      radius = std::min(radius, std::max(limit, least * radius));
    }
    all[i].radius = radius * settings.radiusScale;
  });
  if (automatic && least < 1)
    context.statistics.addCount("path_rays", all.size() * ShadowPacket::kSize);
}

}  // namespace lobelia
