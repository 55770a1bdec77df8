// Bounds of the trees that strategies plant, against what their lights and receivers really send:
// cosine lobes, which the trees hold exactly, in every colour.
#include "gather/oracle.h"
#include "gather/spherical_setup.h"
#include "lobelia/gather/receiver_forest.h"
#include "lobelia/gather/receiver_nodes.h"
#include "lobelia/gather/spherical_paper.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

constexpr int kSamples = 40;  // of a spherical light's integral, each of which is below the bound

class ForestBounds : public testing::Test {
 protected:
  ForestBounds() {
    settings_.direct = true;
    Rng rng(7);
    for (ReceiverPoint& point : receivers_.points) {
      point.p += Vec3f(LitFloor::kMiddle) + Vec3f{0, 0, 1};
      point.ng = point.frame.n;
      point.weight = saturated(&rng);
    }
    for (Lobe& lobe : receivers_.lobes) lobe.weight = saturated(&rng);
  }
  // Mostly of one channel.
  static Rgb saturated(Rng* rng) {
    const Rgb c = randomColor(rng);
    return c * c * c + Rgb(1e-3f);
  }

  // Of every receiver (row) and light (column): its luminance, without visibility.
  void light(const Scene& scene, const VirtualLights& lights, LightClass lightClass, size_t count) {
    values_.assign(receivers_.points.size(), std::vector<double>(count));
    for (size_t first = 0; first < count; first += kBlockLights) {
      LightBlock block;
      prepare(lights, scene, lightClass, first, std::min(kBlockLights, count - first), &block);
      for (size_t i = 0; i < values_.size(); ++i)
        for (size_t l = 0; l < static_cast<size_t>(block.count); ++l)
          values_[i][first + l] =
              double{luminance(receivers_.points[i].weight * pair(i, block, l))};
    }
  }
  Rgb pair(size_t i, const LightBlock& block, size_t l) const {
    const ReceiverPoint& point = receivers_.points[i];
    const PreparedLight& light = block.lights[l];
    const Bsdf bsdf = receiverBsdf(receivers_, point);
    if (block.lightClass == LightClass::spherical) {
      const SpherePair pair{point, bsdf, light, *block.spheres[l], SphereShading().indicator};
      if (length(light.p - point.p) <= pair.sphere.radius) return {};  // the bound is infinite
      Rng rng(i, l);
      Rgb sum{};
      for (int s = 0; s < kSamples; ++s) sum += integrateByCone(pair, &rng) * (1.f / kSamples);
      return sum * light.intensity;
    }
    const Vec3f d = light.p - point.p, w = normalize(d);
    const float facing =
        block.lightClass == LightClass::diffuse ? std::max(-dot(light.n, w), 0.f) : 1.f;
    return evaluate(bsdf, point.wo, w) * light.intensity * (facing / lengthSquared(d));
  }

