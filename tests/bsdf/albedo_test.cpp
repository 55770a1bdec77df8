// Albedo tables against quadrature of the lobes.
#include "lobelia/bsdf/albedo.h"

#include <gtest/gtest.h>

#include "bsdf/lobe_examples.h"
#include "support/chi_squared.h"

namespace lobelia::test {
namespace {

Rgb integrate(const Lobe& lobe, Vec3f wo, float spread) {
  return quadratureAlbedo({"", single(lobe), spread}, wo);
}

void expectAlbedo(const std::string& name, const Lobe& lobe, float spread, float tolerance) {
  for (const float cosine : {1.f, 0.83f, 0.51f, 0.23f, 0.11f, 0.043f}) {
    const Rgb expected = integrate(lobe, directionAt(cosine, 0.7f), spread);
    const Rgb value = lobeAlbedo(lobe, cosine);
    const Rgb error = value - expected;
    EXPECT_LT(maxComponent(max(error, -error) / max(expected, Rgb(0.01f))), tolerance)
        << name << " at cosine " << cosine << ": " << value.x << " " << value.y << " " << value.z
        << ", not " << expected.x << " " << expected.y << " " << expected.z;
  }
}

TEST(LobeAlbedo, MicrofacetsWithEveryFresnel) {
  const struct {
    Distribution distribution;
    const char* name;
    float roughest;  // the Phong distribution changes fast as its exponent nears zero
  } distributions[] = {{Distribution::ggx, "ggx", 0.9f},
                       {Distribution::beckmann, "beckmann", 0.9f},
                       {Distribution::phong, "phong", 0.6f},
                       {Distribution::sphericalGaussian, "spherical Gaussian", 1.9f}};
  for (const auto& d : distributions)
    for (const float alpha : {0.013f, 0.1f, 0.37f, d.roughest})
      for (const Fresnel fresnel :
           {Fresnel::one, Fresnel::conductor, Fresnel::schlick, Fresnel::dielectric})
        expectAlbedo(std::string(d.name) + " " + std::to_string(alpha) + " fresnel " +
                         std::to_string(static_cast<int>(fresnel)),
                     microfacets(d.distribution, alpha, alpha, fresnel), alpha, 0.005f);
}

TEST(LobeAlbedo, OtherLobes) {
  expectAlbedo("clearcoat", clearcoat(0.03f), 0.03f, 0.005f);
  expectAlbedo("lambert", simple(LobeType::lambert), 1, 0.005f);
  expectAlbedo("coated", smoothCoated(), 1, 0.005f);
  expectAlbedo("rough coated", roughCoated(0.2f), 1, 0.005f);
  for (const float n : {1.f, 20.f, 700.f})
    expectAlbedo("phong", simple(LobeType::phong, n), std::sqrt(2 / (n + 2)), 0.005f);
  for (int variant = 0; variant < 3; ++variant)
    for (const float alpha : {0.05f, 0.2f, 0.7f})
      expectAlbedo("ward " + std::to_string(variant) + " " + std::to_string(alpha),
                   simple(LobeType::ward, alpha, alpha, variant), alpha, 0.005f);
  for (const float alpha : {0.08f, 0.1f, 0.35f, 0.8f})
    expectAlbedo("sheen", simple(LobeType::sheen, alpha), 1, 0.005f);
  Lobe sheet = microfacets(Distribution::ggx, 0.2f, 0.2f, Fresnel::schlick);
  sheet.type = LobeType::thinTransmission;
  sheet.k = {0.f, 0.5f, 1.f};
  expectAlbedo("sheet", sheet, 0.2f, 0.005f);
  Lobe metal = microfacets(Distribution::ggx, 0.3f, 0.3f, Fresnel::coatedConductor);
  metal.eta = {0.2f, 0.92f, 1.1f}, metal.k = {3.9f, 2.45f, 2.14f};
  metal.parameters.x = 1.5f;
  expectAlbedo("metal in a medium", metal, 0.3f, 0.005f);
  for (const float roughness : {0.f, 0.5f, 1.f})
    for (const float flatness : {0.f, 0.6f})
      expectAlbedo("principled", principledBase(roughness, flatness, 0.4f), 1, 0.005f);
}

// Anisotropy at the root mean square of the alphas, transmission scaled from one index.
TEST(LobeAlbedo, EstimatesAreNear) {
  const Lobe aniso = microfacets(Distribution::ggx, 0.1f, 0.4f, Fresnel::conductor);
  for (const float cosine : {0.95f, 0.5f, 0.2f}) {
    const float a = integrate(aniso, directionAt(cosine, 0.7f), 0.1f).y;
    EXPECT_NEAR(lobeAlbedo(aniso, cosine).y, a, 0.03f * a) << cosine;
  }
  for (const float eta : {1.2f, 1.5f, 2.f}) {
    const Bsdf glass = roughGlass(Distribution::ggx, 0.3f, 0.3f, eta);
    for (const float cosine : {0.95f, 0.5f, 0.2f, -0.95f, -0.7f}) {
      for (int lobe = 0; lobe < 2; ++lobe) {
        const float t = integrate(glass.lobes[lobe], directionAt(cosine, 0.7f), 0.3f).y;
        EXPECT_NEAR(lobeAlbedo(glass.lobes[lobe], cosine).y, t, cosine > 0 ? 0.05f : 0.11f)
            << cosine << " eta " << eta << " lobe " << lobe;
      }
    }
  }
}

TEST(LobeAlbedo, UnderOtherLayers) {
  Lobe metal = microfacets(Distribution::ggx, 0.1f, 0.1f, Fresnel::schlick);
  Lobe sheet = metal;
  sheet.type = LobeType::thinTransmission;
  for (const Lobe& bare : {metal, sheet, simple(LobeType::sheen, 0.3f)}) {
    const Lobe lobe = underCoat(bare);
    for (const float cosine : {0.95f, 0.5f, 0.2f}) {
      const float exact = integrate(lobe, directionAt(cosine, 0.7f), 0.1f).y;
      EXPECT_NEAR(lobeAlbedo(lobe, cosine).y, exact, 0.04f * exact + 0.005f)
          << cosine << " " << static_cast<int>(lobe.type);
      EXPECT_LT(exact, 0.97f * lobeAlbedo(bare, cosine).y);
    }
  }
}

TEST(LobeAlbedo, ZeroWhereTheLobeDoesNotAct) {
  EXPECT_EQ(lobeAlbedo(simple(LobeType::lambert), -0.5f), Rgb(0.f));
  Lobe both = simple(LobeType::lambert);
  both.twoSided = true;
  EXPECT_EQ(lobeAlbedo(both, -0.5f), Rgb(1.f));
}

}  // namespace
}  // namespace lobelia::test
