// Frames under local lights: against sums over all samples, against light by formula, and what they
// do not depend on.
#include "lobelia/relight/local_frame.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/relight/bounced_light.h"
#include "lobelia/relight/precompute.h"
#include "relight/scenes.h"

namespace lobelia::relight {
namespace {

Emitter pointLight(Vec3d at, Rgb intensity) {
  Emitter light;
  light.type = EmitterType::point;
  light.toWorld = Transform(translation(at));
  light.radiance = intensity;
  return light;
}

Material metal(float alpha) {
  Material m;
  m.type = MaterialType::roughConductor;
  m.alphaU = m.alphaV = alpha;
  return m;
}

// A closed room, lit by a point or by the lamp under its ceiling.
Scene room(bool lamp, bool glossyFloor) {
  Scene scene = test::boxScene(lamp);
  if (!lamp) scene.emitters.push_back(pointLight({0.3, 0.6, 0.2}, Rgb(3, 2, 1)));
  if (glossyFloor) {
    scene.instances[test::floorWall].material = test::addMaterial(scene, metal(0.3f));
  }
  scene.cameras[0].width = 24, scene.cameras[0].height = 18;
  return scene;
}

struct Stage {
  Scene scene;
  Context context;
  Tracer tracer{scene, context};
  EmitterSampler emitters{scene, bounds(scene)};
  VisibilityData data;
  LocalRenderer renderer;

  Stage(Scene s, float sigma, size_t samples = 256, size_t mostNodes = 1000)
      : scene(std::move(s)),
        data(precomputeVisibility(tracer,
                                  {.light = LightSamples::Kind::surfaces,
                                   .sampleCount = samples,
                                   .sigma = sigma,
                                   .mostNodes = mostNodes,
                                   .clusterCount = 16,
                                   .subdivision = 1},
                                  context)),
        renderer(tracer, emitters, data) {}

