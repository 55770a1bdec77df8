// glTF's material and the coated conductor: energy, reciprocity, samplers, limits known in closed
// form; absorption inside.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "lobelia/base/sampling.h"
#include "scene/material_fixture.h"
#include "support/chi_squared.h"

namespace lobelia::test {
namespace {

Material gltf(Rgb base, float metallic, float roughness) {
  Material m;
  m.type = MaterialType::metallicRoughness;
  m.diffuse = base;
  m.metallic = metallic;
  m.roughness = roughness;
  m.ior = 1.5f;
  return m;
}

Material coatedGold(float alpha, float coatAlpha) {
  Material m;
  m.type = MaterialType::coatedConductor;
  m.distribution = Distribution::ggx;
  m.eta = Rgb(0.14f, 0.37f, 1.44f), m.k = Rgb(3.98f, 2.38f, 1.60f);
  m.alphaU = m.alphaV = alpha;
  m.coatAlphaU = m.coatAlphaV = coatAlpha;
  return m;
}

struct Named {
  std::string name;
  Material material;
};

// White materials that make the most of their energy.
std::vector<Named> whiteMaterials() {
  std::vector<Named> all;
  for (const float roughness : {0.f, 0.15f, 0.5f, 1.f}) {
    const std::string r = " roughness " + std::to_string(roughness);
    all.push_back({"dielectric" + r, gltf(Rgb(1.f), 0, roughness)});
    all.push_back({"metal" + r, gltf(Rgb(1.f), 1, roughness)});
    all.push_back({"half metal" + r, gltf(Rgb(1.f), 0.5f, roughness)});
    Material m = gltf(Rgb(1.f), 0, roughness);
    m.specTrans = 1;
    all.push_back({"glass" + r, m});
    m.specTrans = 0.6f, m.metallic = 0.2f;
    all.push_back({"part glass" + r, m});
    m.thin = true;
    all.push_back({"thin" + r, m});
    m = gltf(Rgb(1.f), 0.3f, roughness);
    m.clearcoat = 1, m.clearcoatRoughness = 0.3f;
    all.push_back({"clearcoat" + r, m});
    m.sheenColor = Rgb(1.f), m.sheenRoughness = 0.5f;
    all.push_back({"clearcoat and sheen" + r, m});
    m.specTrans = 0.7f;
    all.push_back({"clearcoat, sheen, glass" + r, m});
    m = gltf(Rgb(1.f), 1, roughness);
    m.anisotropic = 0.8f, m.anisotropicRotation = 0.6f;
    all.push_back({"anisotropic" + r, m});
    m = gltf(Rgb(1.f), 0, roughness);
    m.isSpecularGlossiness = true;
    m.specular = Rgb(0.6f, 0.3f, 0.1f);
    all.push_back({"specular-glossiness" + r, m});
    Material coated = coatedGold(sqr(roughness), 0);
    coated.eta = Rgb(0.f), coated.k = Rgb(1.f);
    all.push_back({"smooth coat" + r, coated});
    coated.coatAlphaU = 0.3f, coated.coatAlphaV = 0.1f;
    all.push_back({"rough coat" + r, coated});
  }
  return all;
}

TEST(LayeredMaterials, NoneIsBrighterThanItsLight) {
  for (const Named& n : whiteMaterials()) {
    Fixture f;
    const MaterialHandle m = f.add(n.material);
    for (const float cosine : {1.f, 0.6f, 0.25f, 0.06f}) {
      const Vec3f wo = directionAt(cosine, 1);
      const float energy = meanWeight(f.make(m, wo), wo);
      EXPECT_LT(energy, 1.012f) << n.name << " at " << cosine;
      EXPECT_GT(energy, 0.3f) << n.name << " at " << cosine;
    }
  }
}

// What scatters singly only, and has nothing below that is black, loses little.
TEST(LayeredMaterials, WhiteOnesStayWhite) {
  Fixture f;
  Material sheet = gltf(Rgb(1.f), 0, 0);
  sheet.specTrans = 1, sheet.thin = true;
  Material glass = gltf(Rgb(1.f), 0, 0.1f);
  glass.specTrans = 1;
  for (const Material& material :
       {gltf(Rgb(1.f), 0, 0), gltf(Rgb(1.f), 0, 0.5f), gltf(Rgb(1.f), 1, 0.2f), sheet, glass}) {
    const MaterialHandle m = f.add(material);
    for (const float cosine : {1.f, 0.5f}) {
      const Vec3f wo = directionAt(cosine, 1);
      EXPECT_NEAR(meanWeight(f.make(m, wo), wo), 1, 0.02f) << m.index << " at " << cosine;
    }
  }
}

// f(wo, wi) of the BSDF made for wo is that of the one made for wi: paths may be walked both ways.
TEST(LayeredMaterials, AreReciprocal) {
  Rng rng(7);
  for (const Named& n : whiteMaterials()) {
    Fixture f;
    const MaterialHandle m = f.add(n.material);
    int compared = 0;
    for (int i = 0; i < 60; ++i) {
      Vec3f a = sampleHemisphereCosine(rng.next2D());
      const Bsdf forward = f.make(m, a);
      const float uLobe = rng.next1D();
      const auto s = sample(forward, a, uLobe, rng.next2D());
      if (!s || s->delta || s->pdf < 1e-2f || s->pdf > 1e3f) continue;
      const Bsdf backward = f.make(m, s->wi);
      const float there = evaluate(forward, a, s->wi).y / std::abs(s->wi.z);
      const float back = evaluate(backward, s->wi, a).y / std::abs(a.z);
      const float scale = s->wi.z < 0 && !n.material.thin ? 2.25f : 1.f;
      EXPECT_NEAR(there * scale, back, 0.01f * back + 1e-4f) << n.name;
      ++compared;
    }
    if (n.name.find("0.5") != std::string::npos) {
      EXPECT_GT(compared, 20) << n.name;
    }
  }
}

bool transmits(const Bsdf& bsdf) {
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    if (bsdf.lobes[i].type == LobeType::thinTransmission || bsdf.lobes[i].interface) return true;
  }
  return false;
}

TEST(LayeredMaterials, SamplersFollowTheirDensity) {
  const std::vector<Named> all = whiteMaterials();
  uint64_t seed = 1;
  const double significance = sidak(0.01, static_cast<int>(2 * all.size()));
  // Smooth ones are narrower than the chart's rings: left to the tests of bsdf/.
  for (const Named& n : all) {
    Fixture f;
    const MaterialHandle m = f.add(n.material);
    const Vec3f wo = directionAt(0.6f, 0.8f);
    const Bsdf bsdf = f.make(m, wo);
    for (const float side : {1.f, -1.f}) {
      if (side < 0 && !transmits(bsdf)) continue;
      const auto holds = [&](Vec3f w) { return w.z * side >= 0; };
      const double p = chiSquaredDirections(
          SphereChart({-wo.x, -wo.y, side * wo.z}, 0.02),
          [&](Rng& rng) -> std::optional<Vec3f> {
            const float u = rng.next1D();
            const auto s = sample(bsdf, wo, u, rng.next2D());
            if (!s || s->delta || !holds(s->wi)) return std::nullopt;
            return s->wi;
          },
          [&](Vec3f wi) { return holds(wi) ? pdf(bsdf, wo, wi) : 0.f; }, seed++, 10000);
      if (n.material.roughness.value > (side < 0 ? 0.2f : 0.1f) &&
          n.material.alphaU.value > 1e-3f) {
        EXPECT_GT(p, significance) << n.name << " side " << side;
      }
    }
  }
}

double ggx(double alpha, Vec3f h) {
  const double a2 = alpha * alpha, c = static_cast<double>(h.z);
  return a2 / (3.14159265358979 * std::pow(c * c * (a2 - 1) + 1, 2));
}
double smith(double alpha, Vec3f w) {
  const double c2 = static_cast<double>(w.z) * static_cast<double>(w.z);
  return 2 / (1 + std::sqrt(1 + alpha * alpha * (1 - c2) / c2));
}

// Appendix B: D G F / (4 n.l n.v) with F = base + (1 - base) (1 - v.h)^5.
TEST(LayeredMaterials, MetalIsTheSpecificationsFormula) {
  Fixture f;
  const MaterialHandle m = f.add(gltf({0.9f, 0.6f, 0.2f}, 1, 0.6f));
  const Vec3f wo = directionAt(0.7f, 0.3f), wi = directionAt(0.4f, 2.2f);
  const Vec3f h = normalize(wo + wi);
  const double alpha = 0.36;
  const double common = ggx(alpha, h) * smith(alpha, wo) * smith(alpha, wi) / (4 * 0.7);
  const double w = std::pow(1 - static_cast<double>(dot(wo, h)), 5);
  const Rgb value = evaluate(f.make(m, wo), wo, wi);
  EXPECT_NEAR(value.x, common * (0.9 + 0.1 * w), 1e-4);
  EXPECT_NEAR(value.z, common * (0.2 + 0.8 * w), 1e-4);
}

// The diffuse part of a dielectric is close to the specification's (1 - F(v.h)) base / pi.
TEST(LayeredMaterials, DielectricIsNearTheSpecificationsFormula) {
  Fixture f;
  Material material = gltf({0.8f, 0.5f, 0.2f}, 0, 0.5f);
  const MaterialHandle m = f.add(material);
  const Vec3f wo = directionAt(0.8f, 0.3f), wi = directionAt(0.6f, 2.2f);
  const Vec3f h = normalize(wo + wi);
  const double fresnel = 0.04 + 0.96 * std::pow(1 - static_cast<double>(dot(wo, h)), 5);
  const double specular = ggx(0.25, h) * smith(0.25, wo) * smith(0.25, wi) / (4 * 0.8) * fresnel;
  const Rgb value = evaluate(f.make(m, wo), wo, wi);
  const double expected = specular + (1 - fresnel) * 0.8 / 3.14159265 * 0.6;
  EXPECT_NEAR(value.x, expected, 0.05 * expected);
  // KHR_materials_specular: without strength only the diffuse part is left, whole.
  material.specularStrength = 0.f;
  const MaterialHandle bare = f.add(material);
  EXPECT_NEAR(evaluate(f.make(bare, wo), wo, wi).x, 0.8f * kInvPi * 0.6f, 1e-4f);
}

TEST(LayeredMaterials, AnisotropyIsWiderAlongItsDirection) {
  Fixture f;
  Material material = gltf(Rgb(1.f), 1, 0.3f);
  material.anisotropic = 0.8f;
  const Vec3f wo(0, 0, 1);
  const Vec3f alongX = normalize(Vec3f(0.5f, 0, 1)), alongY = normalize(Vec3f(0, 0.5f, 1));
  const MaterialHandle straight = f.add(material);
  EXPECT_GT(evaluate(f.make(straight, wo), wo, alongX).x,
            3 * evaluate(f.make(straight, wo), wo, alongY).x);
  material.anisotropicRotation = kPi / 2;
  const MaterialHandle turned = f.add(material);
  EXPECT_NEAR(evaluate(f.make(turned, wo), wo, alongY).x,
              evaluate(f.make(straight, wo), wo, alongX).x, 1e-4f);
  // A texture says the same: (0, 1) of full strength.
  Texture texture;
  texture.value = {0.5f, 1, 1};
  f.scene.textures.push_back(texture);
  material.anisotropicRotation = 0.f;
  material.anisotropicDirection = {0};
  const MaterialHandle textured = f.add(material);
  EXPECT_NEAR(evaluate(f.make(textured, wo), wo, alongY).x,
              evaluate(f.make(straight, wo), wo, alongX).x, 1e-4f);
}

TEST(LayeredMaterials, SheetsAreSeenThroughStraight) {
  Fixture f;
  Material material = gltf({0.9f, 0.5f, 0.1f}, 0, 0);
  material.specTrans = 1, material.thin = true;
  const MaterialHandle m = f.add(material);
  for (const float cosine : {0.8f, -0.8f}) {
    const Vec3f wo = directionAt(cosine, 0.3f);
    const Bsdf bsdf = f.make(m, wo);
    Rgb through{};
    Rng rng(3);
    constexpr int kCount = 4000;
    for (int i = 0; i < kCount; ++i) {
      const float u = rng.next1D();
      const auto s = sample(bsdf, wo, u, rng.next2D());
      if (s && s->transmission) {
        EXPECT_EQ(s->wi, -wo);
        through += s->weight / float{kCount};
      }
    }
    const float fresnel = 0.04f + 0.96f * std::pow(0.2f, 5.f);
    EXPECT_NEAR(through.x, 0.9f * (1 - fresnel), 0.02f);
    EXPECT_NEAR(through.z, 0.1f * (1 - fresnel), 0.005f);
  }
}

// Smooth layers: r + (1 - r)^2 f / (1 - r f), with f at the refracted cosine in the coat.
TEST(LayeredMaterials, SmoothCoatOnSmoothMetal) {
  Fixture f;
  const Material gold = coatedGold(0, 0);
  const MaterialHandle m = f.add(gold);
  for (const float cosine : {1.f, 0.5f, 0.2f}) {
    const Vec3f wo = directionAt(cosine, 0.3f);
    const Bsdf bsdf = f.make(m, wo);
    EXPECT_TRUE(onlyDelta(bsdf));
    const double c = static_cast<double>(cosine), n = 1.5;
    const double ct = std::sqrt(1 - (1 - c * c) / (n * n));
    const double rs = (c - n * ct) / (c + n * ct), rp = (n * c - ct) / (n * c + ct);
    const double r = 0.5 * (rs * rs + rp * rp);
    // Metal by complex arithmetic.
    const std::complex<double> index(0.37 / n, 2.38 / n);
    const std::complex<double> inside = std::sqrt(1.0 - (1 - ct * ct) / (index * index));
    const double ms = std::norm((ct - index * inside) / (ct + index * inside));
    const double mp = std::norm((index * ct - inside) / (index * ct + inside));
    const double metal = 0.5 * (ms + mp);
    const double expected = r + (1 - r) * (1 - r) * metal / (1 - r * metal);
    EXPECT_NEAR(static_cast<double>(meanWeight(bsdf, wo)), expected, 0.006) << cosine;
  }
}

TEST(LayeredMaterials, DiffuseTransmittersMayReflect) {
  Fixture f;
  Material material;
  material.type = MaterialType::diffuseTransmitter;
  material.diffuse = Rgb(0.3f, 0.2f, 0.1f);
  material.transmittance = Rgb(0.1f, 0.4f, 0.5f);
  const MaterialHandle m = f.add(material);
  const Vec3f wi = directionAt(0.5f, 2);
  for (const float side : {0.6f, -0.6f}) {
    const Vec3f wo = directionAt(side, 0);
    const Bsdf bsdf = f.make(m, wo);
    const Vec3f same = side > 0 ? wi : -wi;
    EXPECT_NEAR(evaluate(bsdf, wo, same).x, 0.3f * kInvPi * 0.5f, 1e-5f);
    EXPECT_NEAR(evaluate(bsdf, wo, -same).z, 0.5f * kInvPi * 0.5f, 1e-5f);
  }
}

TEST(Absorption, ActsFromBehindAndThroughWrappers) {
  Fixture f;
  Material glass;
  glass.type = MaterialType::dielectric;
  glass.absorption = {0.5f, 1, 0};
  const MaterialHandle inner = f.add(glass);
  const MaterialHandle wrapped =
      f.add(wrap(MaterialType::mask, f.add(wrap(MaterialType::bump, inner))));
  f.at.t = 2;
  for (const MaterialHandle m : {inner, wrapped}) {
    f.at.material = m;
    const Rgb behind = interiorTransmittance(f.scene, f.at, {0, 0, -1});
    EXPECT_FLOAT_EQ(behind.x, std::exp(-1.f));
    EXPECT_FLOAT_EQ(behind.y, std::exp(-2.f));
    EXPECT_FLOAT_EQ(behind.z, 1);
    EXPECT_EQ(interiorTransmittance(f.scene, f.at, {0, 0, 1}), Rgb(1.f));
  }
  Material sheet = gltf(Rgb(1.f), 0, 0);
  sheet.absorption = Rgb(1.f);
  f.at.material = f.add(sheet);
  EXPECT_FLOAT_EQ(interiorTransmittance(f.scene, f.at, {0, 0, -1}).x, std::exp(-2.f));
  sheet.thin = true;
  f.at.material = f.add(sheet);
  EXPECT_EQ(interiorTransmittance(f.scene, f.at, {0, 0, -1}), Rgb(1.f));
}

}  // namespace
}  // namespace lobelia::test
