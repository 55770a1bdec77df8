// A BSDF whose lobes lie in several frames: the sum of BSDFs of one frame each.
#include <gtest/gtest.h>

#include "bsdf/lobe_examples.h"
#include "lobelia/base/sampling.h"
#include "lobelia/bsdf/gaussians.h"
#include "support/chi_squared.h"

namespace lobelia::test {
namespace {

Lobe metal(float alpha) {
  Lobe lobe = simple(LobeType::microfacetReflection, alpha, alpha);
  lobe.fresnel = Fresnel::schlick;
  lobe.eta = Rgb(0.9f, 0.6f, 0.3f);
  lobe.k = Rgb(1.f) - lobe.eta;
  return lobe;
}

ShadingFrame tilted(Vec3f n, float bumpAlpha2) {
  ShadingFrame frame = frameFromNormalTangent(normalize(n), Vec3f(0.3f, 1, 0));
  frame.perturbed = true;
  frame.bumpAlpha2 = bumpAlpha2;
  return frame;
}

// A diffuse base with a bumpy normal under a coat with the surface's, beside glossy metal with
// another normal.
struct Frames {
  Bsdf all;
  std::vector<Bsdf> parts;  // one frame each
  explicit Frames(float bumps) {
    const ShadingFrame frames[3] = {tilted({0.4f, -0.1f, 1}, bumps), ShadingFrame(),
                                    tilted({-0.2f, 0.3f, 1}, 2 * bumps)};
    const Lobe lobes[4] = {simple(LobeType::lambert), metal(0.1f), metal(0.3f),
                           simple(LobeType::lambert)};
    const int frameOf[4] = {0, 1, 2, 2};
    all.frameCount = 0;
    for (const ShadingFrame& frame : frames) {
      all.addFrame(frame);
      parts.emplace_back().frames[0] = frame;
    }
    for (int i = 0; i < 4; ++i) {
      Lobe lobe = lobes[i];
      lobe.weight = Rgb(0.4f, 0.3f, 0.2f) * static_cast<float>(1 + i);
      parts[static_cast<size_t>(frameOf[i])].add(lobe);
      lobe.frame = static_cast<uint8_t>(frameOf[i]);
      lobe.selection = 0.5f + 0.2f * static_cast<float>(i);
      all.add(lobe);
    }
    classify(all, 0.08f);
    for (Bsdf& part : parts) classify(part, 0.08f);
  }
};

void expectNear(Rgb a, Rgb b) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-6f + 2e-5f * std::abs(b[c]));
}

TEST(BsdfFrames, EqualFramesAreOne) {
  Bsdf bsdf;
  bsdf.frameCount = 0;
  const ShadingFrame a = tilted({0.4f, -0.1f, 1}, 0.1f);
  EXPECT_EQ(bsdf.addFrame(a), 0);
  EXPECT_EQ(bsdf.addFrame(ShadingFrame()), 1);
  EXPECT_EQ(bsdf.addFrame(a), 0);
  EXPECT_EQ(bsdf.frameCount, 2);
  EXPECT_EQ(bsdf.addFrame(tilted({1, 0, 1}, 0)), 2);
  EXPECT_EQ(bsdf.addFrame(tilted({2, 0, 1}, 0)), 3);
  EXPECT_EQ(bsdf.addFrame(tilted({3, 0, 1}, 0)), 0);  // no room
  EXPECT_EQ(bsdf.frameCount, kMaxFrames);
}

TEST(BsdfFrames, ValueIsTheSumOfTheParts) {
  const Frames f(0.05f);
  Rng rng(5);
  int partial = 0;
  for (int n = 0; n < 4000; ++n) {
    const Vec3f wo = sampleSphereUniform(rng.next2D()), wi = sampleSphereUniform(rng.next2D());
    for (const Transport transport : {Transport::radiance, Transport::importance}) {
      Rgb sum{};
      int seen = 0;
      for (const Bsdf& part : f.parts) {
        const Rgb value = evaluate(part, wo, wi, LobeSet::all, transport);
        sum += value;
        if (value != Rgb{}) ++seen;
      }
      if (seen == 1 || seen == 2) ++partial;
      expectNear(evaluate(f.all, wo, wi, LobeSet::all, transport), sum);
    }
  }
  EXPECT_GT(partial, 50);  // directions that some frames see and others do not
  const Vec3f wo = directionAt(0.7f, 1);
  Rgb sum{};
  for (const Bsdf& part : f.parts) sum += albedo(part, wo);
  expectNear(albedo(f.all, wo), sum);
}

