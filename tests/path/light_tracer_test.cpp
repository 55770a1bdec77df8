// Light tracing and path tracing are two estimates of the same picture.
#include <gtest/gtest.h>

#include "support/test_scenes.h"

namespace lobelia {
namespace {

using test::Lighting;
using test::Renderable;

// Means of the picture, of its parts and of its halves agree within four standard errors (those of
// the variance layer) and half a per cent; so do pixels: their chi-squared per pixel is at most one
// (less where samples are stratified). A pixel that few particles met underestimates its variance:
// two per cent of the brightest are let pass.
void expectSame(Renderable& r, PathSettings settings, int pathSpp, int lightSpp) {
  const auto layers = {"direct", "indirect", "variance"};
  settings.spp = pathSpp;
  const Film path = r.path(settings, layers);
  settings.spp = lightSpp;
  const Film light = r.light(settings, layers);
  double chi = 0, pixels = 0;
  float peak = 0;
  for (size_t i = 0; i < path.pixelCount(); ++i) peak = std::max(peak, path.rgb(i).y);
  const auto compare = [&](const char* layer, auto&& in) {
    Vec3d a, b, variance;
    for (size_t i = 0; i < path.pixelCount(); ++i) {
      if (!in(static_cast<int>(i) % path.width, static_cast<int>(i) / path.width)) continue;
      for (int c = 0; c < 3; ++c) {
        a[c] += double{light.rgb(i, layer)[c]}, b[c] += double{path.rgb(i, layer)[c]};
        variance[c] += double{light.rgb(i, "variance")[c]} + double{path.rgb(i, "variance")[c]};
      }
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(a[c], b[c], 4 * std::sqrt(variance[c]) + 0.005 * b[c])
          << '"' << layer << "\" channel " << c;
    }
  };
  for (const char* layer : {"direct", "indirect", ""})
    compare(layer, [](int, int) { return true; });
  compare("", [&](int x, int) { return 2 * x < path.width; });
  compare("", [&](int x, int) { return 2 * x >= path.width; });
  compare("", [&](int, int y) { return 2 * y < path.height; });
  compare("", [&](int, int y) { return 2 * y >= path.height; });
  for (size_t i = 0; i < path.pixelCount(); ++i) {
    const double variance = double{light.rgb(i, "variance").y} + double{path.rgb(i, "variance").y};
    const double difference = double{light.rgb(i).y} - double{path.rgb(i).y};
    if (variance <= 0) continue;
    chi += difference * difference / (variance + sqr(0.02f * peak));
    ++pixels;
  }
  EXPECT_LT(chi, 1.3 * pixels + 10);
}

class LightTracer : public testing::TestWithParam<Lighting> {};

TEST_P(LightTracer, EqualsThePathTracer) {
  Scene scene = test::stageScene();
  addLighting(scene, GetParam());
  Renderable r(scene);
  PathSettings settings;
  settings.maxDepth = 4;
  expectSame(r, settings, 200, 500);
}
INSTANTIATE_TEST_SUITE_P(All, LightTracer,
                         testing::Values(Lighting::quad, Lighting::texturedQuad, Lighting::sphere,
                                         Lighting::meshSphere, Lighting::manyTriangles,
                                         Lighting::point, Lighting::spot, Lighting::projector,
                                         Lighting::directional, Lighting::constant,
                                         Lighting::environment, Lighting::goniometric,
                                         Lighting::sun, Lighting::sunAndSky, Lighting::mixed),
                         [](const auto& i) { return std::string(test::nameOf(i.param)); });

TEST(LightTracing, EqualsThePathTracerInAGlossyRoom) {
  Scene scene = test::boxScene();
  Material metal;
  metal.type = MaterialType::roughConductor;
  metal.alphaU = metal.alphaV = 0.25f;
  scene.instances[test::backWall].material = test::addMaterial(scene, metal);
  Material coat;
  coat.type = MaterialType::roughPlastic;
  coat.alphaU = coat.alphaV = 0.06f;
  scene.instances[test::floorWall].material = test::addMaterial(scene, coat);
  Renderable r(scene);
  PathSettings settings;
  settings.maxDepth = 6;
  expectSame(r, settings, 200, 500);
}

// Every camera model and filter puts light where its rays would look for it.
TEST(LightTracing, EqualsThePathTracerForEveryCamera) {
  for (int variant = 0; variant < 5; ++variant) {
    Scene scene = test::stageScene();
    addLighting(scene, Lighting::spot);
    Camera& camera = scene.cameras[0];
    if (variant == 0) camera.apertureRadius = 0.2f, camera.focusDistance = 5;
    if (variant == 1) {
      camera.type = CameraType::orthographic;
      camera.toWorld = Transform(*lookAt({0, 2, -5}, {0, 0.7, 0}, {0, 1, 0}) * scaling({2, 2, 1}));
    }
    if (variant == 2) camera.principalPointOffset = {0.1f, -0.2f};
    if (variant == 3) camera.filter = PixelFilter::gaussian;
    if (variant == 4) {
      camera.filter = PixelFilter::mitchell;
      camera.cropX0 = 4, camera.cropY0 = 3, camera.cropX1 = 20, camera.cropY1 = 14;
    }
    Renderable r(scene);
    PathSettings settings;
    settings.maxDepth = 2;
    SCOPED_TRACE(variant);
    expectSame(r, settings, 100, 300);
  }
}

// A transform that scales unevenly, shears and mirrors means the same to all: it turns and mirrors.
TEST(LightTracing, EqualsThePathTracerForLightsOutOfShape) {
  for (const Lighting lighting : {Lighting::spot, Lighting::projector, Lighting::goniometric}) {
    Scene scene = test::stageScene();
    addLighting(scene, lighting);
    Transform& toWorld = scene.emitters.back().toWorld;
    const Mat4 bent{{{{-1, 0.4, 0, 0}, {0, 2, 0, 0}, {0, 0, 3, 0}, {0, 0, 0, 1}}}};
    const Mat4 straight = toWorld.to * scaling({-1, 1, 1});
    toWorld = Transform(toWorld.to * bent);
    Renderable r(scene);
    PathSettings settings;
    settings.maxDepth = 2;
    SCOPED_TRACE(nameOf(lighting));
    expectSame(r, settings, 100, 300);
    const Vec3d mean = test::meanOf(r.path(settings));
    scene.emitters.back().toWorld = Transform(straight);
    Renderable rigid(scene);
    const Vec3d expected = test::meanOf(rigid.path(settings));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], expected[c], 1e-3 * expected[c]);
  }
}

