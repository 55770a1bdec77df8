// Materials to BSDFs: against formulas written down once more in double precision, and the rules of
// the materials that wrap others.
#include <gtest/gtest.h>

#include <cmath>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/bsdf/coat.h"
#include "lobelia/scene/shading.h"
#include "scene/material_fixture.h"

namespace lobelia {
namespace {

using namespace test;

TEST(MakeBsdf, DiffuseIsOneSided) {
  Fixture f;
  const MaterialHandle m = f.add(diffuse({0.2f, 0.4f, 0.6f}));
  const Vec3f wo = directionAt(0.5f, 1), wi = directionAt(0.7f, 2);
  const Rgb value = evaluate(f.make(m, wo), wo, wi);
  EXPECT_NEAR(value.y, 0.4f * kInvPi * 0.7f, 1e-6f);
  EXPECT_EQ(evaluate(f.make(m, -wo), -wo, -wi), Rgb(0.f));
}

TEST(MakeBsdf, TwoSidedShowsItsBack) {
  Fixture f;
  const MaterialHandle red = f.add(diffuse({0.8f, 0, 0})), blue = f.add(diffuse({0, 0, 0.8f}));
  const MaterialHandle same = f.add(wrap(MaterialType::twoSided, red));
  const MaterialHandle both = f.add(wrap(MaterialType::twoSided, red, blue));
  const Vec3f wo = directionAt(-0.5f, 1), wi = directionAt(-0.7f, 2);
  EXPECT_NEAR(evaluate(f.make(same, wo), wo, wi).x, 0.8f * kInvPi * 0.7f, 1e-6f);
  EXPECT_NEAR(evaluate(f.make(both, wo), wo, wi).z, 0.8f * kInvPi * 0.7f, 1e-6f);
  EXPECT_EQ(evaluate(f.make(both, wo), wo, wi).x, 0.f);
  EXPECT_NEAR(evaluate(f.make(both, -wo), -wo, -wi).x, 0.8f * kInvPi * 0.7f, 1e-6f);
  EXPECT_EQ(evaluate(f.make(both, wo), wo, -wi), Rgb(0.f));
}

TEST(MakeBsdf, BlendAndMask) {
  Fixture f;
  Material blend = wrap(MaterialType::blend, f.add(diffuse(Rgb(0.2f))), f.add(diffuse(Rgb(0.8f))));
  blend.weight = 0.25f;
  const MaterialHandle m = f.add(wrap(MaterialType::mask, f.add(blend)));
  const Vec3f wo = directionAt(0.5f, 1), wi = directionAt(0.7f, 2);
  const Bsdf bsdf = f.make(m, wo);
  EXPECT_EQ(bsdf.lobeCount, 2);
  EXPECT_NEAR(evaluate(bsdf, wo, wi).x, (0.75f * 0.2f + 0.25f * 0.8f) * kInvPi * 0.7f, 1e-6f);
  EXPECT_NEAR(pdf(bsdf, wo, wi), 0.7f * kInvPi, 1e-6f);
}

TEST(MakeBsdf, LosslessMaterialsConserve) {
  Fixture f;
  for (const MaterialType type : {MaterialType::dielectric, MaterialType::thinDielectric,
                                  MaterialType::conductor, MaterialType::null}) {
    Material m;
    m.type = type;
    const MaterialHandle handle = f.add(m);
    for (const float cosine : {1.f, 0.5f, 0.05f, -0.3f, -0.9f}) {
      if (cosine < 0 && type == MaterialType::conductor) continue;
      const Vec3f wo = directionAt(cosine, 1);
      EXPECT_NEAR(meanWeight(f.make(handle, wo), wo), 1.f, 0.005f)
          << static_cast<int>(type) << " at " << cosine;
    }
  }
}

TEST(MakeBsdf, SharpLobesAreClassified) {
  Fixture f;
  Material plastic;
  plastic.type = MaterialType::roughPlastic;
  plastic.alphaU = plastic.alphaV = 0.05f;
  const Vec3f wo = directionAt(0.5f, 1);
  const Bsdf bsdf = f.make(f.add(plastic), wo);
  ASSERT_EQ(bsdf.lobeCount, 2);
  EXPECT_TRUE(bsdf.lobes[0].sharp);
  EXPECT_FALSE(bsdf.lobes[1].sharp);
}

double fresnel(double c, double eta) {
  const double s2 = (1 - c * c) / (eta * eta);
  if (s2 >= 1) return 1;
  const double ct = std::sqrt(1 - s2);
  const double rs = (c - eta * ct) / (c + eta * ct), rp = (eta * c - ct) / (eta * c + ct);
  return (rs * rs + rp * rp) / 2;
}

TEST(MakeBsdf, SmoothPlasticHasMitsubasBase) {
  Fixture f;
  Material m;
  m.type = MaterialType::plastic;
  m.ior = 1.9f;
  m.diffuse = Rgb(0.1f, 0.27f, 0.36f);
  const Vec3f wo = directionAt(0.5f, 1), wi = directionAt(0.7f, 2);
  const double n = 1 / 1.9;
  const double internal = -1.4399 * n * n + 0.7099 * n + 0.6681 + 0.0636 / n;
  for (const bool nonlinear : {false, true}) {
    m.nonlinear = nonlinear;
    const double d = 0.27 / (1 - (nonlinear ? 0.27 : 1.0) * internal);
    const double expected = d / 3.14159265358979 * 0.7 / (1.9 * 1.9) * (1 - fresnel(0.5, 1.9)) *
                            (1 - fresnel(0.7, 1.9));
    const Bsdf bsdf = f.make(f.add(m), wo);
    EXPECT_NEAR(static_cast<double>(evaluate(bsdf, wo, wi).y), expected, 1e-5 * expected);
  }
}

// A nearly smooth coat is a smooth coat, up to the quadrature rule of the internal reflectance.
TEST(MakeBsdf, RoughPlasticTendsToSmooth) {
  for (const Distribution d : {Distribution::ggx, Distribution::beckmann}) {
    const RoughCoat& coat = roughCoat(d, 0.001f, 1.5f);
    for (const int i : {10, 30, 63}) {
      const double c = i / 63.0;
      EXPECT_NEAR(static_cast<double>(coat.transmittance[static_cast<size_t>(i)]),
                  1 - fresnel(c, 1.5), 2e-3);
    }
    EXPECT_NEAR(coat.internalReflectance, fresnelDiffuseReflectance(1 / 1.5f), 0.02f);
    EXPECT_NEAR(coat.transmittance[kTransmittanceSize], 1 - fresnelDiffuseReflectance(1.5f), 2e-3f);
  }
  // Rough coats reflect less at grazing angles.
  EXPECT_GT(roughCoat(Distribution::ggx, 0.5f, 1.5f).transmittance[3],
            roughCoat(Distribution::ggx, 0.05f, 1.5f).transmittance[3]);
}

// Mitsuba 3's principled BSDF in double precision, reflection part.
struct Principled {
  double base[3], roughness, anisotropic, metallic, specTrans, eta, specTint, sheen, sheenTint,
      flatness, clearcoat, gloss;