TEST(BsdfFrames, ImportanceIsTheAdjoint) {
  const Frames f(0.05f);
  Rng rng(6);
  for (int n = 0; n < 2000; ++n) {
    // Above all planes: there nothing is cut off.
    const Vec3f wo = directionAt(0.6f + 0.4f * rng.next1D(), 6.28f * rng.next1D());
    const Vec3f wi = directionAt(0.6f + 0.4f * rng.next1D(), 6.28f * rng.next1D());
    expectNear(evaluate(f.all, wo, wi, LobeSet::all, Transport::importance) * (wo.z / wi.z),
               evaluate(f.all, wi, wo));
  }
}

TEST(BsdfFrames, SamplerFollowsItsDensity) {
  const Frames f(0.05f);
  const float cosines[] = {0.95f, 0.5f, 0.15f};
  const double significance = sidak(0.01, 3);
  uint64_t seed = 40;
  for (const float c : cosines) {
    const Vec3f wo = directionAt(c, 2.f);
    const Vec3f mirror(-wo.x, -wo.y, wo.z);
    const double p = chiSquaredDirections(
        SphereChart(mirror, 0.3),
        [&](Rng& rng) -> std::optional<Vec3f> {
          const float u = rng.next1D();
          const auto s = sample(f.all, wo, u, rng.next2D());
          if (!s) return std::nullopt;
          return s->wi;
        },
        [&](Vec3f wi) { return pdf(f.all, wo, wi); }, seed++, 25000);
    EXPECT_GT(p, significance) << "from cosine " << c;
  }
}

TEST(BsdfFrames, SamplesAreWorthTheirValue) {
  const Frames f(0.05f);
  Rng rng(8);
  int fromFrame[kMaxFrames] = {};
  for (int n = 0; n < 3000; ++n) {
    const Vec3f wo = directionAt(0.05f + 0.95f * rng.next1D(), 6.28f * rng.next1D());
    const float u = rng.next1D();
    const auto s = sample(f.all, wo, u, rng.next2D());
    if (!s) continue;
    const float expected = pdf(f.all, wo, s->wi);
    EXPECT_NEAR(s->pdf, expected, 4e-3f * expected);
    const Rgb value = evaluate(f.all, wo, s->wi);
    EXPECT_NEAR(s->weight.y * s->pdf, value.y, 8e-3f * value.y);
    for (int i = 0; i < 3; ++i)
      if (evaluate(f.parts[static_cast<size_t>(i)], wo, s->wi) != Rgb{}) ++fromFrame[i];
  }
  for (int i = 0; i < 3; ++i) EXPECT_GT(fromFrame[i], 1000);
}

// A delta lobe reflects about the normal of its own frame.
TEST(BsdfFrames, MirrorsReflectInTheirOwnFrame) {
  Bsdf bsdf = single(simple(LobeType::deltaReflection));
  bsdf.lobes[0].frame = bsdf.addFrame(frameFromNormal(normalize(Vec3f(0.3f, 0.2f, 1))));
  ASSERT_EQ(bsdf.frameCount, 2);
  const Vec3f wo = directionAt(0.8f, 1), n = bsdf.frames[1].n;
  const auto s = sample(bsdf, wo, 0.5f, {});
  ASSERT_TRUE(s);
  EXPECT_LT(length(s->wi - (n * (2 * dot(n, wo)) - wo)), 1e-6f);
}

TEST(BsdfFrames, ExpansionIsTheSumOfTheParts) {
  const Frames f(0.05f);
  for (const float c : {0.9f, 0.4f}) {
    const Vec3f wi = directionAt(c, 1.f);
    const LobeExpansion all = expand(f.all, wi, 4);
    Rgb diffuse{};
    std::vector<GaussianLobe> gaussians;
    for (const Bsdf& part : f.parts) {
      const LobeExpansion e = expand(part, wi, 4);
      diffuse += e.diffuse;
      gaussians.insert(gaussians.end(), e.gaussians.begin(), e.gaussians.begin() + e.count);
    }
    expectNear(all.diffuse, diffuse);
    ASSERT_EQ(all.count, static_cast<int>(gaussians.size()));
    for (size_t i = 0; i < gaussians.size(); ++i) {
      EXPECT_EQ(all.gaussians[i].axis, gaussians[i].axis);
      EXPECT_EQ(all.gaussians[i].normal, gaussians[i].normal);
      expectNear(all.gaussians[i].amplitude, gaussians[i].amplitude);
    }
  }
}

}  // namespace
}  // namespace lobelia::test