TEST(LightTracing, FindsCausticsBehindGlass) {
  Scene scene = test::boxScene();
  test::addPane(scene);
  // The pane itself, which particles cannot be seen through, stays out of the picture.
  scene.cameras[0].toWorld = Transform(*lookAt({0, 0, -0.95}, {0, -0.9, 0.5}, {0, 1, 0}));
  scene.cameras[0].fovX = 0.8f;
  Renderable r(scene);
  PathSettings settings;
  settings.maxDepth = 5;
  expectSame(r, settings, 600, 300);
}

TEST(LightTracing, HonoursDepthComponentPixelsAndHiding) {
  Scene scene = test::boxScene();
  scene.cameras[0].toWorld = Transform(*lookAt({0, 0, -0.95}, {0, 0.3, 1}, {0, 1, 0}));
  Renderable r(scene);
  PathSettings settings;
  settings.spp = 64;
  settings.maxDepth = 1;
  const Film emission = r.light(settings, {"direct"});
  EXPECT_EQ(emission.layers.at("").values, r.path(settings).layers.at("").values);
  settings.hideEmitters = true;
  EXPECT_EQ(test::meanOf(r.light(settings)), Vec3d{});
  settings.hideEmitters = false;
  settings.maxDepth = 5;
  settings.component = Component::indirect;
  const Film indirect = r.light(settings, {"direct", "indirect"});
  EXPECT_EQ(test::meanOf(indirect, "direct"), Vec3d{});
  EXPECT_GT(test::meanOf(indirect, "indirect").x, 0);
  settings.pixels.pixels = {7, 100};
  const Film some = r.light(settings);
  for (size_t i = 0; i < some.pixelCount(); ++i) {
    if (i != 7 && i != 100) {
      EXPECT_EQ(some.rgb(i), Rgb{});
    } else {
      EXPECT_EQ(some.rgb(i), indirect.rgb(i));
    }
  }
}

}  // namespace
}  // namespace lobelia
