// Precomputation as a whole, and its file.
#include "lobelia/relight/visibility_data.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lobelia/base/error.h"
#include "lobelia/base/file.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/relight/precompute.h"
#include "lobelia/store/store.h"
#include "relight/scenes.h"
#include "support/run_program.h"

namespace lobelia::relight {
namespace {

VisibilityData precomputed(const Scene& scene, PrecomputeSettings settings, Context& context) {
  settings.sampleCount = std::min<size_t>(settings.sampleCount, 1024);
  settings.clusterCount = 32;
  const Tracer tracer(scene, context);
  return precomputeVisibility(tracer, settings, context);
}

void expectSame(const VisibilityData& a, const VisibilityData& b) {
  EXPECT_EQ(a.samples.kind, b.samples.kind);
  EXPECT_EQ(a.samples.p, b.samples.p);
  EXPECT_EQ(a.samples.n, b.samples.n);
  EXPECT_EQ(a.samples.measure, b.samples.measure);
  EXPECT_EQ(a.bothSides, b.bothSides);
  EXPECT_EQ(a.tree.meanP, b.tree.meanP);
  EXPECT_TRUE(std::ranges::equal(a.mesh.positions(), b.mesh.positions()));
  ASSERT_EQ(a.mesh.triangles().size(), b.mesh.triangles().size());
  for (size_t t = 0; t < a.mesh.triangles().size(); ++t) {
    EXPECT_EQ(a.mesh.triangles()[t].vertex, b.mesh.triangles()[t].vertex);
    EXPECT_EQ(a.mesh.triangles()[t].splitEdges, b.mesh.triangles()[t].splitEdges);
    EXPECT_EQ(a.mesh.triangles()[t].firstChild, b.mesh.triangles()[t].firstChild);
  }
  ASSERT_TRUE(std::ranges::equal(a.cuts.begins(), b.cuts.begins()));
  for (size_t i = 0; i < a.cuts.nodes().size(); ++i) {
    ASSERT_EQ(a.cuts.nodes()[i].level, b.cuts.nodes()[i].level);
    ASSERT_EQ(a.cuts.nodes()[i].value, b.cuts.nodes()[i].value);
  }
}

TEST(Precompute, IsTheSameForAnyNumberOfThreads) {
  Context context;
  context.seed = 5;
  const VisibilityData many = precomputed(test::ballScene(), {}, context);
  const ThreadLimit one(1);
  expectSame(precomputed(test::ballScene(), {}, context), many);
}

TEST(Precompute, MakesACutForEveryVertex) {
  for (const auto kind : {LightSamples::Kind::environment, LightSamples::Kind::surfaces}) {
    Context context;
    PrecomputeSettings settings;
    settings.light = kind;
    const VisibilityData data = precomputed(test::ballScene(), settings, context);
    ASSERT_EQ(data.cuts.count(), data.mesh.positions().size());
    for (size_t v = 0; v < data.cuts.count(); ++v) {
      size_t leaves = 0;
      for (const CutNode n : data.cuts.cut(v)) leaves += size_t{1} << n.level;
      ASSERT_EQ(leaves, data.samples.count());
    }
    const Statistics& s = context.statistics;
    EXPECT_EQ(s.count("vertices"), data.cuts.count());
    EXPECT_EQ(s.count("cut_nodes"), data.cuts.nodes().size());
    // What faces a ball's surface sees it.
    EXPECT_EQ(s.value("cut_rms") > 0, kind == LightSamples::Kind::environment);
    // Each node's squared error is at most 4, but for the rounding of values.
    EXPECT_LT(sqr(static_cast<float>(s.value("cut_rms"))) *
                  static_cast<float>(s.count("visibility_values")),
              4.1f * static_cast<float>(s.count("cut_nodes")));
  }
}

// Without error allowed, and all leaves mattering, cuts say what rays say.
TEST(Precompute, CutsSayWhatRaysSay) {
  Context context;
  PrecomputeSettings settings;
  settings.sigma = 0, settings.mostNodes = 1024, settings.adaptive = false;
  settings.subdivision = 0, settings.ignoreBelowHorizon = false;
  const Scene scene = test::ballScene(6);
  const VisibilityData data = precomputed(scene, settings, context);
  const Tracer tracer(scene, context);
  for (size_t v = 0; v < 49; ++v) {  // the ground's come first
    const Vec3f p = data.mesh.positions()[v];
    ASSERT_EQ(p.z, 0);
    size_t leaf = 0, differing = 0;
    for (const CutNode n : data.cuts.cut(v))
      for (size_t end = leaf + (size_t{1} << n.level); leaf < end; ++leaf) {
        const Vec3f d = data.samples.p[leaf];
        const bool visible = d.z > 0 && !tracer.occluded({p + Vec3f{0, 0, 1e-5f}, d, 0, 1e30f});
        differing += n.value == (visible ? 255 : 0) ? 0 : 1;
      }
    // Rays start a little way from the vertex: the shadow's edge is not quite the same.
    EXPECT_LE(differing, 12u) << v;
  }
  EXPECT_NEAR(context.statistics.value("cut_rms"), 0, 1e-9);
}

TEST(Precompute, IgnoringTheHorizonShortensCuts) {
  Context with, without;
  PrecomputeSettings settings;
  settings.sigma = 0.7f;
  const VisibilityData ignored = precomputed(test::ballScene(), settings, with);
  settings.ignoreBelowHorizon = false;
  const VisibilityData kept = precomputed(test::ballScene(), settings, without);
  EXPECT_LT(3 * ignored.cuts.nodes().size(), 2 * kept.cuts.nodes().size());
}

TEST(Precompute, TakesFewSamplesToo) {
  for (const size_t count : {2, 32, 64, 128}) {
    Context context;
    PrecomputeSettings settings;
    settings.sampleCount = count, settings.sigma = 0;
    const VisibilityData data = precomputed(test::ballScene(4), settings, context);
    ASSERT_EQ(data.samples.count(), count);
    EXPECT_NEAR(context.statistics.value("cut_rms"), 0, 1e-9) << count;
    EXPECT_GE(data.cuts.nodes().size(), data.cuts.count());
    EXPECT_LE(data.cuts.nodes().size(), data.cuts.count() * count);
  }
}

TEST(Precompute, StopsWhenCancelled) {
  Context context;
  const Scene scene = test::ballScene();
  const Tracer tracer(scene, context);
  context.cancel();
  EXPECT_THROW(precomputeVisibility(tracer, {}, context), Cancelled);
}

class VisibilityFile : public testing::Test {
 protected:
  void SetUp() override {
    Context context;
    data_ = precomputed(scene_, {}, context);
    save(data_, scene_, file_);
  }
  void expectRefused(const Scene& scene, const std::string& mentions) const {
    try {
      load(file_, scene);
      ADD_FAILURE() << "was read";
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(mentions), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find("data.cuts"), std::string::npos) << e.what();
    }
  }
  const test::TemporaryFolder folder_;
  const std::string file_ = folder_ / "data.cuts";
  const Scene scene_ = test::ballScene(4);
  VisibilityData data_;
};

TEST_F(VisibilityFile, GivesBackWhatWasSaved) {
  ASSERT_GT(data_.mesh.triangles().size(), data_.mesh.firstTriangle().back()) << "subdivided";
  expectSame(load(file_, scene_), data_);
}

TEST_F(VisibilityFile, DoesNotMindMaterialsLightsAndCameras) {
  Scene changed = scene_;
  changed.materials[0].diffuse = Rgb(0.1f);
  changed.materials[0].type = MaterialType::roughConductor;
  changed.emitters.emplace_back();
  changed.cameras.emplace_back();
  expectSame(load(file_, changed), data_);
}

TEST_F(VisibilityFile, IsOfOneGeometry) {
  Scene changed = scene_;
  changed.meshes[0].positions[3].z = 0.25f;
  expectRefused(changed, "other geometry");
  changed = scene_;
  changed.instances[1].toWorld = Transform(translation({0, 0, 1}));
  expectRefused(changed, "other geometry");
  changed = scene_;
  changed.instances[1].flipNormals = true;
  expectRefused(changed, "other geometry");
  changed = scene_;
  changed.instances.pop_back();
  expectRefused(changed, "other geometry");
}

TEST_F(VisibilityFile, IsOfOneFrontAndOneMask) {
  Scene changed = scene_;
  for (Vec3f& n : changed.meshes[1].normals) n = -n;  // they say which side is the front
  expectRefused(changed, "other geometry");
  changed = scene_;
  Material mask;
  mask.type = MaterialType::mask;
  mask.a = changed.instances[1].material;
  mask.opacity = 0.5f;
  changed.instances[1].material = test::addMaterial(changed, mask);
  expectRefused(changed, "masks");
  Context context;
  save(precomputed(changed, {}, context), changed, file_);
  EXPECT_NO_THROW(load(file_, changed));
  changed.materials.back().opacity = 0.25f;
  expectRefused(changed, "masks");
}

TEST_F(VisibilityFile, KnowsOneSideWhereOneWasOpaque) {
  Scene changed = scene_;
  changed.instances[1].material = test::addTwoSided(changed);
  expectRefused(changed, "'sphere' has come to scatter light from behind");
}

TEST_F(VisibilityFile, IsRefusedWhenDamaged) {
  const std::string good = test::readText(file_);
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    std::string bad = good;
    bad[rng.nextUint() % bad.size()] ^= static_cast<char>(1 << (i % 8));
    test::writeText(file_, bad);
    EXPECT_THROW(load(file_, scene_), InputError) << i;
  }
  test::writeText(file_, good.substr(0, good.size() / 2));
  EXPECT_THROW(load(file_, scene_), InputError);
  test::writeText(file_, "");
  EXPECT_THROW(load(file_, scene_), InputError);
}

// With a right checksum, too, as somebody would write it who means harm.
TEST_F(VisibilityFile, IsCheckedForSense) {
  const auto refused = [&](VisibilityData data, const std::string& mentions) {
    save(data, scene_, file_);
    expectRefused(scene_, mentions);
  };
  VisibilityData bad = data_;
  bad.samples.p[5] = Vec3f(3.f);
  refused(bad, "unit directions");
  bad = data_;
  bad.bothSides.pop_back();
  refused(bad, "two-sided");
  std::vector<CutNode> nodes(data_.cuts.nodes().begin(), data_.cuts.nodes().end());
  const std::vector<uint64_t> begin(data_.cuts.begins().begin(), data_.cuts.begins().end());
  nodes[0].level = static_cast<uint8_t>(nodes[0].level ^ 1);
  bad = data_;
  bad.cuts = CutSet(nodes, begin);
  refused(bad, "does not cover");
  nodes[0].level = 15;  // above the root
  bad.cuts = CutSet(nodes, begin);
  refused(bad, "does not cover");
  bad = data_;
  bad.cuts = CutSet({{10, 0}}, {0, 1});
  refused(bad, "1 cuts for");
}

}  // namespace
}  // namespace lobelia::relight
