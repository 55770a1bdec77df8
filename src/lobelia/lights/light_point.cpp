#include "lobelia/lights/light_point.h"

#include <algorithm>

#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

// depthEnds[d]: number of lights of the depths up to d, which come in order.
void endAt(size_t count, size_t depth, std::vector<uint32_t>* ends) {
  ends->resize(std::max(ends->size(), depth + 1), ends->empty() ? 0 : ends->back());
  ends->back() = static_cast<uint32_t>(count);
}

}  // namespace

void addPointLights(std::span<const LightPoint> points, VirtualLights* lights) {
  std::vector<uint32_t> order(points.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return points[a].depth < points[b].depth; });
  for (const uint32_t i : order) {
    const LightPoint& point = points[i];
    if (maxComponent(point.diffuse) > 0) {
      lights->diffuse.push_back({point.p, point.diffuse * kInvPi, encodeOctahedral(point.n),
                                 uint32_t{point.depth} | uint32_t{point.group} << 8});
      endAt(lights->diffuse.size(), point.depth, &lights->diffuseDepthEnds);
    }
    if (maxComponent(point.glossy) > 0) {
      lights->glossy.push_back(
          {point.p, point.n, point.axis,
           point.glossy * lobes::clippedPeak(dot(point.axis, point.n), point.sharpness),
           point.sharpness});
      lights->glossyGroups.push_back(point.group);
      endAt(lights->glossy.size(), point.depth, &lights->glossyDepthEnds);
    }
  }
}

}  // namespace lobelia
