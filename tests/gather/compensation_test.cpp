// Clamped lights plus compensation against the path tracer, for materials and surfaces of all
// kinds: means of the indirect light over independent runs.
#include "lobelia/gather/compensation.h"

#include <gtest/gtest.h>

#include "gather/path_trial.h"

namespace lobelia {
namespace {

using namespace test;

struct Setting {
  bool glossy = true;
  float clamp = 0.3f;
  int maxDepth = -1;
};

class Trial : public PathTrial {
 public:
  using PathTrial::PathTrial;

  Mean lights(const Setting& setting, bool compensated) {
    return mean([&] { return lightsOnce(setting, compensated); });
  }

 private:
  double lightsOnce(const Setting& setting, bool compensated) {
    LightSettings lightSettings;
    lightSettings.count = 1000;
    lightSettings.kind = setting.glossy ? LightKind::glossy : LightKind::diffuse;
    lightSettings.maxDepth = setting.maxDepth;
    const VirtualLights lights = makeLights(tracer_, emitters_, lightSettings, context_);
    Film film = test::filmFor(camera(), {"direct", "indirect"});
    EyeSettings eye;
    eye.sampleCount = 8;
    eye.maxDepth = setting.maxDepth;
    GatherSettings gather;
    gather.clamp = setting.clamp;
    gather.maxDepth = setting.maxDepth;
    CompensationSettings compensation;
    compensation.rays.width = camera().width;
    compensation.clamp = setting.clamp;
    compensation.glossy = setting.glossy;
    compensation.maxDepth = setting.maxDepth;
    const auto add = [&](const Receivers& receivers, int sample, std::vector<Rgb>* radiance) {
      compensation.rays.sample = sample;
      if (compensated) compensate(tracer_, emitters_, receivers, compensation, *radiance, context_);
    };
    const double light = gathered(eye, lights, gather, &film, add);
    return sum(film) + light;
  }
};

void expectUnbiased(Scene scene, const Setting& setting, const char* name) {
  SCOPED_TRACE(name);
  Trial trial(std::move(scene));
  const Mean truth = trial.path(setting.maxDepth), without = trial.lights(setting, false),
             with = trial.lights(setting, true);
  const double error = std::hypot(truth.error, with.error);
  testing::Test::RecordProperty(name, std::to_string(without.value / truth.value) + " " +
                                          std::to_string(with.value / truth.value) + " +- " +
                                          std::to_string(error / truth.value));
  EXPECT_LT(error, 0.02 * truth.value);
  EXPECT_NEAR(with.value, truth.value, 4 * error);
  EXPECT_GT(std::abs(without.value - truth.value), 6 * std::hypot(truth.error, without.error));
}

TEST(Compensation, DiffuseSurfacesWithShadingNormals) {
  const Material matt = test::diffuseMaterial(Rgb(0.7f, 0.6f, 0.5f));
  expectUnbiased(roomWith(matt, matt), {false, 0.1f, -1}, "vpl");
  expectUnbiased(roomWith(matt, matt), {false, 0.1f, 4}, "vpl, four edges");
}
TEST(Compensation, Gloss) {
  const Scene scene =
      roomWith(material(MaterialType::roughPlastic, 0.2f), material(MaterialType::phong, 30));
  expectUnbiased(scene, {true, 0.1f, -1}, "glossy");
  expectUnbiased(scene, {false, 0.1f, 5}, "vpl, five edges");
}
// One sharp lobe and a rough base; a mirror.
TEST(Compensation, BesideSharpLobes) {
  const Scene scene = roomWith(material(MaterialType::roughPlastic, 0.03f),
                               material(MaterialType::roughPlastic, 0.05f));
  expectUnbiased(scene, {true, 0.05f, -1}, "glossy");
}
TEST(Compensation, Transmission) {
  Material glass = material(MaterialType::roughDielectric, 0.3f);
  glass.absorption = Rgb(0.5f, 1.f, 2.f);
  Material leaf = material(MaterialType::diffuseTransmitter, 0);
  leaf.transmittance = Rgb(0.4f);
  expectUnbiased(roomWith(glass, leaf), {true, 0.1f, -1}, "glossy");
  expectUnbiased(roomWith(leaf, glass), {false, 0.1f, -1}, "vpl");
}
TEST(Compensation, BumpsAndSheen) {
  Scene scene = roomWith(material(MaterialType::principled, 0), test::diffuseMaterial(Rgb(0.5f)));
  Material& ball = scene.materials[scene.instances.back().material.index];
  ball.sheen = 1.f, ball.roughness = 0.4f;
  Material bump;
  bump.type = MaterialType::bump;
  bump.a = scene.instances[test::floorWall].material;
  bump.map = test::addRandomTexture(scene, 16, 0.f);
  bump.scale = 0.05f;
  scene.instances[test::backWall].material = test::addMaterial(scene, bump);
  expectUnbiased(scene, {true, 0.1f, -1}, "glossy");
}

}  // namespace
}  // namespace lobelia
