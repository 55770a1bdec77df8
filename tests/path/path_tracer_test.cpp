#include "lobelia/path/path_tracer.h"

#include <gtest/gtest.h>

#include <cstring>

#include "lobelia/base/parallel.h"
#include "support/split_oracle.h"
#include "support/test_scenes.h"

namespace lobelia {
namespace {

using test::addMaterial;
using test::Lighting;
using test::Renderable;

Material materialOf(MaterialType type) {
  Material m;
  m.type = type;
  return m;
}

void expectNear(Vec3d value, Vec3d expected, double relative) {
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(value[c], expected[c], relative * std::abs(expected[c]) + 1e-9) << "channel " << c;
  }
}

// A lossless object in a white environment cannot be seen.
TEST(PathTracer, FurnaceOfLosslessMaterials) {
  Material glass = materialOf(MaterialType::dielectric);
  glass.ior = 1.5f;
  Material mirror = materialOf(MaterialType::conductor);
  for (const Material& material : {test::diffuseMaterial(Rgb(1.f)), glass, mirror}) {
    Scene scene;
    test::addSphere(scene, {}, 1, addMaterial(scene, material), {}, 48);
    Emitter white;
    white.type = EmitterType::constant;
    white.radiance = Rgb(1.f);
    test::addEmitter(scene, white);
    Camera camera;
    camera.toWorld = Transform(*lookAt({0, 0, -4}, {0, 0, 0}, {0, 1, 0}));
    camera.fovX = 0.45f;
    camera.width = camera.height = 24;
    scene.cameras.push_back(camera);
    Renderable r(scene);
    PathSettings settings;
    settings.spp = 64;
    const Film film = r.path(settings);
    expectNear(test::meanOf(film), Vec3d(1.0), 0.005);
    EXPECT_EQ(r.context.statistics.count("nonfinite"), 0u);
  }
}

// A closed box whose walls all shine: every point has radiance emission / (1 - albedo).
TEST(PathTracer, FurnaceOfAClosedBox) {
  Scene scene = test::boxScene(false);
  const EmitterHandle light = test::addAreaEmitter(scene, Rgb(1.f));
  scene.materials[0] = test::diffuseMaterial(Rgb(0.5f));
  for (Instance& wall : scene.instances) wall.emitter = light;
  Renderable r(scene);
  PathSettings settings;
  settings.spp = 100;
  settings.rouletteDepth = 12;
  expectNear(test::meanOf(r.path(settings)), Vec3d(2.0), 0.005);
}

// Depth counts as Mitsuba's: 1 emission, 2 direct light, each more one bounce.
TEST(PathTracer, MaxDepthCountsEdges) {
  Scene scene = test::boxScene(false);
  const EmitterHandle light = test::addAreaEmitter(scene, Rgb(1.f));
  scene.materials[0] = test::diffuseMaterial(Rgb(0.5f));
  for (Instance& wall : scene.instances) wall.emitter = light;
  Renderable r(scene);
  double expected = 0;
  for (int depth = 0; depth <= 4; ++depth) {
    PathSettings settings;
    settings.spp = 128;
    settings.maxDepth = depth;
    expectNear(test::meanOf(r.path(settings)), Vec3d(expected), 0.01);
    expected += std::pow(0.5, depth);
  }
}

TEST(PathTracer, SplitsDirectAndIndirectByDefinition) {
  for (int variant = 0; variant < 4; ++variant) {
    Scene scene = test::boxScene();
    if (variant == 1) test::addPane(scene);
    if (variant == 2) {
      scene.instances[test::floorWall].material =
          addMaterial(scene, materialOf(MaterialType::plastic));
    }
    if (variant == 3) {
      Material metal = materialOf(MaterialType::roughConductor);
      metal.alphaU = metal.alphaV = 0.25f;
      scene.instances[test::backWall].material = addMaterial(scene, metal);
      Material coat = materialOf(MaterialType::roughPlastic);
      coat.alphaU = coat.alphaV = 0.05f;  // sharp, but no delta
      scene.instances[test::floorWall].material = addMaterial(scene, coat);
    }
    Renderable r(scene);
    PathSettings settings;
    settings.spp = variant == 1 ? 800 : 200;
    settings.maxDepth = 6;
    const Film film = r.path(settings, {"direct", "indirect"});
    const test::SplitMeans slow =
        test::SplitOracle{r.tracer, r.emitters, settings.specularLimit, 6}.mean(
            scene.cameras[0], variant == 1 ? 1000 : 500, 9);
    const auto wide = [](Rgb c) { return Vec3d(double{c.x}, double{c.y}, double{c.z}); };
    SCOPED_TRACE(variant);
    expectNear(test::meanOf(film, "direct"), wide(slow.direct), 0.025);
    expectNear(test::meanOf(film, "indirect"), wide(slow.indirect), 0.025);
  }
}

TEST(PathTracer, ComponentsAddUp) {
  Renderable r(test::boxScene());
  PathSettings settings;
  settings.spp = 32;
  const Film all = r.path(settings, {"direct", "indirect"});
  settings.component = Component::direct;
  const Film direct = r.path(settings, {"direct", "indirect"});
  settings.component = Component::indirect;
  const Film indirect = r.path(settings, {"direct", "indirect"});
  for (size_t i = 0; i < all.pixelCount(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float sum = all.rgb(i, "direct")[c] + all.rgb(i, "indirect")[c];
      EXPECT_NEAR(all.rgb(i)[c], sum, 1e-5f * (1 + sum));
    }
    EXPECT_EQ(direct.rgb(i, "indirect"), Rgb{});
    EXPECT_EQ(indirect.rgb(i, "direct"), Rgb{});
  }
  expectNear(test::meanOf(direct), test::meanOf(all, "direct"), 0.02);
  expectNear(test::meanOf(indirect), test::meanOf(all, "indirect"), 0.03);
}

// Next-event estimation against nothing but BSDF samples that meet emitters.
TEST(PathTracer, AgreesWithBlindPathsUnderEveryExtendedEmitter) {
  for (const Lighting l : {Lighting::quad, Lighting::texturedQuad, Lighting::sphere,
                           Lighting::meshSphere, Lighting::insideOut, Lighting::constant,
                           Lighting::environment, Lighting::sun, Lighting::sunAndSky}) {
    Scene scene = test::stageScene();
    Material metal = materialOf(MaterialType::roughConductor);
    metal.alphaU = metal.alphaV = 0.3f;
    scene.instances[1].material = addMaterial(scene, metal);
    addLighting(scene, l);
    Renderable r(scene);
    PathSettings settings;
    settings.spp = 100;
    settings.maxDepth = 3;
    const Film film = r.path(settings);
    const test::SplitMeans slow =
        test::SplitOracle{r.tracer, r.emitters, 0.08f, 3}.mean(scene.cameras[0], 1200, 10);
    SCOPED_TRACE(nameOf(l));
    const Rgb blind = slow.direct + slow.indirect;
    expectNear(test::meanOf(film), Vec3d(double{blind.x}, double{blind.y}, double{blind.z}), 0.03);
  }
}

TEST(PathTracer, SameBitsForAnyNumberOfThreads) {
  Scene scene = test::stageScene();
  addLighting(scene, Lighting::mixed);
  Renderable r(scene);
  r.context.seed = 5;
  PathSettings settings;
  settings.spp = 9;
  const auto layers = {"direct", "indirect", "albedo", "normal", "depth", "variance"};
  const auto pictures = [&](int threads) {
    const ThreadLimit limit(threads);
    return std::pair(r.path(settings, layers), r.light(settings, layers));
  };
  const auto one = pictures(1);
  for (const int threads : {2, 5}) {
    const auto more = pictures(threads);
    for (const auto& [name, layer] : one.first.layers) {
      const auto& a = layer.values;
      const auto& b = more.first.layers.at(name).values;
      EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(float)), 0) << name;
      const auto& c = one.second.layers.at(name).values;
      const auto& d = more.second.layers.at(name).values;
      EXPECT_EQ(std::memcmp(c.data(), d.data(), c.size() * sizeof(float)), 0) << "light " << name;
    }
  }
  r.context.seed = 6;
  EXPECT_NE(pictures(1).first.layers.at("").values, one.first.layers.at("").values);
}

