// Every sampler against its density, and the mean of its weights against quadrature.
#include <gtest/gtest.h>

#include "bsdf/lobe_examples.h"
#include "lobelia/bsdf/microfacet_sampling.h"
#include "support/chi_squared.h"

namespace lobelia::test {
namespace {

struct View {
  float cosTheta, phi;
};
constexpr View kViews[] = {{0.97f, 0.4f}, {0.5f, 2.f}, {0.08f, 1.f}, {-0.6f, 0.7f}};

bool actsFrom(const Bsdf& bsdf, float cosTheta) { return cosTheta > 0 || bsdf.lobes[0].interface; }

TEST(BsdfSampling, InverseErf) {
  for (const float x : {-0.9999f, -0.95f, -0.3f, 0.f, 1e-4f, 0.5f, 0.99f, 0.99999f})
    EXPECT_NEAR(std::erf(inverseErf(x)), x, 2e-6f);
  EXPECT_TRUE(std::isfinite(inverseErf(1.f)) && std::isfinite(inverseErf(-1.f)));
}

TEST(BsdfSampling, FollowsItsDensity) {
  const std::vector<Example> all = examples();
  const auto parts = [](const Example& e, const View& v) {
    std::vector<Part> list = partsOf(e, directionAt(v.cosTheta, v.phi));
    const LobeType type = e.bsdf.lobes[0].type;
    if (!e.bsdf.lobes[0].interface && type != LobeType::diffuseTransmission &&
        type != LobeType::thinTransmission)
      list.pop_back();
    return list;
  };
  int tests = 0;
  for (const Example& e : all)
    for (const View& v : kViews)
      if (actsFrom(e.bsdf, v.cosTheta)) tests += static_cast<int>(parts(e, v).size());
  const double significance = sidak(0.01, tests);
  uint64_t seed = 1;
  for (const Example& e : all) {
    for (const View& v : kViews) {
      if (!actsFrom(e.bsdf, v.cosTheta)) continue;
      const Vec3f wo = directionAt(v.cosTheta, v.phi);
      for (const Part& part : parts(e, v)) {
        const double p = chiSquaredDirections(
            SphereChart(part.axis, static_cast<double>(part.spread)),
            [&](Rng& rng) -> std::optional<Vec3f> {
              const float u = rng.next1D();
              const auto s = sample(e.bsdf, wo, u, rng.next2D());
              if (!s || s->delta || !part.holds(s->wi)) return std::nullopt;
              return s->wi;
            },
            [&](Vec3f wi) { return part.holds(wi) ? pdf(e.bsdf, wo, wi) : 0.f; }, seed++, 25000);
        EXPECT_GT(p, significance)
            << e.name << " from cosine " << v.cosTheta << " to side " << part.side;
      }
    }
  }
}

TEST(BsdfSampling, DensityOfSamplesIsPdf) {
  Rng rng(7);
  for (const Example& e : examples()) {
    const Vec3f wo = directionAt(0.6f, 0.3f);
    for (int n = 0; n < 200; ++n) {
      const float u = rng.next1D();
      const auto s = sample(e.bsdf, wo, u, rng.next2D());
      if (!s || s->delta) continue;
      const float expected = pdf(e.bsdf, wo, s->wi);
      EXPECT_NEAR(s->pdf, expected, 2e-3f * expected) << e.name;
      const Rgb f = evaluate(e.bsdf, wo, s->wi);
      EXPECT_NEAR(s->weight.y * s->pdf, f.y, 4e-3f * f.y) << e.name;
    }
  }
}

// Mean of sample() weights over a stratified grid, with its standard error.
struct Mean {
  Rgb value;
  double error;
};
Mean sampledAlbedo(const Bsdf& bsdf, Vec3f wo, uint64_t seed) {
  constexpr int kGrid = 180;
  Rng rng(seed);
  Vec3d sum{};
  double squares = 0;
  for (int i = 0; i < kGrid * kGrid; ++i) {
    const Vec2f j = rng.next2D();
    const Vec2f u((static_cast<float>(i % kGrid) + j.x) / kGrid,
                  (static_cast<float>(i / kGrid) + j.y) / kGrid);
    const auto s = sample(bsdf, wo, rng.next1D(), u, LobeSet::all, Transport::importance);
    if (!s) continue;
    sum += Vec3d(static_cast<double>(s->weight.x), static_cast<double>(s->weight.y),
                 static_cast<double>(s->weight.z));
    squares += sqr(s->weight.y);
  }
  const double n = kGrid * kGrid;
  sum /= n;
  return {Rgb(static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)),
          std::sqrt(std::max(0.0, squares / n - sum.y * sum.y) / n)};
}

TEST(BsdfSampling, MeanWeightIsTheAlbedo) {
  uint64_t seed = 100;
  for (const Example& e : examples()) {
    for (const View& v : kViews) {
      if (!actsFrom(e.bsdf, v.cosTheta)) continue;
      const Vec3f wo = directionAt(v.cosTheta, v.phi);
      const Mean sampled = sampledAlbedo(e.bsdf, wo, seed++);
      Rgb expected = quadratureAlbedo(e, wo);
      for (int i = 0; i < e.bsdf.lobeCount; ++i)
        if (e.bsdf.lobes[i].type == LobeType::deltaReflection) expected += e.bsdf.lobes[i].weight;
      // 0.5 %, plus the noise of sampling the whole distribution at grazing angles.
      const float tolerance =
          0.005f * std::max(expected.y, 0.02f) + 4 * static_cast<float>(sampled.error);
      EXPECT_NEAR(sampled.value.y, expected.y, tolerance) << e.name << " at " << v.cosTheta;
      EXPECT_LT(sampled.error, 0.015 * static_cast<double>(expected.y) + 1e-4)
          << e.name << " at " << v.cosTheta;
      EXPECT_TRUE(!e.lossless || maxComponent(expected) < 1.005f) << e.name << " " << v.cosTheta;
    }
  }
}

}  // namespace
}  // namespace lobelia::test
