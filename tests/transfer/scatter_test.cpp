// Scattering against gathering, which precompute_test.cpp compares with the truth.
#include "lobelia/transfer/scatter.h"

#include <gtest/gtest.h>

#include "lobelia/base/parallel.h"
#include "lobelia/transfer/frame.h"
#include "lobelia/transfer/sample_lobe.h"
#include "relight/scenes.h"

namespace lobelia::transfer {
namespace {

using test::place;

Material phong(Rgb diffuse, Rgb specular, float exponent) {
  Material m;
  m.type = MaterialType::phong;
  m.diffuse = diffuse, m.specular = specular, m.alphaU = exponent;
  return m;
}

Scene ballOverGround() {
  Scene scene;
  place(scene, test::sphereMesh(14, 7, true), scaling({0.5, 0.5, 0.5}));
  scene.instances.back().material =
      test::addMaterial(scene, phong(Rgb(0.2f, 0.1f, 0.3f), Rgb(0.5f, 0.6f, 0.4f), 20));
  place(scene, test::groundMesh(10), translation({0, 0, -0.6}));
  scene.instances.back().material =
      test::addMaterial(scene, phong(Rgb(0.3f), Rgb(0.4f, 0.3f, 0.5f), 40));
  return scene;
}

TransferSettings coarse() {
  TransferSettings settings;
  settings.subdivision = 0;
  settings.directionLevel = 2;
  return settings;
}

TransferMesh meshOf(const Scene& scene) {
  const relight::SampleMesh mesh = splitMesh(scene);
  return {mesh, transferVertices(scene, mesh), {}};
}

// Sums over slices of a pass: energy and what the two differ in.
struct Difference {
  double energy[2] = {};
  double share = 0, moment = 0;
};
// What a row has in a column; unstored: of the direct pass the material's own lobe, whose r the
// other's stands for.
TransferLobe lobeOf(const SliceRows& rows, size_t v, size_t k, bool direct, Vec3f own) {
  const SliceRecord* record = rows.find(v, k);
  if (record) return unpack(*record);
  return direct ? TransferLobe{Rgb(1), own} : TransferLobe{};
}
Difference difference(const TransferData& a, const TransferData& b, size_t pass) {
  Difference d;
  for (size_t c = 0; c < a.passes[pass].glossy.size(); ++c) {
    const SliceRows &x = a.passes[pass].glossy[c], &y = b.passes[pass].glossy[c];
    for (size_t v = 0; v < x.rowCount(); ++v)
      for (size_t k = 0; k < x.columnCount(); ++k) {
        const SliceRecord *p = x.find(v, k), *q = y.find(v, k);
        if (!p && !q) continue;
        const TransferLobe s = lobeOf(x, v, k, pass == 0, q ? unpack(*q).r : Vec3f());
        const TransferLobe t = lobeOf(y, v, k, pass == 0, p ? unpack(*p).r : Vec3f());
        d.energy[0] += double{luminance(s.share)}, d.energy[1] += double{luminance(t.share)};
        d.share += double{std::abs(luminance(s.share - t.share))};
        d.moment += double{length(s.r * luminance(s.share) - t.r * luminance(t.share))};
      }
  }
  return d;
}

// Of diffuse lobes, all octants of a vertex together.
Difference diffuseDifference(const TransferData& a, const TransferData& b, size_t pass) {
  Difference d;
  for (size_t v = 0; v < a.passes[pass].diffuse.size(); ++v) {
    Vec3f first{};
    float share = 0;
    for (size_t o = 0; o < kOctants; ++o) {
      const TransferLobe s = unpack(a.passes[pass].diffuse[v][o]);
      const TransferLobe t = unpack(b.passes[pass].diffuse[v][o]);
      d.energy[0] += double{luminance(s.share)}, d.energy[1] += double{luminance(t.share)};
      first += s.r * luminance(s.share) - t.r * luminance(t.share);
      share += luminance(s.share - t.share);
    }
    d.share += double{std::abs(share)}, d.moment += double{length(first)};
  }
  return d;
}

// Gathering interpolates between the mesh's vertices and the grid's directions what paths find
// where they are: a difference stays, the same for any number of rays.
TEST(ScatterTransfer, ConvergesToWhatIsGathered) {
  const Scene scene = ballOverGround();
  Context context;
  const Tracer tracer(scene, context);
  const TransferData gathered = precomputeTransfer(tracer, coarse(), context);
  const TransferData few = scatterTransfer(tracer, meshOf(scene), coarse(), 2, context);
  const TransferData many = scatterTransfer(tracer, meshOf(scene), coarse(), 20, context);
  ASSERT_EQ(many.passes.size(), 3u);
  const double energy[] = {0.004, 0.03, 0.03}, wrong[] = {0.06, 0.42, 0.7};
  const double diffuseWrong[] = {0.015, 0.15, 0.3};
  for (size_t j = 0; j < 3; ++j) {
    SCOPED_TRACE(testing::Message() << "pass " << j);
    const Difference noisy = difference(few, gathered, j), d = difference(many, gathered, j);
    EXPECT_NEAR(d.energy[0] / d.energy[1], 1, energy[j]);
    EXPECT_LT(d.share / d.energy[1], wrong[j]);
    EXPECT_LT(d.moment / d.energy[1], wrong[j]);
    EXPECT_LT(d.share, 0.5 * noisy.share);
    EXPECT_LT(d.moment, 0.6 * noisy.moment);
    const Difference diffuse = diffuseDifference(many, gathered, j);
    EXPECT_NEAR(diffuse.energy[0] / diffuse.energy[1], 1, energy[j]);
    EXPECT_LT(diffuse.moment / diffuse.energy[1], diffuseWrong[j]);
  }
}

TEST(ScatterTransfer, StoresNothingOfAConvexBody) {
  Scene scene;
  place(scene, test::sphereMesh(12, 6, true));
  scene.instances[0].material = test::addMaterial(scene, phong(Rgb(0.5f), Rgb(0.5f), 64));
  Context context;
  const Tracer tracer(scene, context);
  const TransferData data = scatterTransfer(tracer, meshOf(scene), coarse(), 8, context);
  EXPECT_EQ(data.recordCount(), 0u);
  EXPECT_GT(context.statistics.count("slices"), 100u);
  EXPECT_EQ(context.statistics.count("slices"), context.statistics.count("slices_unoccluded"));
}

TEST(ScatterTransfer, IsTheSameForAnyNumberOfThreads) {
  const Scene scene = ballOverGround();
  Context context;
  const Tracer tracer(scene, context);
  std::vector<TransferData> data;
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    data.push_back(scatterTransfer(tracer, meshOf(scene), coarse(), 4, context));
  }
  for (size_t j = 0; j < data[0].passes.size(); ++j) {
    EXPECT_EQ(data[0].passes[j].diffuse, data[1].passes[j].diffuse);
    for (size_t c = 0; c < data[0].passes[j].glossy.size(); ++c) {
      const auto a = data[0].passes[j].glossy[c].records(),
                 b = data[1].passes[j].glossy[c].records();
      EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
    }
  }
  EXPECT_GT(data[0].recordCount(), 100u);
}

Camera cameraAt(Vec3d eye) {
  Camera camera;
  camera.toWorld = Transform(*lookAt(eye, {0, 0, -0.3}, {0, 0, 1}));
  camera.fovX = 0.9f;
  camera.width = 24, camera.height = 20;
  return camera;
}

Film frameOf(const Tracer& tracer, const TransferData& data, const Camera& camera,
             Context& context) {
  const EmitterSampler emitters(tracer.scene(), tracer.bounds());
  TransferRenderer renderer(tracer, data);
  renderer.relight(emitters, context);
  Film film;
  film.width = film.fullWidth = camera.width, film.height = film.fullHeight = camera.height;
  film.addLayer("");
  renderer.render({}, camera, film, context);
  return film;
}

TEST(ScatterTransfer, SlicesThatAreSeenMakeTheSameFrames) {
  Scene scene = ballOverGround();
  Emitter sky;
  sky.type = EmitterType::constant;
  sky.radiance = Rgb(1, 2, 3);
  scene.emitters.push_back(sky);
  Context context;
  const Tracer tracer(scene, context);
  const TransferData all = scatterTransfer(tracer, meshOf(scene), coarse(), 4, context);
  const ReflectionTables tables(scene);
  const Camera cameras[] = {cameraAt({0, -3, 1}), cameraAt({2, 2, 0.2})};
  const SliceMask seen = seenSlices(SliceLookup(scene, all, tables), all, cameras);
  const TransferData some = scatterTransfer(tracer, meshOf(scene), coarse(), 4, context, &seen);
  EXPECT_LT(4 * some.recordCount(), all.recordCount());
  for (const Camera& camera : cameras)
    EXPECT_EQ(frameOf(tracer, some, camera, context).layers.at("").values,
              frameOf(tracer, all, camera, context).layers.at("").values);
  // From elsewhere slices are missing.
  const Camera other = cameraAt({-3, 0.5, 0.5});
  EXPECT_NE(frameOf(tracer, some, other, context).layers.at("").values,
            frameOf(tracer, all, other, context).layers.at("").values);
}

TEST(ScatterTransfer, WantsRays) {
  const Scene scene = ballOverGround();
  Context context;
  const Tracer tracer(scene, context);
  EXPECT_THROW(scatterTransfer(tracer, meshOf(scene), coarse(), 0, context), UsageError);
}

}  // namespace
}  // namespace lobelia::transfer
