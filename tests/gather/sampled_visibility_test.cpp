// Visibility by few rays against that by all.
#include "lobelia/gather/sampled_visibility.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "gather/lit_corner.h"
#include "lobelia/gather/whole_receivers.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

// A floor of 256 receivers under a screen that ends at x = edge, and a light far above.
class SampledVisibilityTest : public testing::Test {
 protected:
  struct Found {
    size_t rays = 0;
    PairMasks pairs;
    int lit() const {
      int count = 0;
      for (const uint16_t bits : pairs.bits) count += std::popcount(bits);
      return count;
    }
  };
  Found look(float edge, bool sampled, bool all = false) {
    Scene scene;
    Mesh mesh;
    mesh.positions = {{-9, -9, 1}, {edge, -9, 1}, {edge, 9, 1}, {-9, 9, 1}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.meshes.push_back(mesh);
    scene.materials.emplace_back();
    Instance instance;
    instance.mesh.index = 0;
    instance.material.index = 0;
    scene.instances.push_back(instance);
    const Tracer tracer(scene, context_);
    Receivers receivers = randomReceivers(256, {LobeType::lambert}, 1, 3);
    layOnFloor(&receivers, 5);
    const WholeReceivers whole = plantWholeReceivers(receivers, 2);
    const Tile tile = makeTile(whole.receivers, 0, 256);
    VirtualLights lights;
    lights.omni.push_back({{0.5f, 0.5f, 500}, Rgb(1.f), PreparedLight::kNoPattern});
    LightBlock block;
    prepare(lights, scene, LightClass::omni, 0, 1, &block);
    Found found;
    found.pairs.reset(1, tile.strips.size());
    std::fill(found.pairs.bits.begin(), found.pairs.bits.end(), uint16_t{0xffff});
    const LitNode root{0, 0, all};
    found.rays = sampled ? visibility_.keep(tile, block, tracer, whole.trees[0].tree, 0, {&root, 1},
                                            7, &found.pairs)
                         : keepVisible(tile, block, tracer, &found.pairs);
    return found;
  }
  Context context_;
  SampledVisibility visibility_;
};

TEST_F(SampledVisibilityTest, AgreeingRaysAnswerForAll) {
  for (const float edge : {-1.f, 2.f}) {  // all lit, all dark
    const Found some = look(edge, true);
    EXPECT_EQ(some.rays, 256u / SampledVisibility::kShare);
    EXPECT_EQ(some.pairs.bits, look(edge, false).pairs.bits);
  }
  EXPECT_EQ(look(-1, false).lit(), 256);
}

TEST_F(SampledVisibilityTest, EdgesAreLookedAtMoreClosely) {
  for (const float edge : {0.2f, 0.5f, 0.77f}) {
    const Found every = look(edge, false), some = look(edge, true);
    EXPECT_EQ(every.rays, 256u);
    EXPECT_GT(some.rays, 256u / SampledVisibility::kShare);
    EXPECT_LT(some.rays, 200u);
    EXPECT_GT(every.lit(), 30);
    int differ = 0;
    for (size_t i = 0; i < every.pairs.bits.size(); ++i)
      differ += std::popcount(static_cast<uint16_t>(every.pairs.bits[i] ^ some.pairs.bits[i]));
    EXPECT_LT(differ, 13) << edge;
  }
}

TEST_F(SampledVisibilityTest, OrEveryReceiverIsAsked) {
  const Found every = look(0.4f, false), all = look(0.4f, true, true);
  EXPECT_EQ(all.rays, 256u);
  EXPECT_EQ(all.pairs.bits, every.pairs.bits);
}

}  // namespace
}  // namespace lobelia
