#include "lobelia/transfer/reflection.h"

#include <gtest/gtest.h>

#include <span>

#include "bsdf/lobe_examples.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/bsdf/albedo.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {
namespace {

Vec3f randomDirection(Rng& random) { return sampleSphereUniform(random.next2D()); }

TEST(Turned, TakesOneDirectionToTheOtherAndKeepsAngles) {
  Rng random(1, 0);
  for (int i = 0; i < 1000; ++i) {
    const Vec3f from = randomDirection(random), to = randomDirection(random);
    const Vec3f v = randomDirection(random) * 0.7f, u = randomDirection(random);
    EXPECT_LT(length(turned(from, from, to) - to), 2e-6f);
    EXPECT_NEAR(dot(turned(v, from, to), turned(u, from, to)), dot(v, u), 2e-6f);
    EXPECT_LT(length(turned(turned(v, from, to), to, from) - v), 2e-6f);
    // The smallest turn leaves its axis as it is.
    const Vec3f axis = normalize(cross(from, to));
    EXPECT_LT(length(turned(axis, from, to) - axis), 2e-5f);
  }
}

TEST(Turned, NowhereAndHalfWayRound) {
  const Vec3f v(0.1f, -0.5f, 0.2f);
  for (const Vec3f d : {normalize(Vec3f(1, 2, 3)), Vec3f(1, 0, 0), Vec3f(0, -1, 0)}) {
    EXPECT_LT(length(turned(v, d, d) - v), 1e-6f);
    EXPECT_LT(length(turned(d, d, -d) + d), 1e-6f);
    EXPECT_NEAR(length(turned(v, d, -d)), length(v), 1e-6f);
    const Vec3f close = normalize(-d + Vec3f(1e-3f, 2e-3f, 0));
    EXPECT_LT(length(turned(d, d, close) - close), 1e-3f);
  }
}

// Of f cos over all directions: albedo, then the directions by luminance.
test::Values<6> integrated(const Bsdf& bsdf, Vec3f wo, float spread) {
  const auto f = [&](Vec3f wi) {
    const Rgb v = evaluate(bsdf, wo, wi);
    const Vec3f m = wi * luminance(v);
    test::Values<6> values;
    for (int i = 0; i < 3; ++i) {
      values[static_cast<size_t>(i)] = static_cast<double>(v[i]);
      values[static_cast<size_t>(i) + 3] = static_cast<double>(m[i]);
    }
    return values;
  };
  const test::SphereChart chart({-wo.x, -wo.y, wo.z}, static_cast<double>(spread));
  return test::integrateSphere<6>(chart, f, 1e-4);
}

float spreadOf(const test::Example& example) {
  for (int i = 0; i < example.bsdf.lobeCount; ++i)
    if (example.bsdf.lobes[i].type == LobeType::deltaReflection) return 1.f / 128;
  return std::max(example.spread, 1.f / 128);
}

TEST(Reflection, MirrorsAndNeedlesBecomeAsSharpAsSlicesHold) {
  Bsdf bsdf;
  for (const test::Example& example : test::examples())
    if (example.name == "mixture") bsdf = example.bsdf;
  bsdf.add(test::simple(LobeType::phong, 1e6f));
  const Vec3f wo = test::directionAt(0.8f, 1.f);
  const Reflection r = reflectionOf(bsdf, wo);
  ASSERT_EQ(r.count, 3);
  EXPECT_EQ(r.lobes[0].kappa, kMostKappa);
  for (int i = 0; i < 2; ++i)
    EXPECT_GT(dot(r.lobes[static_cast<size_t>(i)].axis, r.mirror), 0.9999f);
  EXPECT_EQ(glossyPart(bsdf).lobeCount + diffusePart(bsdf).lobeCount, bsdf.lobeCount);
}

TEST(Reflection, ManyLobesShareFourPlaces) {
  Bsdf bsdf;
  for (int i = 0; i < 7; ++i) {
    Lobe lobe = test::simple(LobeType::phong, static_cast<float>(10 << i));
    lobe.weight = Rgb(0.05f, 0.1f, 0.02f) * static_cast<float>(i + 1);
    bsdf.add(lobe);
  }
  const Reflection r = reflectionOf(bsdf, test::directionAt(0.7f, 0.f));
  ASSERT_EQ(r.count, Reflection::kFewLobes);
  Rgb sum{};
  for (const ReflectedLobe& lobe : std::span(r.lobes).first(4)) sum += lobe.alpha;
  EXPECT_LT(length(sum - r.glossy), 1e-5f * length(sum));
  Rgb energies{};
  for (int i = 0; i < 7; ++i) energies += lobeAlbedo(bsdf.lobes[i], 0.7f);
  EXPECT_LT(length(sum - energies), 0.002f * length(sum));
}

// Along the rougher tangent, and none of the energy or of the mean direction is lost.
TEST(Reflection, StreaksAreRowsOfLobes) {
  for (const auto& [alphaX, alphaY] : {std::pair(0.06f, 0.3f), std::pair(0.3f, 0.06f)}) {
    const Bsdf bsdf =
        test::single(test::microfacets(Distribution::ggx, alphaX, alphaY, Fresnel::conductor));
    const Reflection r = reflectionOf(bsdf, test::directionAt(0.9f, 0.8f));
    ASSERT_EQ(r.count, 10);  // twice the ratio of the roughnesses
    Rgb sum{};
    Vec3f first{}, spread{};
    for (const ReflectedLobe& lobe : std::span(r.lobes).first(10)) {
      const float energy = luminance(lobe.alpha), size = lobes::meanResultant(lobe.kappa);
      sum += lobe.alpha, first += lobe.axis * (energy * size);
      for (int c = 0; c < 2; ++c) spread[c] += energy * sqr(lobe.axis[c] - r.r[c] / length(r.r));
    }
    EXPECT_LT(length(sum - r.glossy), 1e-4f * length(sum));
    EXPECT_LT(length(first / luminance(sum) - r.r), 0.02f);
    EXPECT_GT(alphaX < alphaY ? spread.y : spread.x, 6 * (alphaX < alphaY ? spread.x : spread.y));
  }
}

// Of the lobes, at directions around the mirror's, over the albedo.
std::array<float, 4> densities(const Reflection& r) {
  std::array<float, 4> out{};
  for (size_t k = 0; k < out.size(); ++k) {
    const float angle = 0.25f * static_cast<float>(k) - 0.25f;
    const Vec3f d =
        r.mirror * std::cos(angle) + normalize(cross(r.mirror, {0, 1, 0})) * std::sin(angle);
    for (const ReflectedLobe& lobe : std::span(r.lobes).first(static_cast<size_t>(r.count)))
      out[k] += luminance(lobe.alpha) / luminance(r.glossy) * lobe.kappa /
                (kTwoPi * -std::expm1(-2 * lobe.kappa)) *
                std::exp(lobe.kappa * (dot(lobe.axis, d) - 1));
  }
  return out;
}

// Where the horizon begins to cut lobes off no step is seen.
TEST(Reflection, LobesMoveSmoothlyWithTheElevation) {
  for (const float alpha : {0.2f, 0.4f, 0.7f}) {
    const Bsdf bsdf =
        test::single(test::microfacets(Distribution::ggx, alpha, alpha, Fresnel::conductor));
    std::array<float, 4> before = densities(reflectionOf(bsdf, test::directionAt(0.9f, 0.f)));
    for (float cosine = 0.895f; cosine > 0.15f; cosine -= 0.005f) {
      const auto now = densities(reflectionOf(bsdf, test::directionAt(cosine, 0.f)));
      for (size_t k = 0; k < now.size(); ++k)
        EXPECT_NEAR(now[k], before[k], 0.15f * *std::ranges::max_element(now))
            << alpha << " " << cosine << " " << k;
      before = now;
    }
  }
}

// A frame that leans away from the surface: points for the ratio to the flat lobe.
TEST(Reflection, KnowsTheTerminatorOfBumps) {
  for (const float alpha : {0.05f, 0.3f}) {
    Bsdf bsdf =
        test::single(test::microfacets(Distribution::ggx, alpha, alpha, Fresnel::dielectric));
    bsdf.add(test::simple(LobeType::lambert));
    bsdf.frames[0] = frameFromNormal(normalize(Vec3f(0.4f, 0, 1)));
    bsdf.frames[0].perturbed = true;
    bsdf.frames[0].bumpAlpha2 = 0.02f;
    const Vec3f wo = normalize(Vec3f(-0.5f, 0.3f, 0.6f));
    const auto glossy = integrated(glossyPart(bsdf), wo, alpha);
    const Reflection r = reflectionOf(bsdf, wo);
    EXPECT_NEAR(r.glossy.x, glossy[0], 0.01 * glossy[0]);
    EXPECT_LT(r.glossy.x, 0.98f * lobeAlbedo(bsdf.lobes[0], dot(wo, bsdf.frames[0].n)).x);
    const auto diffuse = integrated(diffusePart(bsdf), wo, 1);
    EXPECT_NEAR(r.diffuse.x, diffuse[0], 0.01 * diffuse[0]);
    EXPECT_LT(r.diffuse.x, 0.99f);
  }
}

TEST(Reflection, AlbedosAndMeanDirectionsAreThoseOfTheBsdf) {
  for (const test::Example& example : test::examples())
    for (const Vec3f wo : {test::directionAt(0.95f, 0.4f), test::directionAt(0.5f, 2.f),
                           test::directionAt(0.12f, -1.f), test::directionAt(-0.4f, 1.f)}) {
      SCOPED_TRACE(example.name + " " + std::to_string(wo.z));
      const Reflection r = reflectionOf(example.bsdf, wo);
      const float spread = spreadOf(example);
      const double tolerance = example.name.starts_with("coated") ? 0.01 : 0.005;
      const auto diffuse = integrated(diffusePart(example.bsdf), wo, 1);
      const auto glossy = integrated(glossyPart(example.bsdf), wo, spread);
      for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(r.diffuse[i], diffuse[static_cast<size_t>(i)],
                    0.005 * diffuse[static_cast<size_t>(i)]);
        EXPECT_NEAR(r.glossy[i], glossy[static_cast<size_t>(i)],
                    tolerance * glossy[static_cast<size_t>(i)]);
      }
      const Vec3f exact(static_cast<float>(glossy[3]), static_cast<float>(glossy[4]),
                        static_cast<float>(glossy[5]));
      const float energy = luminance(r.glossy);
      const float exactEnergy =
          luminance(Rgb(static_cast<float>(glossy[0]), static_cast<float>(glossy[1]),
                        static_cast<float>(glossy[2])));
      ASSERT_EQ(r.count > 0, energy > 0);
      if (r.count == 0) continue;
      EXPECT_LT(length(r.r - exact / exactEnergy), 0.02f);
      Rgb sum{};
      for (int i = 0; i < r.count; ++i) {
        const ReflectedLobe& lobe = r.lobes[static_cast<size_t>(i)];
        sum += lobe.alpha;
        EXPECT_NEAR(length(lobe.axis), 1, 1e-5);
        EXPECT_GT(dot(lobe.axis, r.n), -0.2f);
        EXPECT_LE(lobe.kappa, i > 0 ? r.lobes[static_cast<size_t>(i) - 1].kappa : kMostKappa);
      }
      EXPECT_LT(length(sum - r.glossy), 1e-5f * length(r.glossy));
    }
}

}  // namespace
}  // namespace lobelia::transfer
