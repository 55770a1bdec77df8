#include "lobelia/path/receivers.h"

#include <gtest/gtest.h>

#include <cstring>

#include "lobelia/base/parallel.h"
#include "support/box_scene.h"
#include "support/split_oracle.h"

namespace lobelia {
namespace {

using test::addMaterial;
using test::boxScene;

Film filmOf(const Camera& camera) {
  Film film;
  film.fullWidth = film.width = camera.width;
  film.fullHeight = film.height = camera.height;
  for (const char* name : {"direct", "indirect", "specular", "albedo", "normal"})
    film.addLayer(name);
  film.addLayer("depth", 1);
  return film;
}

Rgb meanOf(const Film& film, const char* layer) {
  Vec3d sum;
  for (size_t i = 0; i < film.pixelCount(); ++i) {
    const Rgb c = film.rgb(i, layer);
    sum += Vec3d(c.x, c.y, c.z);
  }
  sum = sum / static_cast<double>(film.pixelCount());
  return {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)};
}

void expectNear(Rgb value, Rgb expected, float relative) {
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(value[c], expected[c], relative * std::abs(expected[c])) << "channel " << c;
}

// A scene with what it takes to send eye paths through it.
struct EyePass {
  explicit EyePass(Scene s)
      : scene(std::move(s)), tracer(scene, context), emitters(scene, tracer.bounds()) {}

  Receivers run(Film& film, const EyeSettings& settings, int y0 = 0, int y1 = -1) {
    const Camera& camera = scene.cameras[0];
    return traceReceivers(tracer, emitters, camera, settings, y0, y1 < 0 ? camera.height : y1, film,
                          context);
  }
  Film average(EyeSettings settings, int spp) {
    Film film = filmOf(scene.cameras[0]);
    settings.sampleCount = spp;
    for (settings.sample = 0; settings.sample < spp; ++settings.sample) run(film, settings);
    return film;
  }
  test::SplitMeans oracle(int maxDepth, int spp) {
    return test::SplitOracle{tracer, emitters, 0.08f, maxDepth}.mean(scene.cameras[0], spp, 7);
  }

