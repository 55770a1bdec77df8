// Symmetries, sets of lobes, sides, and the adjoint.
#include "lobelia/bsdf/bsdf.h"

#include <gtest/gtest.h>

#include "bsdf/lobe_examples.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"

namespace lobelia::test {
namespace {

TEST(Bsdf, IsReciprocal) {
  Rng rng(11);
  for (const Example& e : examples()) {
    if (e.bsdf.lobes[0].type == LobeType::diffuseTransmission) continue;  // from one side only
    for (int n = 0; n < 300; ++n) {
      const Vec3f a = sampleHemisphereCosine(rng.next2D());
      const float u = rng.next1D();
      const auto s = sample(e.bsdf, a, u, rng.next2D());
      if (!s || s->delta || s->pdf < 1e-3f) continue;
      const Vec3f b = s->wi;
      const float forward = evaluate(e.bsdf, a, b).y / std::abs(b.z);
      const float backward = evaluate(e.bsdf, b, a).y / std::abs(a.z);
      // f(a, b) / n(a)^2 is symmetric for radiance towards a.
      const float scale = b.z < 0 && e.bsdf.lobes[0].interface ? sqr(e.bsdf.lobes[0].eta.x) : 1.f;
      EXPECT_NEAR(forward * scale, backward, 5e-3f * std::max(backward, 1e-3f)) << e.name;
    }
  }
}

TEST(Bsdf, SetsAddUpToAll) {
  Bsdf bsdf;
  bsdf.add(simple(LobeType::lambert));
  bsdf.add(microfacets(Distribution::ggx, 0.02f, 0.02f, Fresnel::conductor));
  bsdf.add(microfacets(Distribution::beckmann, 0.3f, 0.2f, Fresnel::dielectric));
  bsdf.add(simple(LobeType::phong, 4000));
  classify(bsdf, 0.08f);
  EXPECT_FALSE(bsdf.lobes[0].sharp);
  EXPECT_TRUE(bsdf.lobes[1].sharp);
  EXPECT_FALSE(bsdf.lobes[2].sharp);
  EXPECT_TRUE(bsdf.lobes[3].sharp);
  Rng rng(5);
  int nonzero = 0;
  for (int n = 0; n < 500; ++n) {
    const Vec3f wo = sampleHemisphereCosine(rng.next2D());
    const float u = rng.next1D();
    const auto s = sample(bsdf, wo, u, rng.next2D());
    if (!s) continue;
    const Rgb rough = evaluate(bsdf, wo, s->wi, LobeSet::rough);
    const Rgb sharp = evaluate(bsdf, wo, s->wi, LobeSet::sharp);
    const Rgb all = evaluate(bsdf, wo, s->wi, LobeSet::all);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(rough[c] + sharp[c], all[c], 1e-5f * all[c]);
    nonzero += sharp.x > 0 && rough.x > 0 ? 1 : 0;
  }
  EXPECT_GT(nonzero, 100);
}

TEST(Bsdf, ValueAndDensityAtOnceAreThoseOfTheirOwn) {
  Rng rng(17);
  std::vector<Example> all = examples();
  Lobe twoSided = simple(LobeType::lambert);
  twoSided.twoSided = true;
  all.push_back({"two-sided lambert", single(twoSided)});
  Bsdf mixed = single(twoSided);
  mixed.add(microfacets(Distribution::ggx, 0.3f, 0.1f, Fresnel::conductor));
  all.push_back({"lambert and metal", mixed});
  int nonzero = 0;
  for (const Example& e : all) {
    for (int n = 0; n < 300; ++n) {
      const Vec3f wo = sampleSphereUniform(rng.next2D());
      const float u = rng.next1D();
      const auto s = sample(e.bsdf, wo, u, rng.next2D());
      const Vec3f wi = s && !s->delta && n % 2 == 0 ? s->wi : sampleSphereUniform(rng.next2D());
      const BsdfValue both = evaluateWithPdf(e.bsdf, wo, wi, LobeSet::all, LobeSet::all);
      const Rgb value = evaluate(e.bsdf, wo, wi);
      const float density = pdf(e.bsdf, wo, wi);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(both.value[c], value[c], 2e-3f * value[c]) << e.name;
      EXPECT_NEAR(both.pdf, density, 2e-3f * density) << e.name;
      nonzero += value.x > 0 ? 1 : 0;
    }
  }
  EXPECT_GT(nonzero, 1000);
}

TEST(Bsdf, SampleKeepsToItsSet) {
  Bsdf bsdf;
  bsdf.add(simple(LobeType::lambert));
  bsdf.add(simple(LobeType::deltaReflection));
  classify(bsdf, 0.08f);
  Rng rng(6);
  const Vec3f wo = directionAt(0.5f, 0);
  for (int n = 0; n < 100; ++n) {
    const float u = rng.next1D();
    const auto rough = sample(bsdf, wo, u, rng.next2D(), LobeSet::rough);
    ASSERT_TRUE(rough);
    EXPECT_FALSE(rough->delta || rough->sharp);
    EXPECT_NEAR(rough->weight.x, 1.f, 1e-5f);  // the whole choice is the diffuse lobe's
    const auto sharp = sample(bsdf, wo, u, rng.next2D(), LobeSet::sharp);
    ASSERT_TRUE(sharp);
    EXPECT_TRUE(sharp->delta && sharp->sharp);
    EXPECT_EQ(sharp->pdf, 0.f);
    EXPECT_NEAR(sharp->weight.x, 1.f, 1e-5f);
  }
  // Among all lobes the delta lobe takes half of the choices.
  const Vec3f wi = directionAt(0.7f, 2);
  EXPECT_NEAR(pdf(bsdf, wo, wi, LobeSet::all), 0.5f * pdf(bsdf, wo, wi, LobeSet::rough), 1e-6f);
}

TEST(Bsdf, OneSidedLobesAreBlackFromBehind) {
  for (const Example& e : examples()) {
    if (e.bsdf.lobes[0].interface || e.bsdf.lobes[0].twoSided) continue;
    const Vec3f wo = directionAt(-0.5f, 0);
    EXPECT_FALSE(sample(e.bsdf, wo, 0.3f, {0.4f, 0.6f})) << e.name;
    EXPECT_EQ(evaluate(e.bsdf, wo, directionAt(0.5f, 2)), Rgb(0.f)) << e.name;
    EXPECT_EQ(evaluate(e.bsdf, wo, directionAt(-0.5f, 2)), Rgb(0.f)) << e.name;
  }
}

TEST(Bsdf, TwoSidedLobesActAlike) {
  Rng rng(9);
  for (Example e : examples()) {
    if (e.bsdf.lobes[0].interface || e.bsdf.lobes[0].twoSided) continue;
    for (int i = 0; i < e.bsdf.lobeCount; ++i) e.bsdf.lobes[i].twoSided = true;
    const Vec3f wo = directionAt(0.6f, 0.4f);
    const Vec3f behind(wo.x, wo.y, -wo.z);
    for (int n = 0; n < 20; ++n) {
      const float u = rng.next1D();
      const Vec2f u2 = rng.next2D();
      const auto a = sample(e.bsdf, wo, u, u2), b = sample(e.bsdf, behind, u, u2);
      ASSERT_EQ(a.has_value(), b.has_value());
      if (!a) continue;
      EXPECT_EQ(a->wi.z, -b->wi.z) << e.name;
      EXPECT_EQ(a->pdf, b->pdf) << e.name;
      EXPECT_EQ(evaluate(e.bsdf, wo, a->wi), evaluate(e.bsdf, behind, b->wi)) << e.name;
    }
  }
}

TEST(Bsdf, ImportanceCorrectsShadingNormals) {
  Bsdf bsdf = single(simple(LobeType::lambert));
  bsdf.frames[0] = frameFromNormal(normalize(Vec3f(0.3f, 0, 1)));
  const Vec3f wo = directionAt(0.8f, 1), wi = directionAt(0.6f, 3);
  const float radiance = evaluate(bsdf, wo, wi).x;
  const float importance = evaluate(bsdf, wo, wi, LobeSet::all, Transport::importance).x;
  const Vec3f n = bsdf.frames[0].n;
  // Adjoint: what the same light path carries the other way round, per projected area.
  const float reversed = evaluate(bsdf, wi, wo).x;
  EXPECT_NEAR(importance / wi.z, reversed / wo.z, 1e-5f);
  EXPECT_NEAR(radiance, dot(wi, n) * kInvPi, 1e-6f);
}

TEST(Bsdf, PerturbedNormalsMustAgree) {
  Bsdf bsdf = single(simple(LobeType::lambert));
  bsdf.frames[0] = frameFromNormal(normalize(Vec3f(1, 0, 1)));
  bsdf.frames[0].perturbed = true;
  const Vec3f wo = directionAt(0.9f, 0);
  EXPECT_GT(evaluate(bsdf, wo, directionAt(0.2f, 0)).x, 0.f);
  const Vec3f below = directionAt(-0.2f, 0);  // above the tilted plane, below the surface
  ASSERT_GT(dot(below, bsdf.frames[0].n), 0.f);
  EXPECT_EQ(evaluate(bsdf, wo, below).x, 0.f);
  EXPECT_EQ(pdf(bsdf, wo, below), 0.f);
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const auto s = sample(bsdf, wo, 0.5f, rng.next2D());
    if (!s) continue;
    EXPECT_GT(s->wi.z, 0.f);
  }
}

TEST(Bsdf, FresnelAtNormalIncidence) {
  Lobe glass = simple(LobeType::deltaReflection);
  glass.fresnel = Fresnel::dielectric;
  glass.eta = Rgb(1.5f);
  const Vec3f up(0, 0, 1);
  EXPECT_NEAR(sample(single(glass), up, 0.5f, {})->weight.x, 0.04f, 1e-6f);
  Lobe metal = glass;
  metal.fresnel = Fresnel::conductor;
  metal.eta = Rgb(0.2f), metal.k = Rgb(3.9f);
  // |(n - 1) / (n + 1)|^2 with n = 0.2 + 3.9 i.
  EXPECT_NEAR(sample(single(metal), up, 0.5f, {})->weight.x,
              (0.8f * 0.8f + 3.9f * 3.9f) / (1.2f * 1.2f + 3.9f * 3.9f), 1e-5f);
  // Brewster's angle, tan = 1.5: only the perpendicular half reflects.
  const float cosine = 1 / std::sqrt(1 + 1.5f * 1.5f);
  const float rs = (cosine - 1.5f * std::sqrt(1 - (1 - cosine * cosine) / 2.25f)) /
                   (cosine + 1.5f * std::sqrt(1 - (1 - cosine * cosine) / 2.25f));
  EXPECT_NEAR(sample(single(glass), directionAt(cosine, 0), 0.5f, {})->weight.x, 0.5f * rs * rs,
              1e-5f);
}

// Without a step of the index of refraction the dielectric lobe is gone; the coat above stays.
TEST(Bsdf, PrincipledCoatNeedsNoDielectricBelow) {
  const Vec3f wo = normalize(Vec3f(0.3f, 0, 1)), wi{-wo.x, 0, wo.z};
  for (const auto distribution : {Distribution::gtr1, Distribution::ggx}) {
    Lobe lobe = microfacets(distribution, 0.1f, 0.1f, Fresnel::principled);
    lobe.eta = Rgb(1.f), lobe.tint = Rgb(0.04f);
    Bsdf bsdf;
    bsdf.add(lobe);
    if (distribution == Distribution::gtr1) {
      EXPECT_GT(evaluate(bsdf, wo, wi).y, 0.1f);
    } else {
      EXPECT_EQ(evaluate(bsdf, wo, wi), Rgb{});
    }
  }
}

TEST(Bsdf, ExtremeInputStaysFinite) {
  Rng rng(21);
  for (const Example& e : examples()) {
    for (const float cosine : {1.f, 1e-3f, 1e-6f, 0.f, -1e-6f, -1.f}) {
      const Vec3f wo = directionAt(cosine, 0.5f);
      for (const Vec2f u : {Vec2f(0, 0), Vec2f(0x1.fffffep-1f, 0x1.fffffep-1f), Vec2f(0.5f, 0)}) {
        for (const float uLobe : {0.f, 0.5f, 0x1.fffffep-1f}) {
          const auto s = sample(e.bsdf, wo, uLobe, u);
          if (!s) continue;
          EXPECT_TRUE(isFinite(s->wi) && isFinite(s->weight) && std::isfinite(s->pdf)) << e.name;
          EXPECT_NEAR(length(s->wi), 1.f, 1e-4f) << e.name;
        }
        const Vec3f wi = directionAt(cosine, 0.5f + u.x);
        EXPECT_TRUE(isFinite(evaluate(e.bsdf, wo, wi))) << e.name << " " << cosine;
        EXPECT_TRUE(std::isfinite(pdf(e.bsdf, wo, wi))) << e.name << " " << cosine;
      }
    }
  }
}

}  // namespace
}  // namespace lobelia::test
