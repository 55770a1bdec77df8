// Bounds of receivers against their lobes.
#include "lobelia/gather/receiver_nodes.h"

#include <gtest/gtest.h>

#include "gather/random_input.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

struct Excess {
  int directions = 0, above = 0, farAbove = 0;  // light beyond the bound, beyond 1.5 times that
};

// Light of an omni light of any colour in random directions, near the receivers' Gaussians half of
// the time.
Excess excessOf(LobeType type, size_t lobes) {
  const Receivers receivers = randomReceivers(400, {type}, lobes, 8);
  Excess excess;
  Rng rng(3);
  for (size_t i = 0; i < receivers.points.size(); ++i) {
    const ReceiverPoint& point = receivers.points[i];
    const Bsdf bsdf = receiverBsdf(receivers, point);
    const ReceiverNodes nodes =
        receiverNodes(receivers, i, makeTile(receivers, i, i + 1).strips[0]);
    const SamplingLobes fitted = samplingLobes(bsdf, point.wo);
    for (int k = 0; k < 50; ++k) {
      Vec3f w = randomDirection(&rng);
      if (k % 2 == 0 && fitted.gaussianCount > 0) {
        const PreparedSphere::Gaussian& g = fitted.gaussians[0];
        w = normalize(g.axis + w * (1.5f / std::sqrt(1 + g.sharpness)));
      }
      const Rgb hue = randomColor(&rng), color = hue * hue * hue;
      const float value = luminance(evaluate(bsdf, point.wo, w) * color);
      if (!(value > 0)) continue;
      trees::BoundItem item;
      item.p = point.p + w;
      item.cosine = luminance(color);
      const trees::BoundNode light = leafOf(item, 0);
      float bound =
          boundPair({&nodes.cosine, &light}, LightClass::omni, false, BoundForm::tight).upper;
      if (nodes.glossy)
        bound +=
            boundPair({&nodes.gaussians, &light}, LightClass::omni, true, BoundForm::tight).upper;
      ++excess.directions;
      excess.above += value > 1.001f * bound ? 1 : 0;
      excess.farAbove += value > 1.5f * bound ? 1 : 0;
    }
  }
  return excess;
}

TEST(ReceiverNodes, LambertIsBoundedExactly) {
  const Excess excess = excessOf(LobeType::lambert, 1);
  EXPECT_GT(excess.directions, 5000);
  EXPECT_EQ(excess.above, 0);
}

TEST(ReceiverNodes, LobesOfEveryKindAreBelowTheirBoundsButForNarrowPeaks) {
  for (const LobeType type :
       {LobeType::coatedDiffuse, LobeType::principledDiffuse, LobeType::microfacetReflection,
        LobeType::microfacetTransmission, LobeType::phong, LobeType::ward,
        LobeType::diffuseTransmission, LobeType::sheen, LobeType::thinTransmission}) {
    for (const size_t lobes : {1u, 2u}) {
      const Excess excess = excessOf(type, lobes);
      EXPECT_GT(excess.directions, 500) << static_cast<int>(type);
      EXPECT_LE(excess.above, 0.015 * excess.directions) << static_cast<int>(type);
      EXPECT_LT(excess.farAbove, 0.005 * excess.directions) << static_cast<int>(type);
    }
  }
}

// One receiver against many nodes is pair by pair, in whatever instructions.
TEST(ReceiverNodes, ManyNodesAtOnceAreTheirPairs) {
  const Receivers receivers = randomReceivers(6, {LobeType::lambert, LobeType::phong}, 2, 8);
  const VirtualLights lights = randomLights(40, 100.f, 5);
  GatherSettings settings;
  settings.direct = true;
  Scene scene;
  Bounds3f bounds;
  bounds.add(Vec3f(-1.f)), bounds.add(Vec3f(1.f));
  const LightForest forest = plantLights(lights, settings, 1, scene, bounds, {});
  for (const bool clamped : {false, true}) {
    NodeBounder bounder(forest, clamped ? 2.f : 0.f);
    for (size_t i = 0; i < receivers.points.size(); ++i) {
      const ReceiverNodes nodes =
          receiverNodes(receivers, i, makeTile(receivers, i, i + 1).strips[0]);
      for (uint32_t t = 0; t < forest.trees.size(); ++t) {
        const LightForest::Tree& tree = forest.trees[t];
        std::vector<uint32_t> all(tree.tree.nodes().size());
        for (uint32_t n = 0; n < all.size(); ++n) all[n] = n;
        std::vector<NodeBound> found(all.size());
        bounder.bound(nodes, t, all, found.data());
        for (const uint32_t n : all) {
          const trees::BoundNode& light = tree.tree.nodes()[n];
          PairBounds sum =
              boundPair({&nodes.cosine, &light}, tree.lightClass, false, BoundForm::tight);
          if (nodes.glossy) {
            const PairBounds more =
                boundPair({&nodes.gaussians, &light}, tree.lightClass, true, BoundForm::tight);
            sum.upper = std::min(sum.upper + more.upper, kBoundInfinity);
            sum.value += more.value;
          }
          if (clamped && tree.lightClass != LightClass::directional)
            sum.upper = std::min(sum.upper, 2 * (light.cosine + light.peak));
          EXPECT_NEAR(found[n].upper, sum.upper, 1e-3f * sum.upper);
          EXPECT_NEAR(found[n].value, sum.value, 1e-3f * sum.value + 1e-20f);
        }
      }
    }
    EXPECT_EQ(bounder.evaluations(), 6u * 4 * 79);
  }
}

}  // namespace
}  // namespace lobelia
