// Furnace: materials that lose nothing return exactly what they get.
#include <gtest/gtest.h>

#include "bsdf/lobe_examples.h"
#include "lobelia/base/random.h"

namespace lobelia::test {
namespace {

float meanWeight(const Bsdf& bsdf, Vec3f wo, Transport transport) {
  Rng rng(3);
  double sum = 0;
  constexpr int kCount = 40000;
  for (int i = 0; i < kCount; ++i) {
    const float u = (static_cast<float>(i) + rng.next1D()) / kCount;
    if (const auto s = sample(bsdf, wo, u, rng.next2D(), LobeSet::all, transport))
      sum += static_cast<double>(s->weight.y);
  }
  return static_cast<float>(sum / kCount);
}

TEST(BsdfEnergy, LosslessMaterialsConserve) {
  std::vector<std::pair<std::string, Bsdf>> all;
  all.emplace_back("lambert", single(simple(LobeType::lambert)));
  all.emplace_back("diffuse transmission", single(simple(LobeType::diffuseTransmission)));
  all.emplace_back("mirror", single(simple(LobeType::deltaReflection)));
  Lobe none = simple(LobeType::deltaReflection);
  none.fresnel = Fresnel::conductor;
  none.eta = Rgb(0.f), none.k = Rgb(1.f);
  all.emplace_back("conductor without material", single(none));
  Lobe r = simple(LobeType::deltaReflection);
  r.fresnel = Fresnel::dielectric;
  r.interface = true;
  r.eta = Rgb(1.5f);
  Lobe t = r;
  t.type = LobeType::deltaTransmission;
  Bsdf glass;
  glass.add(r), glass.add(t);
  all.emplace_back("glass", glass);
  Lobe pane = r;
  pane.interface = false, pane.twoSided = true;
  pane.fresnel = Fresnel::thinDielectric;
  Lobe through = pane;
  through.type = LobeType::null;
  Bsdf thin;
  thin.add(pane), thin.add(through);
  all.emplace_back("pane", thin);
  for (const auto& [name, bsdf] : all)
    for (const float cosine : {1.f, 0.7f, 0.2f, 0.03f})
      EXPECT_NEAR(meanWeight(bsdf, directionAt(cosine, 1), Transport::importance), 1.f, 0.005f)
          << name << " at " << cosine;
}

TEST(BsdfEnergy, RadianceIsScaledByRefraction) {
  Lobe t = simple(LobeType::deltaTransmission);
  t.interface = true;
  t.eta = Rgb(1.5f);
  const Bsdf bsdf = single(t);
  const Vec3f wo = directionAt(0.8f, 0);
  const auto radiance = sample(bsdf, wo, 0.5f, {0.5f, 0.5f});
  const auto importance = sample(bsdf, wo, 0.5f, {0.5f, 0.5f}, LobeSet::all, Transport::importance);
  ASSERT_TRUE(radiance && importance);
  EXPECT_NEAR(importance->weight.x / radiance->weight.x, 2.25f, 1e-4f);
  EXPECT_FLOAT_EQ(radiance->eta, 1.5f);
  EXPECT_TRUE(radiance->delta && radiance->transmission);
  // Snell.
  EXPECT_NEAR(std::sqrt(1 - sqr(radiance->wi.z)) * 1.5f, std::sqrt(1 - sqr(wo.z)), 1e-5f);
  EXPECT_LT(radiance->wi.z, 0.f);
  // And back again, from inside.
  const auto back = sample(bsdf, radiance->wi, 0.5f, {0.5f, 0.5f});
  ASSERT_TRUE(back);
  EXPECT_NEAR(dot(back->wi, wo), 1.f, 1e-5f);
  EXPECT_NEAR(back->weight.x * radiance->weight.x, sqr(importance->weight.x), 1e-4f);
}

TEST(BsdfEnergy, TotalReflectionIsWhole) {
  Lobe r = simple(LobeType::deltaReflection);
  r.fresnel = Fresnel::dielectric;
  r.interface = true;
  r.eta = Rgb(1.5f);
  Lobe t = r;
  t.type = LobeType::deltaTransmission;
  Bsdf glass;
  glass.add(r), glass.add(t);
  // Inside, beyond the critical angle: the refracted branch yields nothing.
  const Vec3f wo = directionAt(-0.5f, 0);
  EXPECT_NEAR(meanWeight(glass, wo, Transport::radiance), 1.f, 0.005f);
  EXPECT_NEAR(
      meanWeight(roughGlass(Distribution::ggx, 0.01f, 0.01f, 1.5f), wo, Transport::radiance), 1.f,
      0.005f);
}

}  // namespace
}  // namespace lobelia::test