TEST(PathTracer, VarianceLayerIsTheVarianceOfTheMean) {
  Renderable r(test::boxScene());
  PathSettings settings;
  settings.spp = 16;
  double promised = 0, found = 0;
  std::vector<Film> films;
  for (uint64_t seed = 0; seed < 24; ++seed) {
    r.context.seed = seed;
    films.push_back(r.path(settings, {"variance"}));
  }
  for (size_t i = 0; i < films[0].pixelCount(); ++i) {
    double sum = 0, square = 0;
    for (const Film& film : films) {
      const double v = double{film.rgb(i).y};
      sum += v, square += v * v;
      promised += double{film.rgb(i, "variance").y} / 24;
    }
    found += (square - sum * sum / 24) / 23;
  }
  // Stratified samples do better than independent ones, which the estimate takes them for.
  EXPECT_LT(found, 1.1 * promised);
  EXPECT_GT(found, 0.05 * promised);
}

TEST(PathTracer, GuideLayersDescribeTheFirstSurface) {
  Scene scene = test::boxScene();
  scene.cameras[0].toWorld = Transform(*lookAt({0, 0, -0.95}, {0, 0, 1}, {0, 1, 0}));
  scene.cameras[0].fovX = 0.2f;
  Renderable r(scene);
  PathSettings settings;
  settings.spp = 4;
  const Film film = r.path(settings, {"albedo", "normal", "depth"});
  const size_t middle = film.pixelCount() / 2 + static_cast<size_t>(film.width) / 2;
  EXPECT_NEAR(film.rgb(middle, "albedo").x, 0.6f, 1e-3f);
  EXPECT_NEAR(film.rgb(middle, "normal").z, -1, 1e-3f);
  EXPECT_NEAR(film.layers.at("depth").values[middle], 1.95f, 0.02f);
}

