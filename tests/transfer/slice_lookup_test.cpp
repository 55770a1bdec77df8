// Slices between directions and vertices, against what they are made from.
#include "lobelia/transfer/slice_lookup.h"

#include <gtest/gtest.h>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/resultant.h"
#include "transfer/simple_data.h"

namespace lobelia::transfer {
namespace {

// A glossy square in z = 0 that faces +z; what is known of it comes with a test.
struct Square {
  Scene scene;
  TransferData data;
  explicit Square(bool twoSided = false) {
    MaterialHandle material =
        test::addMaterial(scene, test::phongMaterial({0.6f, 0.5f, 0.4f}, 200, {0.2f, 0.2f, 0.2f}));
    if (twoSided) {
      Material both;
      both.type = MaterialType::twoSided;
      both.a = material;
      material = test::addMaterial(scene, both);
    }
    test::addQuad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, material);
    data = test::simpleData(scene);
  }
};

// In front, not within four degrees of the horizon.
Vec3f eyeDirection(Rng& rng) {
  Vec3f d = sampleSphereUniform(rng.next2D());
  d.z = std::abs(d.z) + 0.07f;
  return normalize(d);
}

TEST(SliceLookup, NothingStoredIsTheWholeLobeOrNothing) {
  Square square;
  square.data.passes.push_back(
      {{test::rowsOf(square.data,
                     [](const auto&, Vec3f) { return std::optional<TransferLobe>{}; })},
       {}});
  const ReflectionTables tables(square.scene);
  const SliceLookup lookup(square.scene, square.data, tables);
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    const Vec3f wo = eyeDirection(rng);
    const VertexView view = lookup.view(0, wo, Side::front);
    EXPECT_TRUE(lookup.visible(view).whole);
    EXPECT_EQ(lookup.glossy(view, 1, 0).share, Rgb{});
    Reflection own;
    ASSERT_TRUE(tables.summary({0}, {0, 0, 1}, wo, &own));
    const PlaceView place = lookup.view({{0, 1, 2}, {0.2f, 0.3f, 0.5f}}, own, wo, Side::front);
    LobeMoment moment;
    lookup.glossy(place, 0, {&moment, 1});
    EXPECT_EQ(moment.alpha, own.glossy);
    EXPECT_LT(length(moment.first - own.r * luminance(own.glossy)), 1e-6f);
    lookup.glossy(place, 1, {&moment, 1});
    EXPECT_EQ(moment.alpha, Rgb{});
    EXPECT_EQ(moment.first, Vec3f{});
  }
}

TEST(SliceLookup, AMirroredLobeIsTheSameBetweenDirections) {
  // A wall behind that reflects like a mirror: what comes over it has turned once more.
  Square square;
  const Vec3f wall = normalize(Vec3f(1, 0.5f, 0.2f));
  const auto lobeAt = [&](Vec3f wo) {
    const Vec3f once = Vec3f(0, 0, 2 * wo.z) - wo;
    return TransferLobe{{0.5f, 0.25f, 0.125f},
                        (once - wall * (2 * dot(once, wall))) * lobes::meanResultant(257.f)};
  };
  square.data.passes.push_back({{test::rowsOf(square.data,
                                              [&](const auto&, Vec3f d) {
                                                return d.z > 0 ? std::optional(lobeAt(d))
                                                               : std::nullopt;
                                              })},
                                {}});
  const ReflectionTables tables(square.scene);
  const SliceLookup lookup(square.scene, square.data, tables);
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const Vec3f wo = eyeDirection(rng);
    const TransferLobe found = lookup.glossy(lookup.view(1, wo, Side::front), 1, 0),
                       truth = lobeAt(wo);
    EXPECT_LT(maxComponent(max(found.share - truth.share, truth.share - found.share)), 2e-3f);
    // Where corners are behind the surface, the rest stands for them.
    if (wo.z < 0.16f) continue;
    EXPECT_LT(length(normalize(found.r) - normalize(truth.r)), 4e-3f);
    EXPECT_NEAR(kappaOfResultant(length(found.r)) / 257, 1, 0.02);
  }
}