  Context context;
  Scene scene;
  Tracer tracer;
  EmitterSampler emitters;
};

Scene mirrorScene() {
  Scene scene = boxScene();
  Material mirror;
  mirror.type = MaterialType::conductor;
  mirror.specular = Rgb(0.9f);
  scene.instances[test::backWall].material = addMaterial(scene, mirror);
  return scene;
}

// Floor and left wall with a coat, smooth on the floor and of roughness alpha on the wall.
Scene coatedScene(float alpha) {
  Scene scene = boxScene();
  Material plastic;
  plastic.type = MaterialType::plastic;
  plastic.ior = 1.9f;
  plastic.diffuse = Rgb(0.5f, 0.4f, 0.3f);
  scene.instances[test::floorWall].material = addMaterial(scene, plastic);
  plastic.type = MaterialType::roughPlastic;
  plastic.alphaU = alpha;
  plastic.alphaV = alpha;
  scene.instances[test::leftWall].material = addMaterial(scene, plastic);
  return scene;
}

Scene paneScene() {
  Scene scene = boxScene();
  test::addPane(scene);
  return scene;
}

TEST(Receivers, ADiffuseRoomHasOnePerSample) {
  EyePass pass(boxScene());
  Film film = filmOf(pass.scene.cameras[0]);
  const Receivers receivers = pass.run(film, {});
  // Pixels in which the lamp is seen have a receiver too: its surface, which reflects nothing, may
  // or may not have a lobe.
  EXPECT_LE(receivers.points.size(), film.pixelCount());
  EXPECT_GE(receivers.points.size(), film.pixelCount() * 9 / 10);
  for (const ReceiverPoint& r : receivers.points) {
    EXPECT_EQ(r.depth, 1);
    EXPECT_TRUE(r.primary);
    ASSERT_EQ(r.lobeCount, 1);
    EXPECT_EQ(receivers.lobes[r.firstLobe].type, LobeType::lambert);
    EXPECT_NEAR(r.weight.x, 1, 1e-5);
  }
  EXPECT_EQ(pass.context.statistics.count("specular_connections"), 0u);
  EXPECT_EQ(meanOf(film, "indirect"), Rgb(0.f));
}

TEST(Receivers, NeighboursInTheArrayAreNearOnTheScreen) {
  EyePass pass(boxScene(false));
  Film film = filmOf(pass.scene.cameras[0]);
  const Receivers receivers = pass.run(film, {});
  const auto tileOf = [&](uint32_t pixel) {
    const uint32_t w = static_cast<uint32_t>(film.width);
    return (pixel / w / 8) * ((w + 7) / 8) + pixel % w / 8;
  };
  for (size_t i = 1; i < receivers.points.size(); ++i)
    ASSERT_LE(tileOf(receivers.points[i - 1].pixel), tileOf(receivers.points[i].pixel));
  for (size_t i = 0; i + 16 <= 64; i += 16) {  // the first tile: blocks of 4 x 4
    for (size_t k = 1; k < 16; ++k) {
      const int a = static_cast<int>(receivers.points[i].pixel),
                b = static_cast<int>(receivers.points[i + k].pixel);
      EXPECT_LT(std::abs(a % film.width - b % film.width), 4);
      EXPECT_LT(std::abs(a / film.width - b / film.width), 4);
    }
  }
}

TEST(Receivers, MirrorsLeadToTheSurfacesSeenInThem) {
  EyePass pass(mirrorScene());
  Film film = filmOf(pass.scene.cameras[0]);
  const Receivers receivers = pass.run(film, {});
  size_t reflected = 0;
  for (const ReceiverPoint& r : receivers.points) {
    const bool onSideWall = std::abs(r.p.x) > 0.99f || std::abs(r.p.y) > 0.97f;
    EXPECT_TRUE(onSideWall || r.p.z < 0.999f) << "the mirror itself is no receiver";
    if (r.depth != 2) continue;
    ++reflected;
    EXPECT_TRUE(r.primary);
    EXPECT_NEAR(r.weight.x, 0.9f, 1e-3);
  }
  EXPECT_GT(reflected, film.pixelCount() / 10);
}

TEST(Receivers, CoatsAreReceiversAndGoOn) {
  EyePass pass(coatedScene(0.05f));
  Film film = filmOf(pass.scene.cameras[0]);
  const Receivers receivers = pass.run(film, {});
  std::vector<int> depths(film.pixelCount(), 0);  // bit d: a primary receiver of depth d
  for (const ReceiverPoint& r : receivers.points) {
    for (int i = 0; i < r.lobeCount; ++i)
      EXPECT_FALSE(receivers.lobes[r.firstLobe + static_cast<uint32_t>(i)].sharp);
    if (r.primary) depths[r.pixel] |= 1 << r.depth;
  }
  const auto both = std::count_if(depths.begin(), depths.end(), [](int d) { return (d & 6) == 6; });
  EXPECT_GT(both, 5);
  EXPECT_GT(pass.context.statistics.count("specular_connections"), 10u);
}

TEST(Receivers, DepthLimits) {
  EyePass pass(boxScene());
  EyeSettings settings;
  settings.maxDepth = 1;
  Film emission = filmOf(pass.scene.cameras[0]);
  EXPECT_TRUE(pass.run(emission, settings).points.empty());
  const Rgb seen = meanOf(emission, "direct");
  EXPECT_GT(seen.x, 0.01f);
  EXPECT_NEAR(seen.y / seen.x, 4.f / 3.f, 1e-4);

  settings.maxDepth = 2;
  Film direct = filmOf(pass.scene.cameras[0]);
  EXPECT_TRUE(pass.run(direct, settings).points.empty());
  EXPECT_GT(meanOf(direct, "direct").x, seen.x * 1.1f);

  settings.maxDepth = 1;
  settings.hideEmitters = true;
  Film hidden = filmOf(pass.scene.cameras[0]);
  pass.run(hidden, settings);
  EXPECT_EQ(meanOf(hidden, "direct"), Rgb(0.f));
}

TEST(Receivers, PixelSetsAndRowsGiveTheSameBits) {
  EyePass pass(coatedScene(0.05f));
  const Camera& camera = pass.scene.cameras[0];
  Film whole = filmOf(camera);
  pass.run(whole, {});
  Film halves = filmOf(camera);
  pass.run(halves, {}, 0, 5);
  pass.run(halves, {}, 5, camera.height);
  EXPECT_EQ(whole.layers.at("direct").values, halves.layers.at("direct").values);
  EXPECT_EQ(whole.layers.at("specular").values, halves.layers.at("specular").values);

  EyeSettings settings;
  settings.pixels.pixels = {3, 77, 78, 201};
  Film some = filmOf(camera);
  const Receivers receivers = pass.run(some, settings);
  for (uint32_t i = 0; i < some.pixelCount(); ++i) {
    const bool chosen =
        std::count(settings.pixels.pixels.begin(), settings.pixels.pixels.end(), i) > 0;
    EXPECT_EQ(some.rgb(i, "direct"), chosen ? whole.rgb(i, "direct") : Rgb(0.f));
  }
  EXPECT_GE(receivers.points.size(), 4u);
}

TEST(Receivers, TheNumberOfThreadsChangesNothing) {
  std::vector<Film> films;
  std::vector<Receivers> receivers;
  for (const int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    EyePass pass(coatedScene(0.05f));
    films.push_back(filmOf(pass.scene.cameras[0]));
    receivers.push_back(pass.run(films.back(), {}));
  }
  for (size_t i = 1; i < films.size(); ++i) {
    for (const auto& [name, layer] : films[0].layers)
      EXPECT_EQ(layer.values, films[i].layers.at(name).values) << name;
    ASSERT_EQ(receivers[0].points.size(), receivers[i].points.size());
    ASSERT_EQ(receivers[0].lobes.size(), receivers[i].lobes.size());
    for (size_t k = 0; k < receivers[0].points.size(); ++k) {
      EXPECT_EQ(receivers[0].points[k].p, receivers[i].points[k].p);
      EXPECT_EQ(receivers[0].points[k].weight, receivers[i].points[k].weight);
      EXPECT_EQ(receivers[0].points[k].firstLobe, receivers[i].points[k].firstLobe);
    }
  }
}

// Direct light needs no virtual lights: it must be the plain path tracer's whatever the surfaces.
TEST(Receivers, DirectLightIsThePathTracers) {
  for (const Scene& scene : {boxScene(), mirrorScene(), coatedScene(0.05f), coatedScene(0.3f)}) {
    EyePass pass(scene);
    const Film film = pass.average({}, 256);
    expectNear(meanOf(film, "direct"), pass.oracle(-1, 1200).direct, 0.02f);
  }
}

// Behind a pane of two surfaces every path of four edges is a specular connection: receiver, glass,
// glass, lamp. So are those of three edges beside a mirror of roughness below the limit.
TEST(Receivers, SpecularConnectionsAreComplete) {
  EyePass pane(paneScene());
  EyeSettings settings;
  settings.maxDepth = 4;
  const Film film = pane.average(settings, 128);
  const auto expected = pane.oracle(4, 1500);
  expectNear(meanOf(film, "indirect"), expected.indirect, 0.03f);
  EXPECT_EQ(film.layers.at("indirect").values, film.layers.at("specular").values);
  expectNear(meanOf(film, "direct"), expected.direct, 0.03f);
  EXPECT_GT(pane.context.statistics.count("specular_connections"), 1000u);
}

// Without direct samples receivers leave emitters to virtual lights, but chains still reach them.
TEST(Receivers, WithoutDirectSamplesOnlySharpLobesAreLit) {
  EyePass pass(mirrorScene());
  EyeSettings settings;
  settings.maxDepth = 2;
  settings.directSamples = 0;
  const Film film = pass.average(settings, 32);
  test::SplitOracle oracle{pass.tracer, pass.emitters, 0.08f, 2};
  // Emission seen, and seen in the mirror: the receivers' share of two edges is missing.
  EyeSettings emission = settings;
  emission.maxDepth = 1;
  const Rgb seen = meanOf(pass.average(emission, 32), "direct");
  const Rgb both = meanOf(film, "direct");
  EXPECT_GT(both.x, seen.x);
  EXPECT_LT(both.x, oracle.mean(pass.scene.cameras[0], 50, 3).direct.x);
  Film once = filmOf(pass.scene.cameras[0]);
  EXPECT_FALSE(pass.run(once, settings).points.empty()) << "lights on emitters reach depth 2";
}

}  // namespace
}  // namespace lobelia
