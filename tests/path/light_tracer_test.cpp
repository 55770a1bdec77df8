// Light tracing and path tracing are two estimates of the same picture.
#include <gtest/gtest.h>

#include "support/test_scenes.h"

namespace lobelia {
namespace {

using test::Lighting;
using test::Renderable;

void expectSame(Renderable& r, PathSettings settings, int pathSpp, int lightSpp, double tolerance) {
  const auto layers = {"direct", "indirect"};
  settings.spp = pathSpp;
  const Film path = r.path(settings, layers);
  settings.spp = lightSpp;
  const Film light = r.light(settings, layers);
  for (const char* layer : {"direct", "indirect", ""}) {
    const Vec3d a = test::meanOf(light, layer), b = test::meanOf(path, layer);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(a[c], b[c], tolerance * b[c] + 1e-9) << '"' << layer << "\" channel " << c;
    }
  }
  // Not only on the whole: left and right half, upper and lower.
  for (int half = 0; half < 4; ++half) {
    double a = 0, b = 0;
    for (int y = 0; y < path.height; ++y) {
      for (int x = 0; x < path.width; ++x) {
        const bool in = half == 0   ? 2 * x < path.width
                        : half == 1 ? 2 * x >= path.width
                        : half == 2 ? 2 * y < path.height
                                    : 2 * y >= path.height;
        if (!in) continue;
        const size_t i = static_cast<size_t>(y * path.width + x);
        a += double{light.rgb(i).y}, b += double{path.rgb(i).y};
      }
    }
    EXPECT_NEAR(a, b, 2 * tolerance * b) << "half " << half;
  }
}

class LightTracer : public testing::TestWithParam<Lighting> {};

TEST_P(LightTracer, EqualsThePathTracer) {
  Scene scene = test::stageScene();
  addLighting(scene, GetParam());
  Renderable r(scene);
  PathSettings settings;
  settings.maxDepth = 4;
  expectSame(r, settings, 200, 500, 0.03);
}
INSTANTIATE_TEST_SUITE_P(All, LightTracer,
                         testing::Values(Lighting::quad, Lighting::texturedQuad, Lighting::sphere,
                                         Lighting::meshSphere, Lighting::manyTriangles,
                                         Lighting::point, Lighting::spot, Lighting::projector,
                                         Lighting::directional, Lighting::constant,
                                         Lighting::environment, Lighting::mixed),
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
  expectSame(r, settings, 200, 500, 0.03);
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
    const auto layers = {"direct"};
    settings.spp = 200;
    const Film path = r.path(settings, layers);
    settings.spp = 1500;
    const Film light = r.light(settings, layers);
    // Pixel by pixel, against the brightest.
    float peak = 0, worst = 0;
    double sum = 0, sumLight = 0;
    for (size_t i = 0; i < path.pixelCount(); ++i) {
      peak = std::max(peak, path.rgb(i).y);
      worst = std::max(worst, std::abs(path.rgb(i).y - light.rgb(i).y));
      sum += double{path.rgb(i).y}, sumLight += double{light.rgb(i).y};
    }
    EXPECT_LT(worst, 0.15f * peak);
    EXPECT_NEAR(sumLight, sum, 0.02 * sum);
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
  expectSame(r, settings, 2000, 500, 0.03);
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