TEST(SliceLookup, HalfSeenLobesMoveWithTheEye) {
  // Of every lobe what lies about its own mean, shifted to one side, is seen.
  Square square;
  const ReflectionTables tables(square.scene);
  const auto seenAt = [&](Vec3f wo) {
    Reflection own;
    EXPECT_TRUE(tables.summary({0}, {0, 0, 1}, wo, &own));
    const Vec3f up = normalize(own.r + Vec3f(0, 0, 0.03f));
    return TransferLobe{Rgb(0.5f),
                        up * lobes::meanResultant(1.5f * kappaOfResultant(length(own.r)))};
  };
  square.data.passes[0].glossy[0] = test::rowsOf(square.data, [&](const auto&, Vec3f d) {
    return d.z > 0 ? std::optional(seenAt(d)) : std::nullopt;
  });
  const SliceLookup lookup(square.scene, square.data, tables);
  Rng rng(3);
  for (int i = 0; i < 500; ++i) {
    const Vec3f wo = eyeDirection(rng);
    if (wo.z < 0.2f) continue;
    Reflection own;
    ASSERT_TRUE(tables.summary({0}, {0, 0, 1}, wo, &own));
    LobeMoment moment;
    lookup.glossy(lookup.view({{0, 1, 2}, {0.5f, 0.25f, 0.25f}}, own, wo, Side::front), 0,
                  {&moment, 1});
    const TransferLobe truth = seenAt(wo);
    EXPECT_NEAR(moment.alpha.y, 0.5f * own.glossy.y, 2e-3f);
    const Vec3f r = moment.first / luminance(moment.alpha);
    EXPECT_LT(length(normalize(r) - normalize(truth.r)), 6e-3f) << wo.z;
    EXPECT_NEAR(kappaOfResultant(length(r)) / kappaOfResultant(length(truth.r)), 1, 0.05) << wo.z;
  }
}

TEST(SliceLookup, LooksFromTheSideThatReflects) {
  const Square one, both(true);
  const ReflectionTables tablesOfOne(one.scene), tablesOfBoth(both.scene);
  const Vec3f below = normalize(Vec3f(0.6f, 0, -0.3f));
  const VertexView lifted =
      SliceLookup(one.scene, one.data, tablesOfOne).view(0, below, Side::back);
  EXPECT_GT(lifted.wo.z, 0);
  EXPECT_EQ(lifted.n, Vec3f(0, 0, 1));
  const SliceLookup lookup(both.scene, both.data, tablesOfBoth);
  const VertexView turned = lookup.view(0, below, Side::back);
  EXPECT_EQ(turned.wo, below);
  EXPECT_EQ(turned.n, Vec3f(0, 0, -1));
  // A place in front whose vertex has turned away.
  const VertexView away = lookup.view(0, below, Side::front);
  EXPECT_GT(away.wo.z, 0);
  EXPECT_EQ(away.n, Vec3f(0, 0, 1));
  for (const VertexView& view : {lifted, turned, away}) {
    float sum = 0;
    for (size_t k = 0; k < 3; ++k) {
      sum += view.place.weight[k];
      if (view.place.weight[k] > 0) {
        EXPECT_GT(dot(view.n, lookup.directions().directions()[view.place.index[k]]), 0);
      }
    }
    EXPECT_NEAR(sum, 1, 1e-5);
  }
}

TEST(SliceLookup, DiffuseLightIsLinearBetweenVertices) {
  Square square;
  for (size_t v = 0; v < square.data.mesh.vertices.size(); ++v) {
    DiffuseLobes lobes{};
    lobes[2] = pack({Rgb(0.25f * static_cast<float>(v + 1)), normalize(Vec3f(1, -1, 1)) * 0.6f});
    square.data.passes[0].diffuse.push_back(lobes);
  }
  const ReflectionTables tables(square.scene);
  const SliceLookup lookup(square.scene, square.data, tables);
  const auto octants =
      lookup.diffuse({{0, 1, 2}, {0.5f, 0.25f, 0.25f}}, Side::front, 0, {0.2f, 0.4f, 0.8f});
  const float share = 0.5f * 0.25f + 0.25f * 0.5f + 0.25f * 0.75f;
  EXPECT_NEAR(octants[2].alpha.z, 0.8f * share, 2e-3f);
  EXPECT_LT(
      length(octants[2].first / luminance(octants[2].alpha) - normalize(Vec3f(1, -1, 1)) * 0.6f),
      0.01f);
  EXPECT_EQ(octants[3].alpha, Rgb{});
}

}  // namespace
}  // namespace lobelia::transfer