TEST(PathTracer, ChosenPixelsEqualThoseOfTheWholePicture) {
  Scene scene = test::boxScene();
  scene.cameras[0].cropX0 = 3, scene.cameras[0].cropY0 = 2;
  scene.cameras[0].cropX1 = 17, scene.cameras[0].cropY1 = 14;
  Renderable r(scene);
  PathSettings settings;
  settings.spp = 8;
  const Film whole = r.path(settings);
  settings.pixels = spreadPixels(whole.width, whole.height, 20, 1);
  const Film some = r.path(settings);
  ASSERT_EQ(some.alpha.size(), some.pixelCount());
  size_t chosen = 0;
  for (size_t i = 0; i < some.pixelCount(); ++i) {
    const bool in = std::binary_search(settings.pixels.pixels.begin(), settings.pixels.pixels.end(),
                                       static_cast<uint32_t>(i));
    EXPECT_EQ(some.alpha[i], in ? 1.f : 0.f);
    EXPECT_EQ(some.rgb(i), in ? whole.rgb(i) : Rgb{});
    chosen += in;
  }
  EXPECT_EQ(chosen, 20u);
}

TEST(PathTracer, HidesEmittersFromTheCameraAlone) {
  Scene scene = test::stageScene();
  addLighting(scene, Lighting::sphere);
  Renderable r(scene);
  PathSettings settings;
  settings.spp = 64;
  settings.maxDepth = 1;
  EXPECT_GT(test::meanOf(r.path(settings)).x, 0.01);
  settings.hideEmitters = true;
  EXPECT_EQ(test::meanOf(r.path(settings)).x, 0);
  settings.maxDepth = 2;
  EXPECT_GT(test::meanOf(r.path(settings)).x, 0.01);
}

TEST(PathTracer, TimeLimitAndCancellationLeaveAnUnbiasedMean) {
  Renderable r(test::boxScene());
  PathSettings settings;
  settings.spp = 64;
  const Vec3d full = test::meanOf(r.path(settings));
  settings.spp = 1 << 28;
  settings.timeLimit = 0.3;
  expectNear(test::meanOf(r.path(settings)), full, 0.05);
  r.context.cancel();
  EXPECT_EQ(test::meanOf(r.path(settings)), Vec3d{});
}

TEST(PathTracer, CountsNonFiniteSamplesAndDropsThem) {
  Scene scene = test::boxScene();
  scene.emitters[0].radiance = Rgb(std::numeric_limits<float>::quiet_NaN(), 1, 1);
  Renderable r(scene);
  PathSettings settings;
  settings.spp = 4;
  const Film film = r.path(settings);
  EXPECT_EQ(countNonFinite(film), 0u);
  EXPECT_GT(r.context.statistics.count("nonfinite"), 0u);
}

}  // namespace
}  // namespace lobelia
