// [Hasan09 section 3.3]: "for each VSL, we search for 10 nearest neighbors, and we set the VSL
// radius to the resulting search radius multiplied by a user-specified constant".
//
// Deviations: neighbours count only on similarly oriented surface, so that spheres do not grow over
// the gap between two walls that both are dense with lights; without a factor the radius is twice
// the distance, where the paper takes 4 to 12 times and leaves an automatic choice as "desirable":
// with the planar indicator smaller spheres have less error (docs/performance.md), and passes shrink
// them further.
#include "lobelia/lights/spherical_radius.h"

#include <algorithm>
#include <limits>
#include <nanoflann.hpp>

#include "lobelia/base/parallel.h"
#include "lobelia/scene/shading.h"

namespace lobelia {
namespace {

constexpr size_t kNeighbours = 10;
constexpr float kLeastCosine = 0.9f;

// Radius over the tenth neighbour's distance when the user names none.
constexpr float kAutomaticFactor = 2.f;

struct Cloud {
  const std::vector<SphericalLight>& lights;
  size_t kdtree_get_point_count() const { return lights.size(); }
  float kdtree_get_pt(size_t i, size_t axis) const { return lights[i].p[static_cast<int>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud, float, uint32_t>,
                                        Cloud, 3, uint32_t>;

// The lit side's normal, octahedral.
uint32_t litNormal(const Scene& scene, const SphericalLight& light) {
  const Vec3f ng = surfacePoint(scene, {0, light.b1, light.b2, light.instance, light.triangle}).ng;
  return encodeOctahedral(dot(ng, decodeOctahedral(light.arriving)) < 0 ? -ng : ng);
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
    tree.findNeighbors(found, query, nanoflann::SearchParams());
    if (found.distance() > 0) return found.distance();
  }
  return 0;
}

}  // namespace

std::vector<float> tenthNeighbourDistances(const Scene& scene,
                                           const std::vector<SphericalLight>& lights) {
  std::vector<float> distances(lights.size());
  if (lights.empty()) return distances;
  std::vector<uint32_t> normals(lights.size());
  parallelFor(lights.size(), 1024, [&](size_t i) { normals[i] = litNormal(scene, lights[i]); });
  const Cloud cloud{lights};
  const Tree tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16));
  parallelFor(lights.size(), 256, [&](size_t i) {
    distances[i] = searchDistance(tree, lights, normals, static_cast<uint32_t>(i));
  });
  // Lights at one and the same place, or a single one.
  Bounds3f bounds;
  for (const SphericalLight& light : lights) bounds.add(light.p);
  const float least = std::max(1e-5f * bounds.radius(), 1e-20f);
  for (float& d : distances) d = std::max(d, least);
  return distances;
}

void chooseRadii(const Scene& scene, const LightSettings& settings, VirtualLights* lights) {
  const std::vector<float> distances = tenthNeighbourDistances(scene, lights->spherical);
  const float factor = settings.radiusFactor > 0 ? settings.radiusFactor : kAutomaticFactor;
  for (size_t i = 0; i < distances.size(); ++i)
    lights->spherical[i].radius = distances[i] * factor * settings.radiusScale;
}

}  // namespace lobelia
