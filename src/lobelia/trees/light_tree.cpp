#include "lobelia/trees/light_tree.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::trees {
namespace {

// A difference of directions of 1 counts as much as this share of the scene's size.
constexpr float kDirectionShare = 0.05f;
constexpr int kExtents = 6;

float diffusePower(float intensity) { return kPi * intensity; }
float power(const LightNode& node) { return diffusePower(node.diffuse) + node.glossy; }

LightNode leafOf(const TreeLight& light, uint32_t place) {
  LightNode node;
  node.centre = light.p;
  node.variance = light.variance;
  node.radius = light.radius;
  node.n = light.n;
  node.diffuse = light.diffuse;
  node.axis = light.axis;
  node.sharpness = light.sharpness;
  node.glossy = light.glossy;
  node.first = place;
  node.count = 1;
  return node;
}

LightNode merged(const LightNode& a, const LightNode& b) {
  LightNode node;
  node.first = a.first;
  node.count = a.count + b.count;
  const float total = power(a) + power(b);
  // Without power all places count alike.
  const float share = total > 0 ? power(b) / total : 0.5f;
  const Vec3f apart = b.centre - a.centre;
  node.centre = a.centre + apart * share;
  node.variance =
      a.variance + share * (b.variance - a.variance) + share * (1 - share) * dot(apart, apart);
  node.radius = std::max(length(node.centre - a.centre) + a.radius,
                         length(node.centre - b.centre) + b.radius) *
                1.000001f;
  node.n = a.n + share * (b.n - a.n);
  node.diffuse = a.diffuse + b.diffuse;
  node.glossy = a.glossy + b.glossy;
  lobes::Moment moment = lobes::momentOf(a.axis, a.sharpness, a.glossy);
  moment.add(lobes::momentOf(b.axis, b.sharpness, b.glossy));
  if (moment.weight > 0) {
    const lobes::SphericalGaussian lobe = lobes::lobeOf(moment);
    node.axis = lobe.axis;
    node.sharpness = lobe.sharpness;
  }
  return node;
}

class Builder {
 public:
  Builder(const std::vector<TreeLight>& lights, float scale, std::vector<LightNode>* nodes,
          std::vector<uint32_t>* order)
      : lights_(lights),
        inverseScale_(1 / std::max(scale, 1e-30f)),
        nodes_(*nodes),
        order_(*order) {}

  // Level by level down, then up again.
  void run() {
    const uint32_t n = static_cast<uint32_t>(lights_.size());
    order_.resize(n);
    for (uint32_t i = 0; i < n; ++i) order_[i] = i;
    nodes_.resize(2 * lights_.size() - 1);
    std::vector<std::vector<Range>> levels{{{0, 0, n}}};
    while (!levels.back().empty()) {
      const std::vector<Range>& level = levels.back();
      parallelFor(level.size(), level.size() > 64 ? 16 : 1, [&](size_t i) { split(level[i]); });
      std::vector<Range> next;
      for (const Range& range : level) {
        if (range.count == 1) continue;
        const uint32_t half = range.count / 2;
        next.push_back({range.node + 1, range.first, half});
        next.push_back({range.node + 2 * half, range.first + half, range.count - half});
      }
      levels.push_back(std::move(next));
    }
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
      parallelFor(level->size(), 256, [&](size_t i) {
        const Range& range = (*level)[i];
        nodes_[range.node] = range.count == 1 ? leafOf(lights_[order_[range.first]], range.first)
                                              : merged(nodes_[range.node + 1],
                                                       nodes_[range.node + 2 * (range.count / 2)]);
      });
    }
  }

 private:
  struct Range {
    uint32_t node, first, count;
  };

  float coordinate(const TreeLight& light, int dim) const {
    if (dim < 3) return light.p[dim] * inverseScale_;
    return kDirectionShare * (light.mostlyGlossy() ? light.axis : light.n)[dim - 3];
  }

  void split(const Range& range) {
    if (range.count < 2) return;
    float lo[kExtents], hi[kExtents];
    std::fill_n(lo, kExtents, 3.4e38f);
    std::fill_n(hi, kExtents, -3.4e38f);
    const auto begin = order_.begin() + range.first, end = begin + range.count;
    for (auto it = begin; it != end; ++it) {
      for (int d = 0; d < kExtents; ++d) {
        const float x = coordinate(lights_[*it], d);
        lo[d] = std::min(lo[d], x), hi[d] = std::max(hi[d], x);
      }
    }
    int widest = 0;
    for (int d = 1; d < kExtents; ++d)
      if (hi[d] - lo[d] > hi[widest] - lo[widest]) widest = d;
    std::vector<std::pair<float, uint32_t>> keys;
    keys.reserve(range.count);
    for (auto it = begin; it != end; ++it) keys.emplace_back(coordinate(lights_[*it], widest), *it);
    std::nth_element(keys.begin(), keys.begin() + range.count / 2, keys.end());
    for (uint32_t i = 0; i < range.count; ++i) begin[i] = keys[i].second;
  }

  const std::vector<TreeLight>& lights_;
  const float inverseScale_;
  std::vector<LightNode>& nodes_;
  std::vector<uint32_t>& order_;
};

}  // namespace

LightTree::LightTree(const std::vector<TreeLight>& lights, const std::vector<uint32_t>& numbers,
                     float scale) {
  if (lights.empty()) return;
  Builder(lights, scale, &nodes_, &lights_).run();
  for (uint32_t& light : lights_) light = numbers[light];
}

}  // namespace lobelia::trees
