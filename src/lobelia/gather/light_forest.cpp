#include "lobelia/gather/light_forest.h"

#include <algorithm>
#include <map>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::gather {
namespace {

constexpr uint64_t kStandsFor = 0x7374616e64;  // of spherical lights that stand for a node

using trees::BoundItem;

BoundItem itemOf(const OmniLight& light) {
  BoundItem item;
  item.p = light.p;
  item.cosine = luminance(light.intensity);
  return item;
}
// Its direction is the axis of a Gaussian, which gives bounds of directions; the places are all
// one.
BoundItem itemOf(const DirectionalLight& light) {
  BoundItem item;
  item.cosine = luminance(light.irradiance);
  item.gaussianCount = 1;
  item.gaussians[0] = {light.direction, 1, item.cosine};
  return item;
}
BoundItem itemOf(const DiffuseLight& light) {
  BoundItem item;
  item.p = light.p;
  item.n = decodeOctahedral(light.normal);
  item.cosine = luminance(light.intensity);
  return item;
}
BoundItem itemOf(const GlossyLight& light) {
  BoundItem item;
  item.p = light.p;
  item.n = light.n;
  item.gaussianCount = 1;
  item.gaussians[0] = {light.axis, light.sharpness, luminance(light.intensity)};
  return item;
}
BoundItem itemOf(const SphericalLight& light, const PreparedSphere& sphere) {
  BoundItem item;
  item.p = light.p;
  item.radius = light.radius;
  if (!sphere.transmits) item.n = sphere.disc.n;
  item.cosine = luminance(light.power * sphere.diffuseColor);
  item.gaussianCount = sphere.gaussianCount;
  for (int i = 0; i < sphere.gaussianCount; ++i) {
    const PreparedSphere::Gaussian& g = sphere.gaussians[i];
    item.gaussians[i] = {g.axis, g.sharpness, luminance(light.power * g.color)};
  }
  return item;
}

// Of the places a sphere that holds nearly all; the leaving light as cosine lobe and Gaussian.
BoundItem itemOf(const GaussianLight& light, const GaussianShading& shading) {
  BoundItem item;
  item.p = light.mean;
  const PreparedGaussian prepared = prepareGaussian(light, shading);
  item.radius = 3 * std::sqrt(prepared.halfTrace);
  if (isFlat(light)) item.n = light.normal;
  item.cosine = luminance(light.diffuse) * kInvPi;
  if (!prepared.glossy.any) return item;
  item.gaussianCount = 1;
  item.gaussians[0] = {light.axis, light.sharpness, luminance(prepared.glossy.peak)};
  return item;
}

class Planter {
 public:
  Planter(const VirtualLights& lights, const Scene& scene, const Bounds3f& bounds,
          const PreparedLights& prepared)
      : lights_(lights), scene_(scene), scale_(2 * bounds.radius()), prepared_(prepared) {}

  // indices: of the lights in the class.
  void plant(LightClass lightClass, const std::vector<uint32_t>& indices, bool apart,
             uint16_t group, LightForest* forest) const {
    if (indices.empty()) return;
    LightForest::Tree& out = forest->trees.emplace_back();
    out.lightClass = lightClass;
    out.apart = apart;
    out.group = group;
    const auto item = [&](uint32_t i) { return boundItem(lightClass, indices[i]); };
    out.tree = trees::BoundTree(static_cast<uint32_t>(indices.size()), item,
                                trees::BoundTree::Side::lights, scale_);
    out.lights.resize(indices.size());
    parallelFor(indices.size(), 4096, [&](size_t i) {
      out.lights[i] = indices[out.tree.item(static_cast<uint32_t>(i))];
    });
    addUp(&out);
  }

 private:
  BoundItem boundItem(LightClass lightClass, size_t index) const {
    const std::vector<PreparedSphere>& spheres = prepared_.spheres;
    if (lightClass != LightClass::spherical || !spheres.empty())
      return boundItemOf(lights_, lightClass, index, spheres.empty() ? nullptr : &spheres[index]);
    PreparedSphere own;
    prepareSphere(scene_, lights_.spherical[index], lights_.specularLimit, &own);
    return boundItemOf(lights_, lightClass, index, &own);
  }

  // Children come after their parent in preorder.
  void addUp(LightForest::Tree* out) const {
    const auto nodes = out->tree.nodes();
    out->power.resize(nodes.size());
    for (uint32_t i = static_cast<uint32_t>(nodes.size()); i-- > 0;) {
      out->power[i] = nodes[i].leaf()
                          ? lightPower(lights_, out->lightClass, out->lights[nodes[i].first])
                          : out->power[out->tree.left(i)] + out->power[out->tree.right(i)];
    }
  }

