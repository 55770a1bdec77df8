// Light of near surfaces by the receivers' own samples, with that of lights further away, against
// the path tracer: means of the picture over independent runs.
#include <limits>

#include "gather/path_trial.h"
#include "lobelia/lights/light_spacing.h"

namespace lobelia {
namespace {

using namespace test;

struct Setting {
  LightKind kind = LightKind::glossy;
  float nearLights = 0;  // infinite: no lights at all
  int maxDepth = -1;
  bool direct = false;  // emitters as lights, too
};

class Trial : public PathTrial {
 public:
  using PathTrial::PathTrial;
  Mean lights(const Setting& setting, const char* layer = "indirect") {
    return mean([&] { return once(setting, layer); });
  }

 private:
  double once(const Setting& setting, const char* layer) {
    VirtualLights lights;
    if (setting.nearLights < std::numeric_limits<float>::infinity()) {
      LightSettings lightSettings;
      lightSettings.count = 1000;
      lightSettings.kind = setting.kind;
      lightSettings.maxDepth = setting.maxDepth;
      lightSettings.directAsLights = setting.direct;
      lights = makeLights(tracer_, emitters_, lightSettings, context_);
    }
    const LightSpacing spacing{{&lights}};
    Film film = filmFor(camera(), {"direct", "indirect"});
    EyeSettings eye;
    eye.sampleCount = 8;
    eye.maxDepth = setting.maxDepth;
    if (setting.direct) eye.directSamples = 0;
    if (setting.nearLights > 0)
      eye.nearDistance = [&](Vec3f p) { return spacing.distance(p, setting.nearLights); };
    GatherSettings gather;
    gather.maxDepth = setting.maxDepth;
    gather.direct = setting.direct;
    const double gathered =
        this->gathered(eye, lights, gather, &film, [](const Receivers&, int, std::vector<Rgb>*) {});
    const double own = setting.direct ? sum(film, "direct") + sum(film) : sum(film, layer);
    return own + gathered;
  }
};

// within: of the truth, the standard error.
void expectMean(const Mean& value, const Mean& truth, double within) {
  const double error = std::hypot(value.error, truth.error);
  EXPECT_LT(error, within * truth.value);
  EXPECT_NEAR(value.value, truth.value, 4 * error);
}

Scene glossyRoom() {
  return roomWith(material(MaterialType::roughPlastic, 0.2f), material(MaterialType::phong, 30));
}

TEST(NearReceivers, FindAllLightWithoutLights) {
  constexpr float kAll = std::numeric_limits<float>::infinity();
  Trial trial(glossyRoom());
  expectMean(trial.lights({LightKind::glossy, kAll}), trial.path(-1), 0.02);
  expectMean(trial.lights({LightKind::glossy, kAll, 4}), trial.path(4), 0.02);
  // Direct light stays where it is.
  expectMean(trial.lights({LightKind::glossy, kAll}, "direct"), trial.path(-1, "direct"), 0.02);
}

// The light that is added up is "indirect" and, with lights on emitters, "direct", too.
TEST(NearReceivers, LeaveToTheLightsWhatIsFar) {
  Scene diffuse = roomWith(diffuseMaterial(Rgb(0.7f, 0.6f, 0.5f)), diffuseMaterial(Rgb(0.6f)));
  Trial trial(diffuse);
  const Mean truth = trial.path(-1), four = trial.path(4), direct = trial.path(-1, "direct");
  for (const float count : {4.f, 100.f}) {
    SCOPED_TRACE(count);
    expectMean(trial.lights({LightKind::diffuse, count}), truth, 0.02);
    expectMean(trial.lights({LightKind::diffuse, count, 4}), four, 0.02);
    expectMean(trial.lights({LightKind::diffuse, count, -1, true}),
               {truth.value + direct.value, std::hypot(truth.error, direct.error)}, 0.02);
  }
}

TEST(NearReceivers, ServeGlossToo) {
  Trial trial(glossyRoom());
  const Mean truth = trial.path(-1);
  expectMean(trial.lights({LightKind::glossy, 60}), truth, 0.02);
}

// Spheres are as wide as some of their neighbours are far: their discs reach over what is near and
// over what is not, and count by the places on them.
TEST(NearReceivers, TakeOverFromSpheresPlaceByPlace) {
  Trial trial(boxScene());
  const Mean truth = trial.path(-1);
  const Mean without = trial.lights({LightKind::spherical, 0});
  EXPECT_NEAR(without.value, truth.value, 0.03 * truth.value);
  for (const float count : {4.f, 100.f})
    EXPECT_NEAR(trial.lights({LightKind::spherical, count}).value, without.value,
                0.01 * truth.value)
        << count;
}

}  // namespace
}  // namespace lobelia
