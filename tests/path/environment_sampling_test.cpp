#include "lobelia/path/environment_sampling.h"

#include <gtest/gtest.h>

#include "base/chi_squared.h"
#include "lobelia/base/random.h"

namespace lobelia {
namespace {

Scene environmentScene(int width, int height, const Mat4& toWorld, uint64_t seed, bool sparse) {
  Scene scene;
  Image image;
  image.width = width, image.height = height, image.channels = 3;
  Rng random(seed);
  for (int i = 0; i < width * height * 3; ++i) {
    const float v = random.next1D();
    image.pixels.push_back(sparse ? 0.f : v * v * v * 4);
  }
  if (sparse) image.pixels[static_cast<size_t>(3 * (width * (height / 2) + width - 1))] = 9;
  scene.images.push_back(std::move(image));
  Emitter emitter;
  emitter.type = EmitterType::environment;
  emitter.image = {0};
  emitter.scale = 2;
  emitter.toWorld = Transform(toWorld);
  scene.emitters.push_back(emitter);
  return scene;
}

// Integral over the sphere of f(direction), midpoint rule.
template <class F>
double integrate(int n, const F& f) {
  double sum = 0;
  for (int y = 0; y < n; ++y) {
    const double z = -1 + (y + 0.5) * 2 / n, r = std::sqrt(1 - z * z);
    for (int x = 0; x < 2 * n; ++x) {
      const double phi = (x + 0.5) * M_PI / n;
      sum += f(Vec3f{static_cast<float>(r * std::cos(phi)), static_cast<float>(z),
                     static_cast<float>(r * std::sin(phi))});
    }
  }
  return sum * 4 * M_PI / (2.0 * n * n);
}

struct Case {
  int width, height;
  Mat4 toWorld;
  bool sparse;
};
std::vector<Case> cases() {
  const Mat4 turned = rotation({1, 2, 0.5}, 40);
  return {{8, 5, Mat4{}, false},
          {16, 9, turned, false},
          {12, 7, turned * scaling({1, 3, 0.5}), false},
          {12, 7, scaling({-1, 1, 1}), true},
          {9, 3, turned, true},
          {8, 5, turned * scaling(Vec3d(1e30)), false},
          {8, 5, turned * scaling(Vec3d(1e-30)), false},
          {1, 1, Mat4{}, false}};
}

TEST(EnvironmentSampler, DensityIntegratesToOne) {
  for (const Case& c : cases()) {
    const Scene scene = environmentScene(c.width, c.height, c.toWorld, 3, c.sparse);
    const EnvironmentSampler sampler(scene, scene.emitters[0]);
    const double sum = integrate(600, [&](Vec3f d) { return double(sampler.pdf({}, d)); });
    EXPECT_NEAR(sum, 1, 4e-3) << c.width << 'x' << c.height;
  }
}

TEST(EnvironmentSampler, SamplesFollowTheDensity) {
  for (const Case& c : cases()) {
    const Scene scene = environmentScene(c.width, c.height, c.toWorld, 4, c.sparse);
    const EnvironmentSampler sampler(scene, scene.emitters[0]);
    // Cells of equal solid angle: y and longitude.
    constexpr int kY = 20, kPhi = 20, kSamples = 50000, kFine = 40;
    std::vector<double> observed(kY * kPhi), expected(kY * kPhi);
    const auto cell = [&](Vec3f d) {
      const int y = std::clamp(static_cast<int>((d.y + 1) * 0.5f * kY), 0, kY - 1);
      const float phi = (std::atan2(d.z, d.x) + kPi) / kTwoPi;
      return static_cast<size_t>(y * kPhi + std::clamp(static_cast<int>(phi * kPhi), 0, kPhi - 1));
    };
    Rng random(5);
    int exact = 0;
    for (int i = 0; i < kSamples; ++i) {
      float pdf;
      const Vec3f d = sampler.sample({}, random.next2D(), &pdf);
      ASSERT_GT(pdf, 0);
      // The direction's rounding moves it within its cell, near the poles by a few percent of one.
      ASSERT_NEAR(pdf, sampler.pdf({}, d), 0.02f * pdf + 1e-6f);
      exact += std::abs(pdf - sampler.pdf({}, d)) <= 2e-5f * pdf ? 1 : 0;
      observed[cell(d)] += 1;
    }
    EXPECT_GT(exact, 0.98 * kSamples);
    for (int y = 0; y < kY * kFine; ++y) {
      for (int x = 0; x < kPhi * kFine; ++x) {
        const float z = -1 + (static_cast<float>(y) + 0.5f) * 2 / (kY * kFine);
        const float phi = -kPi + (static_cast<float>(x) + 0.5f) * kTwoPi / (kPhi * kFine);
        const float r = std::sqrt(1 - z * z);
        const Vec3f d{r * std::cos(phi), z, r * std::sin(phi)};
        expected[cell(d)] +=
            kSamples * double(sampler.pdf({}, d)) * 4 * M_PI / (kY * kFine * kPhi * kFine);
      }
    }
    for (double& e : expected) e = std::max(e, 1e-6);
    EXPECT_GT(test::chiSquaredPValue(observed, expected), 0.01 / 6)
        << c.width << 'x' << c.height << (c.sparse ? " sparse" : "");
  }
}

TEST(EnvironmentSampler, DensityIsPositiveWhereThereIsRadiance) {
  for (const Case& c : cases()) {
    const Scene scene = environmentScene(c.width, c.height, c.toWorld, 6, c.sparse);
    const EnvironmentSampler sampler(scene, scene.emitters[0]);
    Rng random(7);
    for (int i = 0; i < 20000; ++i) {
      const Vec3f d = sampleSphereUniform(random.next2D());
      const float pdf = sampler.pdf({}, d), value = luminance(sampler.radiance(d));
      if (value > 1e-4f) {
        EXPECT_GT(pdf, 0);
      }
    }
  }
}

// Mean of radiance / density is the integral, and with little variance: at most what the bilinear
// product of luminance and sine leaves.
TEST(EnvironmentSampler, WeightsAreNearlyConstant) {
  const Scene scene = environmentScene(32, 17, Mat4{}, 8, false);
  const EnvironmentSampler sampler(scene, scene.emitters[0]);
  Rng random(9);
  double sum = 0, square = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    float pdf;
    const Vec3f d = sampler.sample({}, random.next2D(), &pdf);
    const double weight = double(luminance(sampler.radiance(d)) / pdf);
    sum += weight, square += weight * weight;
  }
  const double mean = sum / kSamples, deviation = std::sqrt(square / kSamples - mean * mean);
  const double exact =
      integrate(800, [&](Vec3f d) { return double(luminance(sampler.radiance(d))); });
  EXPECT_NEAR(mean, exact, 0.01 * exact);
  EXPECT_LT(deviation, 0.1 * mean);
  EXPECT_NEAR(sampler.integral(), exact, 0.02 * exact);
}

// Mitsuba's axes: the middle column of the image lies towards +z... its first towards -z going
// round by +x; the first row is up.
TEST(EnvironmentSampler, OrientationIsMitsubas) {
  Scene scene = environmentScene(8, 5, Mat4{}, 1, true);
  Image& image = scene.images[0];
  std::fill(image.pixels.begin(), image.pixels.end(), 0.f);
  for (int x = 0; x < 8; ++x) {
    for (int y = 0; y < 5; ++y) {
      image.pixels[static_cast<size_t>(3 * (y * 8 + x))] = static_cast<float>(x);
      image.pixels[static_cast<size_t>(3 * (y * 8 + x) + 1)] = static_cast<float>(y);
    }
  }
  scene.emitters[0].scale = 1;
  const EnvironmentSampler sampler(scene, scene.emitters[0]);
  // u = 1/4 at +x: texel centres are at half integers.
  EXPECT_NEAR(sampler.radiance({1, 0, 0}).x, 1.5f, 1e-3f);
  EXPECT_NEAR(sampler.radiance({0, 0, 1}).x, 3.5f, 1e-3f);
  EXPECT_NEAR(sampler.radiance({-1, 0, 0}).x, 5.5f, 1e-3f);
  EXPECT_NEAR(sampler.radiance({0, 0, -1}).x, 3.5f, 1e-3f);  // between 7 and 0
  EXPECT_NEAR(sampler.radiance({0, 1, 0}).y, 0, 1e-3f);
  EXPECT_NEAR(sampler.radiance({1, 0, 0}).y, 2, 1e-3f);
  EXPECT_NEAR(sampler.radiance({0, -1, 0}).y, 4, 1e-3f);
}

TEST(EnvironmentSampler, ConstantIsCosineWeightedAroundANormal) {
  Scene scene;
  Emitter emitter;
  emitter.type = EmitterType::constant;
  emitter.radiance = Rgb(1, 2, 3);
  scene.emitters.push_back(emitter);
  const EnvironmentSampler sampler(scene, scene.emitters[0]);
  const Vec3f n = normalize(Vec3f{1, -2, 0.5f});
  Rng random(10);
  for (int i = 0; i < 100; ++i) {
    float pdf;
    const Vec3f d = sampler.sample(n, random.next2D(), &pdf);
    EXPECT_NEAR(pdf, dot(n, d) * kInvPi, 1e-5f);
    EXPECT_NEAR(pdf, sampler.pdf(n, d), 1e-5f);
    EXPECT_EQ(sampler.radiance(d), Rgb(1, 2, 3));
    sampler.sample({}, random.next2D(), &pdf);
    EXPECT_FLOAT_EQ(pdf, 0.25f * kInvPi);
  }
}

}  // namespace
}  // namespace lobelia
