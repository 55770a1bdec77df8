#include "lobelia/trees/light_tree.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/trees/median_split.h"

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

using Item = SplitItem<kExtents>;

Item coordinatesOf(const TreeLight& light, float inverseScale, uint32_t number) {
  Item c{};
  c.item = number;
  const Vec3f& direction = light.mostlyGlossy() ? light.axis : light.n;
  for (int d = 0; d < 3; ++d) c.x[d] = light.p[d] * inverseScale;
  for (int d = 0; d < 3; ++d) c.x[3 + d] = kDirectionShare * direction[d];
  return c;
}

}  // namespace

LightTree::LightTree(const std::vector<TreeLight>& lights, const std::vector<uint32_t>& numbers,
                     float scale) {
  if (lights.empty()) return;
  const float inverseScale = 1 / std::max(scale, 1e-30f);
  std::vector<Item> items(lights.size());
  parallelFor(lights.size(), 1024, [&](size_t i) {
    items[i] = coordinatesOf(lights[i], inverseScale, static_cast<uint32_t>(i));
  });
  lights_.resize(lights.size());
  nodes_.resize(2 * lights.size() - 1);
  const auto leaf = [&](uint32_t node, uint32_t place, uint32_t number) {
    lights_[place] = numbers[number];
    nodes_[node] = leafOf(lights[number], place);
  };
  const auto merge = [&](uint32_t node, uint32_t a, uint32_t b) {
    nodes_[node] = merged(nodes_[a], nodes_[b]);
  };
  MedianSplit(&items, 1, leaf, merge).run();
}

}  // namespace lobelia::trees