  static double weight5(double c) { return std::pow(std::clamp(1 - c, 0.0, 1.0), 5); }
  static double mix(double a, double b, double t) { return a + (b - a) * t; }

  void evaluate(const double o[3], const double i[3], double out[3]) const {
    const double pi = 3.14159265358979323846;
    double h[3];
    double length = 0;
    for (int k = 0; k < 3; ++k) h[k] = o[k] + i[k], length += h[k] * h[k];
    length = std::sqrt(length);
    double d = 0;
    for (int k = 0; k < 3; ++k) h[k] /= length, d += h[k] * o[k];
    const double aspect = std::sqrt(1 - 0.9 * anisotropic);
    const double ax = std::max(0.001, roughness * roughness / aspect);
    const double ay = std::max(0.001, roughness * roughness * aspect);
    const double e = h[0] * h[0] / (ax * ax) + h[1] * h[1] / (ay * ay) + h[2] * h[2];
    const double density = 1 / (pi * ax * ay * e * e);
    const auto g1 = [](const double* v, double x, double y) {
      const double t2 = (x * x * v[0] * v[0] + y * y * v[1] * v[1]) / (v[2] * v[2]);
      return 2 / (1 + std::sqrt(1 + t2));
    };
    const double lum = 0.212671 * base[0] + 0.715160 * base[1] + 0.072169 * base[2];
    const double brdf = (1 - metallic) * (1 - specTrans);
    const double fo = weight5(i[2]), fi = weight5(o[2]);
    const double rr = 2 * roughness * d * d;
    const double base0 = (1 - 0.5 * fi) * (1 - 0.5 * fo) + rr * (fo + fi + fo * fi * (rr - 1));
    const double fss = mix(1, rr / 2, fo) * mix(1, rr / 2, fi);
    const double flat = 1.25 * (fss * (1 / (o[2] + i[2]) - 0.5) + 0.5);
    const double r0 = (eta - 1) / (eta + 1);
    const double alphaC = mix(0.1, 0.001, gloss), a2 = alphaC * alphaC;
    const double dc = (a2 - 1) / (pi * std::log(a2) * (1 + (a2 - 1) * h[2] * h[2]));
    const double coat = 0.25 * clearcoat * mix(0.04, 1, weight5(d)) * dc * g1(o, 0.25, 0.25) *
                        g1(i, 0.25, 0.25) * i[2];
    for (int k = 0; k < 3; ++k) {
      const double tint = base[k] / lum;
      const double f = (1 - metallic) * (1 - specTint) * fresnel(d, eta) +
                       metallic * mix(base[k], 1, weight5(d)) +
                       (1 - metallic) * specTint * mix(tint * r0 * r0, 1, weight5(d));
      out[k] = f * density * g1(o, ax, ay) * g1(i, ax, ay) / (4 * o[2]) + coat +
               brdf * i[2] * base[k] / pi * mix(base0, flat, flatness) +
               sheen * (1 - metallic) * weight5(d) * mix(1, tint, sheenTint) * i[2];
    }
  }
};

TEST(MakeBsdf, PrincipledIsMitsubas) {
  Rng rng(17);
  const auto unit = [&] { return static_cast<double>(rng.next1D()); };
  for (int n = 0; n < 200; ++n) {
    const bool transmits = n % 2 == 1;
    Principled p{{0.1 + 0.8 * unit(), 0.1 + 0.8 * unit(), 0.1 + 0.8 * unit()},
                 0.15 + 0.85 * unit(),
                 unit(),
                 unit(),
                 transmits ? unit() : 0.0,
                 1.1 + unit(),
                 unit(),
                 unit(),
                 unit(),
                 unit(),
                 unit(),
                 0.9 * unit()};
    Fixture f;
    Material m;
    m.type = MaterialType::principled;
    const auto number = [](double x) { return static_cast<float>(x); };
    m.diffuse = Rgb(number(p.base[0]), number(p.base[1]), number(p.base[2]));
    m.roughness = number(p.roughness), m.anisotropic = number(p.anisotropic);
    m.metallic = number(p.metallic), m.specTrans = number(p.specTrans), m.ior = number(p.eta);
    m.specTint = number(p.specTint), m.sheen = number(p.sheen), m.sheenTint = number(p.sheenTint);
    m.flatness = number(p.flatness), m.clearcoat = number(p.clearcoat);
    m.clearcoatGloss = number(p.gloss);
    const Vec3f wo = directionAt(0.05f + 0.95f * rng.next1D(), 6 * rng.next1D());
    const Bsdf bsdf = f.make(f.add(m), wo);
    const auto s = sample(bsdf, wo, rng.next1D(), rng.next2D());
    if (!s || s->wi.z < 0.02f) continue;
    const double o[3] = {static_cast<double>(wo.x), static_cast<double>(wo.y),
                         static_cast<double>(wo.z)};
    const double i[3] = {static_cast<double>(s->wi.x), static_cast<double>(s->wi.y),
                         static_cast<double>(s->wi.z)};
    double expected[3];
    p.evaluate(o, i, expected);
    const Rgb value = evaluate(bsdf, wo, s->wi);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(static_cast<double>(value[c]), expected[c], 2e-3 * expected[c] + 1e-6) << n;
  }
}

TEST(MakeBsdf, PrincipledGlassKeepsItsLightFromBothSides) {
  Fixture f;
  Material m;
  m.type = MaterialType::principled;
  m.diffuse = Rgb(1.f);
  m.specTrans = 1.f;
  m.roughness = 0.2f;
  const MaterialHandle handle = f.add(m);
  for (const float cosine : {0.9f, 0.5f, -0.9f}) {
    const Vec3f wo = directionAt(cosine, 1);
    const float albedo = meanWeight(f.make(handle, wo), wo);
    EXPECT_LT(albedo, 1.005f);
    EXPECT_GT(albedo, 0.97f) << cosine;
  }
}

TEST(MakeBsdf, PhongAndWardAddADiffuseLobe) {
  Fixture f;
  Material m;
  m.type = MaterialType::phong;
  m.diffuse = Rgb(0.3f);
  m.specular = Rgb(0.2f);
  m.alphaU = m.alphaV = 20.f;
  const Vec3f wo = directionAt(0.5f, 1), wi = directionAt(0.6f, 1 + kPi);
  const float cosR = dot(wi, Vec3f(-wo.x, -wo.y, wo.z));
  EXPECT_NEAR(evaluate(f.make(f.add(m), wo), wo, wi).x,
              (0.3f * kInvPi + 0.2f * 22 / kTwoPi * std::pow(cosR, 20.f)) * 0.6f, 1e-5f);
  m.type = MaterialType::ward;
  m.alphaU = 0.2f, m.alphaV = 0.4f;
  const Vec3f h = wo + wi;
  const float e = std::exp(-(sqr(h.x / 0.2f) + sqr(h.y / 0.4f)) / sqr(h.z));
  const float expected = 0.3f * kInvPi + 0.2f * e * dot(h, h) / (kPi * 0.08f * sqr(sqr(h.z)));
  EXPECT_NEAR(evaluate(f.make(f.add(m), wo), wo, wi).x, expected * 0.6f, 1e-5f);
}

TEST(MakeBsdf, PhongDoesNotCreateEnergy) {
  Fixture f;
  Material m;
  m.type = MaterialType::phong;
  m.diffuse = Rgb(0.8f, 0.2f, 0.2f);
  m.specular = Rgb(0.7f, 0.1f, 0.1f);
  m.alphaU = m.alphaV = 20.f;
  const Vec3f wo = directionAt(0.9f, 1);
  const Bsdf bsdf = f.make(f.add(m), wo);
  EXPECT_NEAR(bsdf.lobes[0].weight.x + bsdf.lobes[1].weight.x, 0.99f, 1e-5f);
  EXPECT_NEAR(bsdf.lobes[0].weight.y / bsdf.lobes[0].weight.x, 0.25f, 1e-5f);
}

TextureHandle addConstant(Scene& scene, Rgb value) {
  Texture t;
  t.value = value;
  scene.textures.push_back(t);
  return {static_cast<uint32_t>(scene.textures.size() - 1)};
}

TEST(MakeBsdf, NormalMapTurnsTheFrame) {
  Fixture f;
  Material m = wrap(MaterialType::normalMap, f.add(diffuse(Rgb(1.f))));
  const Vec3f n = normalize(Vec3f(0.3f, -0.2f, 1));
  m.map = addConstant(f.scene, (n + Vec3f(1.f)) * 0.5f);
  const Vec3f wo = directionAt(0.9f, 1), wi = directionAt(0.8f, 2);
  const Bsdf bsdf = f.make(f.add(m), wo);
  EXPECT_NEAR(dot(bsdf.frames[0].n, n), 1.f, 1e-5f);
  EXPECT_NEAR(dot(bsdf.frames[0].s, bsdf.frames[0].n), 0.f, 1e-6f);
  EXPECT_NEAR(dot(cross(bsdf.frames[0].s, bsdf.frames[0].t), bsdf.frames[0].n), 1.f, 1e-5f);
  // The softened terminator [Estevez19], written down once more.
  const float terrain = std::min(0.125f * (1 / sqr(n.z) - 1), 1.f);
  const float shadow = 2 / (1 + std::sqrt(1 + terrain * (1 / sqr(wi.z) - 1)));
  EXPECT_NEAR(evaluate(bsdf, wo, wi).x, dot(wi, n) * kInvPi * shadow, 1e-5f);
  EXPECT_LT(shadow, 0.999f);
  EXPECT_TRUE(bsdf.frames[0].perturbed);
  // Neutral: nothing changes.
  m.map = addConstant(f.scene, {0.5f, 0.5f, 1});
  EXPECT_NEAR(evaluate(f.make(f.add(m), wo), wo, wi).x, wi.z * kInvPi, 1e-6f);
}

TEST(MakeBsdf, NormalsThatFaceAwayAreTurned) {
  Fixture f;
  Material m = wrap(MaterialType::normalMap, f.add(diffuse(Rgb(1.f))));
  const Vec3f n = normalize(Vec3f(1, 0, 1));
  m.map = addConstant(f.scene, (n + Vec3f(1.f)) * 0.5f);
  const MaterialHandle handle = f.add(m);
  const Vec3f away = directionAt(0.3f, kPi);  // behind n, above the surface
  ASSERT_LT(dot(away, n), 0.f);
  EXPECT_NEAR(dot(f.make(handle, away).frames[0].n, Vec3f(-n.x, 0, n.z)), 1.f, 1e-5f);
  EXPECT_NEAR(dot(f.make(handle, directionAt(0.3f, 0)).frames[0].n, n), 1.f, 1e-5f);
}

// Height u * slope: the normal leans back by it. A ramp image of the same slope everywhere.
MaterialHandle addRamp(Fixture& f, float slope, MaterialHandle nested) {
  Image image;
  image.width = 8, image.height = 1, image.channels = 1;
  for (int i = 0; i < 8; ++i) image.pixels.push_back(static_cast<float>(i) / 8);
  f.scene.images.push_back(image);
  Texture t;
  t.type = TextureType::bitmap;
  t.image = {0};
  f.scene.textures.push_back(t);
  Material m = wrap(MaterialType::bump, nested);
  m.map = {static_cast<uint32_t>(f.scene.textures.size() - 1)};
  m.scale = slope;
  return f.add(m);
}

TEST(MakeBsdf, BumpMapLeansTheNormal) {
  Fixture f;
  const MaterialHandle m = addRamp(f, 0.5f, f.add(diffuse(Rgb(1.f))));
  const Vec3f n = normalize(Vec3f(-0.5f, 0, 1));
  const Vec3f wo = directionAt(0.9f, 1);
  EXPECT_NEAR(dot(f.make(m, wo).frames[0].n, n), 1.f, 1e-5f);
  // Larger tangents: less steep.
  f.at.dpdu = {2, 0, 0};
  EXPECT_NEAR(dot(f.make(m, wo).frames[0].n, normalize(Vec3f(-0.25f, 0, 1))), 1.f, 1e-5f);
  // The other handedness of uv keeps the normal outside.
  f.at.dpdu = {-1, 0, 0};
  EXPECT_NEAR(dot(f.make(m, wo).frames[0].n, normalize(Vec3f(0.5f, 0, 1))), 1.f, 1e-5f);
}

TEST(MakeBsdf, TwoSidedBumpIsMirroredBehind) {
  Fixture f;
  const MaterialHandle bump = addRamp(f, 0.5f, f.add(diffuse(Rgb(1.f))));
  const MaterialHandle m = f.add(wrap(MaterialType::twoSided, bump));
  const Vec3f wo = directionAt(0.9f, 1), wi = directionAt(0.6f, 3);
  const Vec3f behind(wo.x, wo.y, -wo.z), from(wi.x, wi.y, -wi.z);
  const float front = evaluate(f.make(m, wo), wo, wi).x;
  EXPECT_GT(front, 0.f);
  EXPECT_NEAR(evaluate(f.make(m, behind), behind, from).x, front, 1e-6f);
}

TEST(MakeBsdf, BrokenMaterialsEnd) {
  Fixture f;
  const MaterialHandle self = f.add(wrap(MaterialType::twoSided, {0}));  // wraps itself
  const Vec3f wo = directionAt(0.5f, 1);
  EXPECT_EQ(f.make(self, wo).lobeCount, 0);
  EXPECT_EQ(f.make({}, wo).lobeCount, 0);
}

}  // namespace
}  // namespace lobelia
