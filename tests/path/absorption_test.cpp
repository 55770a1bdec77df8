// Coloured glass: every walk multiplies by exp(-absorption length) inside.
#include <gtest/gtest.h>

#include "lobelia/path/receivers.h"
#include "support/test_scenes.h"

namespace lobelia {
namespace {

Material colouredGlass() {
  Material glass;
  glass.type = MaterialType::dielectric;
  glass.ior = 1.0001f;  // no refraction to speak of
  glass.absorption = Rgb(0.1f, 0.5f, 1);
  return glass;
}

// The middle of a ball of radius 1 in a white environment.
Scene ballInFurnace() {
  Scene scene;
  test::addSphere(scene, {}, 1, test::addMaterial(scene, colouredGlass()), {}, 48);
  Emitter white;
  white.type = EmitterType::constant;
  white.radiance = Rgb(1.f);
  test::addEmitter(scene, white);
  Camera camera;
  camera.toWorld = Transform(*lookAt({0, 0, -4}, {0, 0, 0}, {0, 1, 0}));
  camera.fovX = 0.02f;
  camera.width = camera.height = 8;
  scene.cameras.push_back(camera);
  return scene;
}

void expectTwoUnitsOfGlass(Vec3d mean) {
  EXPECT_NEAR(mean.x, std::exp(-0.2), 0.005);
  EXPECT_NEAR(mean.y, std::exp(-1.0), 0.005);
  EXPECT_NEAR(mean.z, std::exp(-2.0), 0.005);
}

TEST(Absorption, OfAPathFromTheEye) {
  test::Renderable r(ballInFurnace());
  PathSettings settings;
  settings.spp = 4;
  expectTwoUnitsOfGlass(test::meanOf(r.path(settings)));
}

TEST(Absorption, OfAnEyeWalk) {
  test::Renderable r(ballInFurnace());
  Film film = test::filmFor(r.scene.cameras[0], {"direct", "indirect", "specular"});
  film.addLayer("albedo");
  film.addLayer("normal");
  film.addLayer("depth", 1);
  traceReceivers(r.tracer, r.emitters, r.scene.cameras[0], {}, 0, 8, film, r.context);
  expectTwoUnitsOfGlass(test::meanOf(film, "direct"));
}

// A floor lit through the ball, as paths from the eye and from the light see it.
TEST(Absorption, BothWays) {
  Scene scene;
  const MaterialHandle grey = test::addMaterial(scene, test::diffuseMaterial(Rgb(0.8f)));
  test::addQuad(scene, {-3, -3, 0}, {6, 0, 0}, {0, 6, 0}, grey);
  test::addSphere(scene, {0, 0, 1.5f}, 1, test::addMaterial(scene, colouredGlass()), {}, 48);
  const EmitterHandle light = test::addAreaEmitter(scene, Rgb(20.f));
  test::addSphere(scene, {0, 0, 4}, 0.8f, grey, light, 48);
  Camera camera;
  camera.toWorld = Transform(*lookAt({2, 0, 0.4f}, {0.05f, 0, 0}, {0, 0, 1}));
  camera.fovX = 0.2f;
  camera.width = camera.height = 8;
  scene.cameras.push_back(camera);
  test::Renderable r(scene);
  PathSettings settings;
  settings.spp = 4000;
  settings.maxDepth = 6;
  const Vec3d fromEye = test::meanOf(r.path(settings));
  settings.spp = 20000;
  const Vec3d fromLight = test::meanOf(r.light(settings));
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(fromLight[c] / fromEye[c], 1, 0.06) << "channel " << c;
  // Chords of 1.5 to 2.
  EXPECT_GT(fromEye.z / fromEye.x, std::exp(-0.9 * 2));
  EXPECT_LT(fromEye.z / fromEye.x, std::exp(-0.9 * 1.5));
}

}  // namespace
}  // namespace lobelia