  void expectBounds(const LightForest& forest) {
    ASSERT_EQ(forest.trees.size(), 1u);
    const LightForest::Tree& lights = forest.trees[0];
    const ReceiverForest planted = plantReceivers(receivers_, 2, false, false);
    for (const ReceiverForest::Tree& tree : planted.trees) expectPairs(tree, lights);
    expectCuts(forest);
    EXPECT_EQ(outside_, 0u);
    EXPECT_GT(lit_, 5000u);
    EXPECT_GT(near_, 500u) << "bounds that say something";
  }
  // Paper mode: random pairs of nodes.
  void expectPairs(const ReceiverForest::Tree& receivers, const LightForest::Tree& lights) {
    Rng rng(4);
    for (int k = 0; k < 20000; ++k) {
      const auto &p = receivers.tree.nodes()[rng.nextUint() % receivers.tree.nodes().size()],
                 &q = lights.tree.nodes()[rng.nextUint() % lights.tree.nodes().size()];
      const PairBounds bounds =
          boundPair({&p, &q}, lights.lightClass, receivers.glossy, BoundForm::tight);
      const uint32_t point = receivers.points[p.first + rng.nextUint() % p.count];
      EXPECT_TRUE(std::isfinite(bounds.value));
      check(point, lights, q, 1, bounds.upper);
      if (lights.lightClass != LightClass::spherical && sumOf(point, lights, q) < bounds.lower)
        ++outside_;
    }
  }
  // Lightcuts: all nodes of lights at every receiver, which has no weight there.
  void expectCuts(const LightForest& forest) {
    NodeBounder bounder(forest, 0);
    std::vector<uint32_t> nodes(forest.trees[0].tree.nodes().size());
    for (uint32_t n = 0; n < nodes.size(); ++n) nodes[n] = n;
    std::vector<NodeBound> bounds(nodes.size());
    for (uint32_t i = 0; i < receivers_.points.size(); ++i) {
      const PointStrip strip = makeTile(receivers_, i, i + 1).strips[0];
      bounder.bound(receiverNodes(receivers_, i, strip), 0, nodes, bounds.data());
      // A weight takes from the largest component at most its own largest.
      const double most = double{maxComponent(receivers_.points[i].weight)};
      for (const uint32_t n : nodes)
        check(i, forest.trees[0], forest.trees[0].tree.nodes()[n], most, bounds[n].upper);
    }
  }
  double sumOf(size_t point, const LightForest::Tree& tree, const trees::BoundNode& node) const {
    double sum = 0;
    for (uint32_t i = node.first; i < node.first + node.count; ++i)
      sum += values_[point][tree.lights[i]];
    return sum;
  }
  // near: of spherical lights a bound has twice the light and all of their places.
  void check(size_t point, const LightForest::Tree& tree, const trees::BoundNode& node,
             double factor, float upper) {
    const double sum = sumOf(point, tree, node), bound = factor * double{upper};
    if (!(sum > 1e-30)) return;
    ++lit_;
    if (sum > 1.0001 * bound) ++outside_;
    if (sum > (tree.lightClass == LightClass::spherical ? 0.15 : 0.3) * bound) ++near_;
  }

  Receivers receivers_ = randomReceivers(60, {LobeType::lambert}, 1, 3);
  GatherSettings settings_;
  std::vector<std::vector<double>> values_;
  size_t outside_ = 0, lit_ = 0, near_ = 0;
};

TEST_F(ForestBounds, OfPointLightsHoldForEveryColor) {
  const Scene scene;
  Bounds3f bounds;
  bounds.add(Vec3f(0.f)), bounds.add(Vec3f(2 * LitFloor::kMiddle));
  for (const LightClass lightClass : {LightClass::omni, LightClass::diffuse}) {
    VirtualLights lights;
    Rng rng(5);
    for (int i = 0; i < 100; ++i) {
      const Vec3f p = Vec3f(LitFloor::kMiddle) + randomPoint(&rng, 1.f);
      if (lightClass == LightClass::omni)
        lights.omni.push_back({p, saturated(&rng), PreparedLight::kNoPattern});
      else
        lights.diffuse.push_back({p, saturated(&rng), encodeOctahedral(randomDirection(&rng)), 0});
    }
    lights.diffuseDepthEnds = {static_cast<uint32_t>(lights.diffuse.size())};
    light(scene, lights, lightClass, 100);
    expectBounds(plantLights(lights, settings_, 1, scene, bounds, {}));
  }
}

// Spheres on a coloured floor, which overlap each other and some receivers.
TEST_F(ForestBounds, OfSphericalLightsHoldForEveryColor) {
  Material red = phongMaterial(0, 0, 1);
  red.diffuse = Rgb(0.9f, 0.1f, 0.02f);
  LitFloor floor(red, 0.3f, {0.2f, 0, 1});
  Rng rng(4);
  std::vector<SphericalLight>& spheres = floor.lights().spherical;
  spheres.resize(100, spheres[0]);
  for (SphericalLight& light : spheres) {
    const Vec2f u = rng.next2D();
    light.p = Vec3f(LitFloor::kMiddle) + Vec3f{3 * u.x - 1.5f, 3 * u.y - 1.5f, 0};
    light.radius = 0.02f + 0.4f * rng.next1D();
    light.power = saturated(&rng);
  }
  floor.lights().sphericalDepthEnds = {0, 100};
  const PreparedLights prepared = prepareLights(floor.lights(), floor.scene());
  light(floor.scene(), floor.lights(), LightClass::spherical, 100);
  expectBounds(
      plantLights(floor.lights(), settings_, 1, floor.scene(), floor.tracer().bounds(), prepared));
}

}  // namespace
}  // namespace lobelia
