// The computed sky against published figures.
#include "lobelia/io/sky.h"

#include <gtest/gtest.h>

#include "io/mitsuba_scene.h"
#include "lobelia/io/atmosphere.h"
#include "lobelia/io/sun_position.h"

namespace lobelia {
namespace {

constexpr double kDegrees = 3.14159265358979323846 / 180;

double lux(Rgb c) { return double{luminance(c)} * io::kLuminousEfficacy; }

io::Atmosphere atmosphere(double turbidity, double elevation, Rgb albedo = Rgb(0.2f)) {
  io::AtmosphereSettings settings;
  settings.turbidity = turbidity;
  settings.sunElevation = elevation * kDegrees;
  settings.albedo = albedo;
  return io::Atmosphere(settings);
}
Rgb look(const io::Atmosphere& a, double zenithAngle, double azimuth) {
  const double azimuths[] = {azimuth * kDegrees};
  return a.radiance(std::cos(zenithAngle * kDegrees), azimuths)[0];
}

// 133.1 klx (solar illuminance constant by the same CIE function: Darula, Kittler and Gueymard
// 2005: 133 to 134 klx). Without air nothing is lost, so the sun far above a very thin atmosphere
// is not tested but the spectrum itself.
TEST(Atmosphere, SolarSpectrumHasTheSolarIlluminanceConstant) {
  double sum = 0;
  const auto& sun = io::Atmosphere::solarSpectrum();
  for (double l = 360; l <= 780; ++l) {
    const double x = (l - 360) / 20;
    const size_t i = std::min(static_cast<size_t>(x), sun.size() - 2);
    const double value = sun[i] + (sun[i + 1] - sun[i]) * (x - static_cast<double>(i));
    // V(lambda) as the Gaussian fit of Wyman, Sloan and Shirley 2013 (good to 1 %).
    const auto lobe = [&](double a, double m, double below, double above) {
      const double t = (l - m) / (l < m ? below : above);
      return a * std::exp(-0.5 * t * t);
    };
    sum += value * (lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1));
  }
  EXPECT_NEAR(683 * sum, 133.6e3, 3e3);
}

// Illuminance of a clear day (Gillette and Kusuda 1982; IESNA RP-21): on a plane facing the sun
// 127.5 exp(-0.21 m) klx, m the air mass; on the ground by the sky 0.8 + 15.5 sqrt(sin h) klx.
TEST(Atmosphere, ClearDayHasThePublishedIlluminance) {
  for (const double h : {20., 40., 60., 80.}) {
    const io::Atmosphere a = atmosphere(2, h);
    const double sine = std::sin(h * kDegrees);
    const double sun = 127.5e3 * std::exp(-0.21 / sine), sky = 800 + 15500 * std::sqrt(sine);
    EXPECT_NEAR(lux(a.sunIrradiance()), sun, 0.1 * sun) << h;
    EXPECT_NEAR(lux(a.skyIrradiance()), sky, 0.35 * sky) << h;
    EXPECT_NEAR(lux(a.groundIrradiance()), lux(a.sunIrradiance()) * sine + lux(a.skyIrradiance()),
                1);
  }
}

// The CIE's standard clear sky (Kittler 1967; CIE S 011): luminance over the zenith's is
// (0.91 + 10 exp(-3 g) + 0.45 cos^2 g)(1 - exp(-0.32 / cos z)) /
// ((0.91 + 10 exp(-3 z0) + 0.45 cos^2 z0)(1 - exp(-0.32))).
TEST(Atmosphere, LuminanceIsSpreadAsInTheStandardClearSky) {
  const double z0 = 50;
  const io::Atmosphere a = atmosphere(2.5, 90 - z0);
  const double zenith = lux(look(a, 0, 0));
  const auto gradation = [](double z) { return 1 - std::exp(-0.32 / std::cos(z * kDegrees)); };
  const auto indicatrix = [](double g) {
    const double r = g * kDegrees;
    return 0.91 + 10 * std::exp(-3 * r) + 0.45 * std::cos(r) * std::cos(r);
  };
  for (const double z : {20., 40., 60., 75.}) {
    for (const double azimuth : {60., 90., 135., 180.}) {
      const double g = std::acos(std::cos(z0 * kDegrees) * std::cos(z * kDegrees) +
                                 std::sin(z0 * kDegrees) * std::sin(z * kDegrees) *
                                     std::cos(azimuth * kDegrees)) /
                       kDegrees;
      const double expected = gradation(z) * indicatrix(g) / (gradation(0) * indicatrix(z0));
      const double ratio = lux(look(a, z, azimuth)) / zenith;
      EXPECT_GT(ratio, expected / 1.6) << z << ' ' << azimuth;
      EXPECT_LT(ratio, expected * 1.6) << z << ' ' << azimuth;
    }
  }
}

// Twilight (Seidelmann 1992, Explanatory Supplement to the Astronomical Almanac, section 9.3):
// about 600 lx on the ground when the sun's centre is on the horizon, 3.4 lx at -6 degrees.
TEST(Atmosphere, TwilightFadesAsObserved) {
  const double sunset = lux(atmosphere(2, 0).groundIrradiance());
  EXPECT_GT(sunset, 300);
  EXPECT_LT(sunset, 1500);
  const double civil = lux(atmosphere(2, -6).groundIrradiance());
  EXPECT_GT(civil, 1);
  EXPECT_LT(civil, 12);
}

TEST(Atmosphere, ColoursAreThoseOfADay) {
  const io::Atmosphere noon = atmosphere(2, 60);
  const Rgb zenith = look(noon, 10, 180), sun = noon.sunIrradiance();
  EXPECT_GT(zenith.z, 1.5f * zenith.x);  // blue
  EXPECT_GT(zenith.z, zenith.y);
  EXPECT_GT(sun.x, sun.z);  // a little yellow
  EXPECT_LT(sun.x, 2 * sun.z);
  const io::Atmosphere evening = atmosphere(2, 2);
  EXPECT_GT(evening.sunIrradiance().x, 2 * evening.sunIrradiance().y);  // red
  EXPECT_GT(evening.sunIrradiance().y, 2 * evening.sunIrradiance().z);
  // Paler with haze.
  const Rgb hazy = look(atmosphere(8, 60), 10, 180);
  EXPECT_LT(hazy.z / hazy.x, 0.8f * zenith.z / zenith.x);
}

TEST(Atmosphere, HazeDimsTheSunAndLightsTheSky) {
  double sun = 1e30, sky = 0;
  for (double t = 1; t <= 10; t += 1.5) {
    const io::Atmosphere a = atmosphere(t, 45);
    EXPECT_LT(lux(a.sunIrradiance()), sun) << t;
    EXPECT_GT(lux(a.skyIrradiance()), sky) << t;
    sun = lux(a.sunIrradiance()), sky = lux(a.skyIrradiance());
  }
}

// A bright ground lights the sky.
TEST(Atmosphere, GroundLightsTheSky) {
  EXPECT_GT(lux(atmosphere(3, 40, Rgb(0.8f)).skyIrradiance()),
            1.03 * lux(atmosphere(3, 40, Rgb(0.f)).skyIrradiance()));
  EXPECT_EQ(atmosphere(3, 40, Rgb(0.f)).groundRadiance(), Rgb(0.f));
  const io::Atmosphere a = atmosphere(3, 40, Rgb(0.5f));
  EXPECT_NEAR(lux(a.groundRadiance()) * M_PI, 0.5 * lux(a.groundIrradiance()), 1);
}

// Irradiance by the image itself.
TEST(Atmosphere, RadianceAddsUpToTheIrradiance) {
  for (const double h : {8., 50.}) {
    const io::Atmosphere a = atmosphere(3, h);
    constexpr int kRings = 60, kSectors = 90;
    std::vector<double> azimuths;
    for (int i = 0; i < kSectors; ++i) azimuths.push_back((i + 0.5) / kSectors * M_PI);
    double sum = 0;
    for (int ring = 0; ring < kRings; ++ring) {
      const double sine2 = (ring + 0.5) / kRings;  // equal projected solid angles
      for (const Rgb& c : a.radiance(std::sqrt(1 - sine2), azimuths))
        sum += lux(c) * M_PI / kRings / kSectors;
    }
    EXPECT_NEAR(sum, lux(a.skyIrradiance()), 0.05 * sum) << h;
  }
}

TEST(Atmosphere, ChangesContinuouslyAndIsFiniteAtNight) {
  double before = -1;
  for (double h = 3; h > -4; h -= 0.35) {
    const double now = lux(atmosphere(2, h).groundIrradiance());
    if (before > 0) {
      EXPECT_NEAR(std::log(now / before), 0, 0.5) << h;
      EXPECT_LT(now, before);
    }
    before = now;
  }
  for (const double h : {-10., -30., -90.}) {
    for (const double t : {1., 10.}) {
      const io::Atmosphere a = atmosphere(t, h);
      EXPECT_TRUE(isFinite(a.skyIrradiance()));
      EXPECT_GE(minComponent(a.skyIrradiance()), 0);
      EXPECT_EQ(a.sunIrradiance(), Rgb(0.f));
      for (const double z : {0., 45., 90.}) EXPECT_TRUE(isFinite(look(a, z, 30)));
    }
  }
}

// Reference positions: NREL's solar position algorithm (Reda and Andreas 2004, table A5.1: 17
// October 2003, 12:30:30 at UTC-7, 39.742476 N 105.1786 W: zenith 50.11162, azimuth 194.34024
// degrees with refraction of 0.016), and the equinox on the equator.
TEST(SunPosition, AgreesWithReferences) {
  io::PlaceAndTime at{2003, 10, 17, 12, 30, 30, 39.742476, -105.1786, -7};
  const Vec3d d = io::sunDirection(at);
  EXPECT_NEAR(std::acos(d.y) / kDegrees, 50.128, 0.02);
  EXPECT_NEAR(std::atan2(d.x, -d.z) / kDegrees + 360, 194.340, 0.03);
  at = {2024, 3, 20, 12, 7, 0, 0, 0, 0};
  EXPECT_GT(io::sunDirection(at).y, 0.9999);
  at.hour = 6;
  EXPECT_GT(io::sunDirection(at).x, 0.99);  // rises in the east
}

float at(const Image& image, int x, int y, int c) { return image.at(x, y, c); }

TEST(Sky, ImageHoldsTheSunsSurroundingsWhereItStands) {
  io::SkySettings settings;
  settings.sun = {1, 1, 0.5};
  settings.width = 64;
  const io::Sky sky = io::makeSky(settings, {});
  EXPECT_NEAR(length(sky.sun), 1, 1e-6f);
  int bestX = 0, bestY = 0;
  float best = 0;
  for (int y = 0; y < sky.image.height; ++y) {
    for (int x = 0; x < sky.image.width; ++x) {
      const float v = at(sky.image, x, y, 1);
      ASSERT_TRUE(std::isfinite(v));
      if (y > sky.image.height / 2) {
        EXPECT_EQ(v, 0);
      }
      if (v > best) best = v, bestX = x, bestY = y;
    }
  }
  const float theta = kPi * static_cast<float>(bestY) / static_cast<float>(sky.image.height - 1);
  const float phi = kTwoPi * (static_cast<float>(bestX) + 0.5f) / 64;
  const Vec3f d{std::sin(phi) * std::sin(theta), std::cos(theta), -std::cos(phi) * std::sin(theta)};
  EXPECT_GT(dot(d, sky.sun), 0.98f);

  settings.below = io::BelowHorizon::extended;
  const Image extended = io::makeSky(settings, {}).image;
  EXPECT_EQ(at(extended, 5, 20, 2), at(extended, 5, 32, 2));
  settings.below = io::BelowHorizon::ground;
  EXPECT_GT(at(io::makeSky(settings, {}).image, 5, 30, 2), 0);
}

TEST(Sky, RefusesWhatMakesNoSense) {
  const auto refused = [](auto change) {
    io::SkySettings settings;
    change(settings);
    return messageOf<InputError>([&] { io::makeSky(settings, {"a.xml", 3, 0}); });
  };
  EXPECT_TRUE(contains(refused([](auto& s) { s.turbidity = 0.5; }), "between 1"));
  EXPECT_TRUE(contains(refused([](auto& s) { s.turbidity = std::nan(""); }), "turbidity"));
  EXPECT_TRUE(contains(refused([](auto& s) { s.sun = {}; }), "direction"));
  EXPECT_TRUE(contains(refused([](auto& s) { s.albedo = Rgb(2.f); }), "albedo"));
  EXPECT_TRUE(contains(refused([](auto& s) { s.stretch = 3; }), "stretch"));
  EXPECT_TRUE(contains(refused([](auto& s) { s.width = 1 << 30; }), "resolution"));
}

TEST(Sky, OptionReplacesEnvironmentAndSunInPlace) {
  Scene scene;
  Camera camera;
  camera.toWorld = Transform(*lookAt({5, 0, 1}, {0, 0, 1}, {0, 0.1, 1}));  // z up
  scene.cameras.push_back(camera);
  scene.emitters.resize(3);
  scene.emitters[1].type = EmitterType::constant;
  io::ReadSettings settings;
  settings.sky = "3,0,1,1";
  io::applyEnvironment(scene, settings);
  ASSERT_EQ(scene.emitters.size(), 4u);
  EXPECT_EQ(scene.emitters[1].type, EmitterType::environment);
  EXPECT_EQ(scene.emitters[3].type, EmitterType::sun);
  EXPECT_GT(minComponent(scene.emitters[3].radiance.value), 0);
  const Vec3f down = scene.emitters[3].direction;
  EXPECT_NEAR(down.y, -std::sqrt(0.5f), 1e-5f);
  EXPECT_NEAR(down.z, -std::sqrt(0.5f), 1e-5f);
  EXPECT_NEAR(scene.emitters[1].toWorld.vector({0, 1, 0}).z, 1, 1e-6f);
  io::applyEnvironment(scene, settings);  // once more: nothing is doubled
  EXPECT_EQ(scene.emitters.size(), 4u);
  for (const char* wrong : {"3", "3,0,1", "3,0,1,1,2", "3;0,1,1", "x,0,1,1", "nan,0,1,1"}) {
    settings.sky = wrong;
    EXPECT_TRUE(contains(messageOf<UsageError>([&] { io::applyEnvironment(scene, settings); }),
                         "TURBIDITY"))
        << wrong;
  }
}

}  // namespace
}  // namespace lobelia
