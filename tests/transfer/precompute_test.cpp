// Transfer as a whole, against rays followed one by one and against sums known beforehand.
#include "lobelia/transfer/precompute.h"

#include <gtest/gtest.h>

#include "lobelia/base/parallel.h"
#include "lobelia/transfer/slice_lookup.h"
#include "relight/scenes.h"
#include "transfer/follow_path.h"

namespace lobelia::transfer {
namespace {

using test::place;

Material phong(Rgb diffuse, Rgb specular, float exponent) {
  Material m;
  m.type = MaterialType::phong;
  m.diffuse = diffuse, m.specular = specular, m.alphaU = exponent;
  return m;
}

// A ball above a ground, each of its own material.
struct Stage {
  Scene scene;
  Context context;
  Stage(const Material& ball, const Material& ground, int around = 20) {
    place(scene, test::sphereMesh(around, around / 2, true), scaling({0.5, 0.5, 0.5}));
    scene.instances.back().material = test::addMaterial(scene, ball);
    place(scene, test::boxMesh({-1, -1, -0.9f}, {1, 1, -0.6f}));
    scene.instances.back().material = test::addMaterial(scene, ground);
  }
};

TransferSettings plain() {
  TransferSettings settings;
  settings.subdivision = 0;
  return settings;
}

// What a path from a vertex towards the eye brings, by number of bounces: energy, and its first
// moment by luminance. Brute force over samples of the BSDF.
struct Traced {
  std::array<Rgb, 4> alpha{};
  std::array<Vec3f, 4> first{};
};
Traced traced(const Tracer& tracer, const TransferVertex& vertex, Vec3f wo, int samples) {
  Traced out;
  Rng rng(5);
  const Rgb share(1.f / static_cast<float>(samples));
  for (int s = 0; s < samples; ++s)
    test::followPath(tracer, surfacePoint(tracer.scene(), vertex.hit()), wo, share,
                     out.alpha.size(), rng, [&](size_t bounce, Rgb weight, Vec3f wi) {
                       out.alpha[bounce] += weight, out.first[bounce] += wi * luminance(weight);
                     });
  return out;
}

// All that a vertex reflects towards wo of a pass.
LobeMoment reflected(const SliceLookup& lookup, const ReflectionTables& tables,
                     const TransferData& data, const Scene& scene, uint32_t vertex, Vec3f wo,
                     size_t pass) {
  const TransferVertex& v = data.mesh.vertices[vertex];
  Reflection own;
  if (!tables.at(scene.instances[v.instance].material, v.n, wo, &own)) return {};
  const relight::SurroundingVertices around{{vertex, vertex, vertex}, {1, 0, 0}};
  const Side side = dot(v.n, wo) < 0 ? Side::back : Side::front;
  std::array<LobeMoment, kMostClasses + 1> byClass{};
  const size_t classes = data.passes[pass].glossy.size();
  lookup.glossy(lookup.view(around, own, wo, side), pass, {byClass.data(), classes});
  LobeMoment all;
  for (size_t c = 0; c < classes; ++c) all.alpha += byClass[c].alpha, all.first += byClass[c].first;
  for (const LobeMoment& m : lookup.diffuse(around, side, pass, own.diffuse))
    all.alpha += m.alpha, all.first += m.first;
  return all;
}

TEST(PrecomputeTransfer, IsWhatRaysFollowedOneByOneBring) {
  Stage stage(phong(Rgb(0.2f, 0.1f, 0.3f), Rgb(0.5f, 0.6f, 0.4f), 20),
              phong(Rgb(0.3f), Rgb(0.4f, 0.3f, 0.5f), 40), 24);
  const Tracer tracer(stage.scene, stage.context);
  TransferSettings settings = plain();
  settings.subdivision = 2;
  settings.maskLevel = 4;
  settings.mostVertices = 900;
  const TransferData data = precomputeTransfer(tracer, settings, stage.context);
  const ReflectionTables tables(stage.scene);
  const SliceLookup lookup(stage.scene, data, tables);
  ASSERT_EQ(data.passes.size(), 3u);
  int compared = 0;
  double sum[3] = {}, truth[3] = {}, wrong[3] = {};
  const auto step = static_cast<uint32_t>(data.mesh.vertices.size() / 40);
  for (uint32_t v = 0; v < data.mesh.vertices.size(); v += step) {
    const TransferVertex& vertex = data.mesh.vertices[v];
    for (const uint32_t k : {17u, 240u, 400u, 580u}) {
      const Vec3f wo = lookup.directions().directions()[k];
      if (dot(wo, vertex.n) < 0.2f) continue;
      ++compared;
      const Traced reference = traced(tracer, vertex, wo, 1500);
      for (size_t j = 0; j < 3; ++j) {
        const LobeMoment mine = reflected(lookup, tables, data, stage.scene, v, wo, j);
        sum[j] += double{luminance(mine.alpha)}, truth[j] += double{luminance(reference.alpha[j])};
        wrong[j] += double{length(mine.first - reference.first[j])};
        EXPECT_NEAR(luminance(mine.alpha), luminance(reference.alpha[j]), 0.06f)
            << "vertex " << v << " direction " << k << " pass " << j;
      }
    }
  }
  EXPECT_GT(compared, 30);
  EXPECT_NEAR(sum[0] / truth[0], 1, 0.01);
  EXPECT_NEAR(sum[1] / truth[1], 1, 0.03);
  EXPECT_NEAR(sum[2] / truth[2], 1, 0.06);
  EXPECT_LT(wrong[0] / truth[0], 0.03);
  EXPECT_LT(wrong[1] / truth[1], 0.12);
}

TEST(PrecomputeTransfer, StoresNothingOfAConvexBody) {
  Scene scene;
  place(scene, test::sphereMesh(24, 12, true));
  scene.instances[0].material = test::addMaterial(scene, phong(Rgb(0.5f), Rgb(0.5f), 64));
  Context context;
  const Tracer tracer(scene, context);
  const TransferData data = precomputeTransfer(tracer, plain(), context);
  EXPECT_EQ(data.recordCount(), 0u);
  EXPECT_EQ(context.statistics.count("slices"), context.statistics.count("slices_unoccluded"));
  EXPECT_EQ(context.statistics.count("hits"), 0u);
  // The open half of the sphere, as a whole and with the mean of a cosine.
  for (const DiffuseLobes& lobes : data.passes[0].diffuse) {
    float share = 0;
    Vec3f first{};
    for (const SliceRecord record : lobes) {
      const TransferLobe lobe = unpack(record);
      share += luminance(lobe.share), first += lobe.r * luminance(lobe.share);
    }
    EXPECT_NEAR(share, 1, 0.01);
    EXPECT_NEAR(length(first), 2.f / 3, 0.01f);
  }
}

TEST(PrecomputeTransfer, AClosedRoomKeepsItsAlbedosProduct) {
  // Seen from inside nothing of infinity is visible through walls: light comes in by the lid that
  // is missing, and what a room of albedo one receives in all passes is all there is.
  Scene scene;
  place(scene, test::sphereMesh(24, 16, true));
  scene.instances[0].flipNormals = true;
  scene.instances[0].material = test::addMaterial(scene, phong(Rgb(0.7f), Rgb(0.f), 8));
  Context context;
  const Tracer tracer(scene, context);
  TransferSettings settings = plain();
  settings.bounces = 3;
  const TransferData data = precomputeTransfer(tracer, settings, context);
  for (const TransferPass& pass : data.passes)
    for (const DiffuseLobes& lobes : pass.diffuse)
      for (const SliceRecord record : lobes) EXPECT_EQ(unpack(record).share, Rgb{});
}

TEST(PrecomputeTransfer, EnergyOfAllPassesNeverPassesTheAlbedoSeries) {
  // White surfaces: what leaves, by any number of bounces, is at most what there was, and with ten
  // bounces nearly all of it.
  Stage stage(phong(Rgb(0.4f), Rgb(0.6f), 12), phong(Rgb(1.f), Rgb(0.f), 8), 12);
  const Tracer tracer(stage.scene, stage.context);
  TransferSettings settings = plain();
  settings.bounces = 10;
  const TransferData data = precomputeTransfer(tracer, settings, stage.context);
  ASSERT_EQ(data.passes.size(), 11u);
  const ReflectionTables tables(stage.scene);
  const SliceLookup lookup(stage.scene, data, tables);
  for (uint32_t v = 0; v < data.mesh.vertices.size(); v += 7) {
    const TransferVertex& vertex = data.mesh.vertices[v];
    for (const uint32_t k : {100u, 300u, 500u}) {
      const Vec3f wo = lookup.directions().directions()[k];
      Reflection own;
      if (dot(wo, vertex.n) < 0.3f ||
          !tables.at(stage.scene.instances[vertex.instance].material, vertex.n, wo, &own))
        continue;
      float sum = 0;
      for (size_t j = 0; j < data.passes.size(); ++j)
        sum += luminance(reflected(lookup, tables, data, stage.scene, v, wo, j).alpha);
      const float albedo = luminance(own.diffuse + own.glossy);
      EXPECT_LT(sum, albedo * 1.005f);
      EXPECT_GT(sum, albedo * 0.6f) << v << " " << k;
    }
  }
}

TEST(PrecomputeTransfer, IsTheSameForAnyNumberOfThreads) {
  Stage stage(phong(Rgb(0.2f), Rgb(0.5f), 20), phong(Rgb(0.3f), Rgb(0.4f), 40), 12);
  const Tracer tracer(stage.scene, stage.context);
  std::vector<TransferData> data;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    data.push_back(precomputeTransfer(tracer, plain(), stage.context));
  }
  ASSERT_EQ(data[0].passes.size(), data[1].passes.size());
  for (size_t j = 0; j < data[0].passes.size(); ++j) {
    EXPECT_EQ(data[0].passes[j].diffuse, data[1].passes[j].diffuse);
    for (size_t c = 0; c < data[0].passes[j].glossy.size(); ++c) {
      const auto a = data[0].passes[j].glossy[c].records(),
                 b = data[1].passes[j].glossy[c].records();
      EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
      EXPECT_GT(a.size(), j == 0 ? 100u : 0u);
    }
  }
}

}  // namespace
}  // namespace lobelia::transfer
