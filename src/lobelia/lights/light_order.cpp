#include "lobelia/lights/light_order.h"

#include <algorithm>
#include <type_traits>

#include "lobelia/base/morton.h"
#include "lobelia/base/parallel.h"

namespace lobelia {
namespace {

template <class Light>
Vec3f placeOf(const Light& light) {
  return light.p;
}
Vec3f placeOf(const GaussianLight& light) { return light.mean; }

// parallel: what is parallel to the lights, or empty.
template <class Light, class... Parallel>
void sortClass(const Bounds3f& bounds, const std::vector<uint32_t>& ends,
               std::vector<Light>* lights, Parallel*... parallel) {
  const float scale = 1 / std::max(maxComponent(bounds.extent()), 1e-30f);
  size_t begin = 0;
  for (const uint32_t end : ends) {
    std::vector<uint64_t> keys(end - begin);
    parallelFor(keys.size(), 4096, [&](size_t i) {
      const size_t light = begin + i;
      keys[i] = uint64_t{morton((placeOf((*lights)[light]) - bounds.lo) * scale)} << 32 | light;
    });
    parallelSort(&keys);
    const auto permute = [&](auto* values) {
      if (values->empty()) return;
      const std::decay_t<decltype(*values)> old(values->begin() + static_cast<ptrdiff_t>(begin),
                                                values->begin() + end);
      parallelFor(keys.size(), 4096, [&](size_t i) {
        (*values)[begin + i] = old[static_cast<uint32_t>(keys[i]) - begin];
      });
    };
    permute(lights);
    (permute(parallel), ...);
    begin = end;
  }
}

}  // namespace

void sortByPlace(const Bounds3f& bounds, VirtualLights* lights) {
  sortClass(bounds, lights->diffuseDepthEnds, &lights->diffuse);
  sortClass(bounds, lights->glossyDepthEnds, &lights->glossy, &lights->glossyGroups);
  sortClass(bounds, lights->sphericalDepthEnds, &lights->spherical);
  sortClass(bounds, lights->gaussianDepthEnds, &lights->gaussian);
}

void sortByGroup(std::vector<LightPoint>* points) {
  std::vector<uint64_t> keys(points->size());
  parallelFor(keys.size(), 4096, [&](size_t i) {
    const LightPoint& p = (*points)[i];
    keys[i] = uint64_t{p.group} << 48 | uint64_t{p.depth} << 32 | i;
  });
  parallelSort(&keys);
  std::vector<LightPoint> sorted(points->size());
  parallelFor(keys.size(), 4096,
              [&](size_t i) { sorted[i] = (*points)[static_cast<uint32_t>(keys[i])]; });
  points->swap(sorted);
}

}  // namespace lobelia