  Film film(const LocalSettings& settings) {
    Film film;
    film.width = film.fullWidth = scene.cameras[0].width;
    film.height = film.fullHeight = scene.cameras[0].height;
    film.addLayer("");
    renderer.render(renderer.light(settings, context), scene.cameras[0], settings, film, context);
    return film;
  }
};

double meanOf(const Film& film) {
  double sum = 0;
  for (const float v : film.layers.at("").values) sum += static_cast<double>(v);
  return sum / static_cast<double>(film.layers.at("").values.size());
}
double l2(const Film& a, const Film& b) {
  double difference = 0, all = 0;
  const auto &x = a.layers.at("").values, &y = b.layers.at("").values;
  for (size_t i = 0; i < x.size(); ++i)
    difference += static_cast<double>(sqr(x[i] - y[i])), all += static_cast<double>(sqr(y[i]));
  return std::sqrt(difference / all);
}

// Visibility of a leaf, read from a cut whatever its nodes.
float seen(std::span<const CutNode> cut, uint32_t leaf) {
  uint32_t end = 0;
  for (const CutNode node : cut)
    if (leaf < (end += 1u << node.level)) return static_cast<float>(node.value) / 255;
  return 0;
}

// The sum over all samples at the pixel's surface [P004 eq. 1], in doubles.
Rgb bruteForce(const Stage& stage, const std::vector<Rgb>& radiance, int x, int y) {
  const Ray ray =
      generateRay(stage.scene.cameras[0],
                  {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, {0.5f, 0.5f});
  const Hit hit = *stage.tracer.intersect(ray);
  const SurfacePoint at = surfacePoint(stage.scene, hit);
  const Bsdf bsdf = makeBsdf(stage.scene, at, -ray.d, 0);
  const SurroundingVertices around = stage.data.mesh.at(hit.instance, hit.triangle, hit.b1, hit.b2);
  double sum[3] = {};
  for (uint32_t i = 0; i < radiance.size(); ++i) {
    const float area = stage.data.samples.measure[i];
    Vec3f v = stage.data.samples.p[i] - at.p;
    const Vec3f n = stage.data.samples.n[i];
    const float height = -dot(v, n), least = 0.5f * std::sqrt(area / kPi);
    if (height > 0 && height < least) v -= n * (least - height);  // NearLights
    const float d2 = lengthSquared(v);
    const Vec3f wi = normalize(v);
    const float cosine = -dot(n, wi);
    if (!(cosine > 0) || !(dot(at.ng, wi) * dot(at.ng, -ray.d) > 0)) continue;
    float visible = 0;
    for (size_t k = 0; k < 3; ++k)
      visible += around.weight[k] * seen(stage.data.cuts.cut(around.vertex[k]), i);
    const Rgb value =
        radiance[i] * evaluate(bsdf, -ray.d, wi) * (visible * area * cosine / (d2 + area / kPi));
    for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(value[c]);
  }
  return {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
}

TEST(LocalFrame, WithAllNodesIsTheSumOverAllSamples) {
  Stage stage(room(false, false), 0, 256, size_t{1} << 15);
  const LocalSettings settings{.nodeCount = 256, .direct = false};
  const Film film = stage.film(settings);
  const SampleSurfaces surfaces(stage.tracer, stage.data.samples);
  EXPECT_EQ(surfaces.lost(), 0u);
  const LocalSources sources(stage.scene);
  const std::vector<Rgb> radiance = surfaces.radiance(stage.tracer, sources, 1, stage.context);
  for (int y = 0; y < film.height; y += 3)
    for (int x = 0; x < film.width; x += 3) {
      const Rgb expected = bruteForce(stage, radiance, x, y);
      const Rgb value = film.rgb(static_cast<size_t>(y * film.width + x));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c] / expected[c], 1, 1e-4) << x << "," << y;
    }
}

TEST(LocalFrame, SmallerCutsComeNear) {
  for (const bool glossy : {false, true}) {
    Stage stage(room(false, glossy), 1, 1024);
    const Film all = stage.film({.nodeCount = 1024, .direct = false});
    double last = 1;
    for (const size_t nodes : {size_t{64}, size_t{256}}) {
      const Film some = stage.film({.nodeCount = nodes, .direct = false});
      const double error = l2(some, all);
      EXPECT_LT(error, nodes == 64 ? 0.1 : 0.03) << nodes << glossy;
      EXPECT_LT(error, last);
      EXPECT_NEAR(meanOf(some) / meanOf(all), 1, nodes == 64 ? 0.07 : 0.015) << nodes << glossy;
      last = error;
    }
  }
}

TEST(LocalFrame, HalfTheSamplesGiveTheSameMean) {
  Stage many(room(false, false), 1, 1024), few(room(false, false), 1, 512);
  const LocalSettings settings{.direct = false};
  EXPECT_NEAR(meanOf(few.film(settings)) / meanOf(many.film(settings)), 1, 0.02);
}

TEST(LocalFrame, DirectLightOfAPointIsItsIntensityOverDistanceSquared) {
  Stage stage(room(false, false), 2);
  const Film film = stage.film({.bounced = false});
  for (int y = 0; y < film.height; y += 5)
    for (int x = 0; x < film.width; x += 5) {
      const Ray ray =
          generateRay(stage.scene.cameras[0],
                      {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, {0.5f, 0.5f});
      const SurfacePoint at = surfacePoint(stage.scene, *stage.tracer.intersect(ray));
      const Vec3f v = Vec3f(0.3f, 0.6f, 0.2f) - at.p;
      const Rgb expected = Rgb(3, 2, 1) * Rgb(0.6f, 0.5f, 0.4f) *
                           (std::abs(dot(at.ng, normalize(v))) / (kPi * lengthSquared(v)));
      const Rgb value = film.rgb(static_cast<size_t>(y * film.width + x));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c] / expected[c], 1, 1e-3) << x << "," << y;
    }
}

TEST(LocalFrame, DirectAndBouncedLightAddUp) {
  Stage stage(room(true, true), 2);
  const Film all = stage.film({}), direct = stage.film({.bounced = false}),
             bounced = stage.film({.direct = false, .hideEmitters = true});
  Film sum = direct;
  for (size_t i = 0; i < sum.layers.at("").values.size(); ++i)
    sum.layers.at("").values[i] += bounced.layers.at("").values[i];
  EXPECT_LT(l2(sum, all), 1e-6);
  // And onto a picture that has emission already.
  Film onto;
  onto.width = all.width, onto.height = all.height;
  onto.addLayer("");
  const LocalSettings add{.add = true}, hidden{.hideEmitters = true};
  for (int i = 0; i < 2; ++i)
    stage.renderer.render(stage.renderer.light(add, stage.context), stage.scene.cameras[0], add,
                          onto, stage.context);
  EXPECT_NEAR(meanOf(onto) / meanOf(stage.film(hidden)), 2, 1e-5);
}

TEST(LocalFrame, SamePixelsForAnyNumberOfThreadsAndMemoryForVertices) {
  Stage stage(room(true, true), 2);
  const Film once = stage.film({.spp = 2});
  for (const size_t bytes : {size_t{1}, size_t{1} << 15})
    EXPECT_EQ(stage.film({.spp = 2, .cacheBytes = bytes}).layers.at("").values,
              once.layers.at("").values);
  const ThreadLimit one(1);
  EXPECT_EQ(stage.film({.spp = 2}).layers.at("").values, once.layers.at("").values);
}

TEST(LocalFrame, MovedLightsAndChangedMaterialsAreSeenAtOnce) {
  Stage stage(room(false, false), 2);
  const Film before = stage.film({.direct = false});
  // The light a fifth as bright in red, the walls as they were.
  stage.scene.emitters[0] = pointLight({0.3, 0.6, 0.2}, Rgb(0.6f, 2, 1));
  const EmitterSampler emitters(stage.scene, bounds(stage.scene));
  stage.renderer.relight(emitters);
  const Film dimmer = stage.film({.direct = false});
  EXPECT_NEAR(dimmer.rgb(100).x / before.rgb(100).x, 0.2, 1e-4);
  EXPECT_NEAR(dimmer.rgb(100).y / before.rgb(100).y, 1, 1e-4);
  // Half the albedo: a quarter of the light after one bounce.
  stage.scene.materials[0].diffuse = Rgb(0.3f, 0.25f, 0.2f);
  const Film darker = stage.film({.direct = false});
  EXPECT_NEAR(dimmer.rgb(100).y / darker.rgb(100).y, 4, 1e-3);
}

// Rays that follow smooth lobes cannot meet points.
TEST(LocalFrame, PointsShineInLobesThatRaysFollow) {
  Scene scene = room(false, false);
  scene.instances[test::backWall].material = test::addMaterial(scene, metal(0.05f));
  Stage stage(std::move(scene), 2);
  const Film film = stage.film({.bounced = false});
  float brightest = 0;
  for (int y = 0; y < film.height; ++y)
    for (int x = 0; x < film.width; ++x) {
      const Ray ray =
          generateRay(stage.scene.cameras[0],
                      {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, {0.5f, 0.5f});
      const Hit hit = *stage.tracer.intersect(ray);
      if (hit.instance != test::backWall) continue;
      const SurfacePoint at = surfacePoint(stage.scene, hit);
      const Vec3f v = Vec3f(0.3f, 0.6f, 0.2f) - at.p;
      const Rgb expected = Rgb(3, 2, 1) *
                           evaluate(makeBsdf(stage.scene, at, -ray.d, 0), -ray.d, normalize(v)) /
                           lengthSquared(v);
      const Rgb value = film.rgb(static_cast<size_t>(y * film.width + x));
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(value[c], expected[c], 1e-3f * expected[c] + 1e-6f) << x << "," << y;
      brightest = std::max(brightest, value.x);
    }
  EXPECT_GT(brightest, 1);
}

// What rays follow on is not counted as if it were diffuse, too.
TEST(LocalFrame, SurfacesInMirrorsSendOnWhatNoRayFollows) {
  Scene scene = room(false, false);
  scene.instances[test::backWall].material = test::addMaterial(scene, metal(0.05f));
  const SurfacePoint at =
      surfacePoint(scene, {0, 1.f / 3, 1.f / 3, static_cast<uint32_t>(test::backWall), 0});
  EXPECT_GT(bouncePoint(scene, at, at.ng, {}, 0).albedo.x, 0.2f);
  EXPECT_EQ(bouncePoint(scene, at, at.ng, {}, 0.07f).albedo, Rgb{});
  EXPECT_GT(bouncePoint(scene, at, at.ng, {}, 0.04f).albedo.x, 0.2f);
}

TEST(LocalFrame, BouncedLightAloneShowsNoBackgroundInMirrors) {
  Scene scene = room(false, false);
  ASSERT_EQ(scene.instances.size() - 1, static_cast<size_t>(test::frontWall));
  scene.instances.pop_back();  // open behind the camera
  Material mirror;
  mirror.type = MaterialType::conductor;
  scene.instances[test::backWall].material = test::addMaterial(scene, mirror);
  Emitter sky;
  sky.type = EmitterType::constant;
  sky.radiance = Rgb(1000.f);
  scene.emitters.push_back(sky);
  Stage stage(std::move(scene), 2);
  const Film bounced = stage.film({.direct = false}), all = stage.film({});
  float most = 0, mostOfAll = 0;
  for (const float v : bounced.layers.at("").values) most = std::max(most, v);
  for (const float v : all.layers.at("").values) mostOfAll = std::max(mostOfAll, v);
  EXPECT_LT(most, 10);
  EXPECT_GT(mostOfAll, 100);
}

TEST(LocalFrame, CostIsWhatWasEvaluatedAtEachPixel) {
  Stage stage(room(false, true), 2);
  Film film;
  film.width = film.fullWidth = stage.scene.cameras[0].width;
  film.height = film.fullHeight = stage.scene.cameras[0].height;
  film.addLayer("");
  film.addLayer("cost", 1);
  const auto cost = [&] {
    double sum = 0;
    for (const float v : film.layers.at("cost").values) sum += static_cast<double>(v);
    return sum;
  };
  const auto render = [&](const LocalSettings& settings) {
    stage.renderer.render(stage.renderer.light(settings, stage.context), stage.scene.cameras[0],
                          settings, film, stage.context);
  };
  render({.spp = 2});
  const auto counted = static_cast<double>(stage.context.statistics.count("evaluations"));
  EXPECT_GT(counted, 0);
  EXPECT_NEAR(cost() / (counted / 2), 1, 1e-6);
  render({.spp = 2, .add = true});
  EXPECT_NEAR(cost() / counted, 1, 1e-6);
  // Direct light alone takes no nodes, and neither a cut nor the samples' light.
  const uint64_t nodes = stage.context.statistics.count("cut_nodes");
  const LocalSettings direct{.bounced = false};
  stage.renderer.render({}, stage.scene.cameras[0], direct, film, stage.context);
  EXPECT_EQ(cost(), 0);
  EXPECT_EQ(stage.context.statistics.count("cut_nodes"), nodes);
}

TEST(LocalFrame, WantsDataOfSurfaces) {
  Scene scene = room(false, false);
  Context context;
  const Tracer tracer(scene, context);
  const EmitterSampler emitters(scene, bounds(scene));
  const VisibilityData data =
      precomputeVisibility(tracer, {.sampleCount = 256, .clusterCount = 16}, context);
  EXPECT_THROW(LocalRenderer(tracer, emitters, data), UsageError);
}

}  // namespace
}  // namespace lobelia::relight