  const VirtualLights& lights_;
  const Scene& scene_;
  const float scale_;
  const PreparedLights& prepared_;
};

PreparedLight merged(const trees::BoundNode& node, LightClass lightClass, Rgb power) {
  PreparedLight light;
  light.p = light.end = node.centre;
  light.intensity = power;
  if (lightClass == LightClass::directional) light.p = light.end = decodeOctahedral(node.axis);
  if (lightClass != LightClass::diffuse && lightClass != LightClass::glossy) return light;
  light.n = decodeOctahedral(node.n);
  if (lightClass == LightClass::diffuse) return light;
  light.axis = decodeOctahedral(node.axis);
  light.sharpness = node.sharpness;
  light.intensity = power / lobes::integral(node.sharpness);
  light.cutoff = glossyCutoff(node.sharpness);
  return light;
}

}  // namespace

BoundItem boundItemOf(const VirtualLights& lights, LightClass lightClass, size_t index,
                      const PreparedSphere* sphere) {
  switch (lightClass) {
    case LightClass::omni:
      return itemOf(lights.omni[index]);
    case LightClass::directional:
      return itemOf(lights.directional[index]);
    case LightClass::diffuse:
      return itemOf(lights.diffuse[index]);
    case LightClass::spherical:
      return itemOf(lights.spherical[index], *sphere);
    case LightClass::gaussian:
      return itemOf(lights.gaussian[index], lights.gaussianShading);
    case LightClass::glossy:
      break;
  }
  return itemOf(lights.glossy[index]);
}

Rgb lightPower(const VirtualLights& lights, LightClass lightClass, size_t index) {
  switch (lightClass) {
    case LightClass::omni:
      return lights.omni[index].intensity;
    case LightClass::directional:
      return lights.directional[index].irradiance;
    case LightClass::diffuse:
      return lights.diffuse[index].intensity;
    case LightClass::spherical:
      return lights.spherical[index].power;
    case LightClass::gaussian:
      return lights.gaussian[index].diffuse + lights.gaussian[index].glossy;
    case LightClass::glossy:
      break;
  }
  const GlossyLight& light = lights.glossy[index];
  return light.intensity * lobes::integral(light.sharpness);
}

LightForest plantLights(const VirtualLights& lights, const GatherSettings& settings,
                        int receiverDepth, const Scene& scene, const Bounds3f& bounds,
                        const PreparedLights& prepared) {
  LightForest forest;
  const Planter planter(lights, scene, bounds, prepared);
  for (const LightClass lightClass : kLightClasses) {
    const LightRange range = rangeForDepth(lights, lightClass, settings, receiverDepth);
    // By group; first the lights that others stand for.
    std::map<std::pair<uint16_t, bool>, std::vector<uint32_t>> trees;
    for (size_t i = range.begin; i < range.end; ++i) {
      const bool apart =
          lightClass == LightClass::omni && lights.omni[i].emitter != PreparedLight::kNoPattern;
      trees[{groupOf(lights, lightClass, i), apart}].push_back(static_cast<uint32_t>(i));
    }
    for (const auto& [kind, indices] : trees)
      planter.plant(lightClass, indices, kind.second, kind.first, &forest);
  }
  return forest;
}

uint32_t lightOf(const LightForest::Tree& tree, uint32_t node, uint64_t key) {
  double u = static_cast<double>(key >> 11) * 0x1p-53;
  while (!tree.tree.nodes()[node].leaf()) {
    const uint32_t left = tree.tree.left(node), right = tree.tree.right(node);
    const double a = double{luminance(tree.power[left])}, b = double{luminance(tree.power[right])};
    const double share = a + b > 0 ? a / (a + b) : 0.5;
    node = u < share ? left : right;
    u = u < share ? u / share : (u - share) / (1 - share);
    u = std::min(u, 0x1.fffffffffffffp-1);
  }
  return tree.lights[tree.tree.nodes()[node].first];
}

void prepareNodes(const VirtualLights& lights, const Scene& scene, const LightForest::Tree& tree,
                  std::span<const uint32_t> nodes, const PreparedLights& prepared,
                  LightBlock* block) {
  uint32_t indices[kBlockLights];
  for (size_t i = 0; i < nodes.size(); ++i)
    indices[i] = lightOf(tree, nodes[i], hashCombine(kStandsFor, nodes[i]));
  prepareChosen(lights, scene, tree.lightClass, {indices, nodes.size()}, block, prepared);
  for (size_t i = 0; i < nodes.size(); ++i) {
    const trees::BoundNode& node = tree.tree.nodes()[nodes[i]];
    if (node.leaf()) continue;
    PreparedLight& light = block->lights[i];
    if (tree.lightClass == LightClass::spherical || tree.lightClass == LightClass::gaussian) {
      const Rgb power = lightPower(lights, tree.lightClass, indices[i]);
      light.intensity *= luminance(tree.power[nodes[i]]) / std::max(luminance(power), 1e-30f);
    } else {
      light = merged(node, tree.lightClass, tree.power[nodes[i]]);
    }
  }
}

}  // namespace lobelia::gather
