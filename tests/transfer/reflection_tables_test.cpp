#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/geodesic_grid.h"
#include "lobelia/transfer/lobe_moments.h"
#include "lobelia/transfer/reflected_lobes.h"
#include "lobelia/transfer/reflection.h"
#include "support/box_scene.h"

namespace lobelia::transfer {
namespace {

Material named(MaterialType type, const std::string& name) {
  Material m;
  m.type = type;
  m.name = name;
  return m;
}

Material microfacets(MaterialType type, Distribution distribution, float alpha) {
  Material m = named(type, "microfacets " + std::to_string(alpha));
  m.distribution = distribution;
  m.alphaU = m.alphaV = alpha;
  m.eta = Rgb(0.2f, 0.92f, 1.1f), m.k = Rgb(3.9f, 2.45f, 2.14f);
  return m;
}

Material phongMaterial(float exponent) {
  Material m = named(MaterialType::phong, "phong " + std::to_string(exponent));
  m.diffuse = Rgb(0.3f, 0.2f, 0.1f);
  m.specular = Rgb(0.2f, 0.4f, 0.5f);
  m.alphaU = exponent;
  return m;
}

// A quad of each material; their handles are those of the scene, wrapped ones and all.
struct Samples {
  Scene scene;
  std::vector<MaterialHandle> materials;
  void add(const Material& material) {
    materials.push_back(test::addMaterial(scene, material));
    test::addQuad(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, materials.back());
  }
  void addWrapped(MaterialType type, const Material& a, const Material& b) {
    Material wrapper = named(type, "wrapped " + a.name);
    wrapper.a = test::addMaterial(scene, a);
    wrapper.b = test::addMaterial(scene, b);
    wrapper.weight = 0.3f;
    wrapper.opacity = 0.5f;
    add(wrapper);
  }
};

Samples samples() {
  using Type = MaterialType;
  Samples s;
  s.add(phongMaterial(64));
  s.add(microfacets(Type::roughConductor, Distribution::beckmann, 0.2f));
  s.add(microfacets(Type::roughPlastic, Distribution::ggx, 0.1f));
  s.add(microfacets(Type::roughDielectric, Distribution::ggx, 0.2f));
  s.add(named(Type::plastic, "smooth plastic"));
  Material ward = named(Type::ward, "ward");
  ward.alphaU = ward.alphaV = 0.1f;
  ward.specular = Rgb(0.4f);
  s.add(ward);
  Material layered = named(Type::metallicRoughness, "layered");
  layered.roughness = 0.3f, layered.metallic = 0.4f;
  layered.sheenColor = Rgb(0.3f), layered.sheenRoughness = 0.4f;
  layered.clearcoat = 0.6f, layered.clearcoatRoughness = 0.1f;
  s.add(layered);
  s.addWrapped(Type::twoSided, phongMaterial(50), test::diffuseMaterial(Rgb(0.4f)));
  s.addWrapped(Type::blend, phongMaterial(100),
               microfacets(Type::roughConductor, Distribution::ggx, 0.5f));
  s.addWrapped(Type::mask, test::diffuseMaterial({0.7f, 0.5f, 0.2f}), {});
  return s;
}

const Samples& shared() {
  static const Samples s = samples();
  return s;
}
const ReflectionTables& sharedTables() {
  static const ReflectionTables tables(shared().scene);
  return tables;
}

Bsdf bsdfOf(size_t i, Vec3f wo) {
  const SurfacePoint point =
      surfacePoint(shared().scene, {0, 0.2f, 0.3f, static_cast<uint32_t>(i), 0});
  return makeBsdf(shared().scene, point, wo, 0);
}

constexpr uint32_t kManyPoints = 16384;

// Moments of all glossy lobes, by more points than tables have.
LobeMoments exactMoments(const Bsdf& glossy, Vec3f wo) {
  LobeMoments sum;
  for (int i = 0; i < glossy.lobeCount; ++i)
    sum.add(glossyMoments(glossy, glossy.lobes[i], wo, kManyPoints));
  return sum;
}

// Calls check(index, wo) for all materials and directions from both sides, azimuths at random.
template <class Check>
void forAll(const Check& check) {
  Rng random(3, 0);
  for (size_t i = 0; i < shared().materials.size(); ++i)
    for (const float cosine : {0.9999f, 0.985f, 0.8f, 0.5f, 0.15f, 0.04f, 0.008f, -0.6f, -0.05f}) {
      SCOPED_TRACE(shared().scene[shared().materials[i]].name + " " + std::to_string(cosine));
      const float phi = kTwoPi * random.next1D(), sine = std::sqrt(1 - cosine * cosine);
      check(i, Vec3f(sine * std::cos(phi), sine * std::sin(phi), cosine));
    }
}

TEST(ReflectionTables, HaveAlbedosAndMeanDirectionsOfTheBsdf) {
  forAll([](size_t i, Vec3f wo) {
    const Bsdf bsdf = bsdfOf(i, wo);
    const LobeMoments exact = exactMoments(glossyPart(bsdf), wo);
    const Rgb diffuse = diffuseAlbedo(bsdf, wo);
    Reflection r;
    if (!sharedTables().summary(shared().materials[i], {0, 0, 1}, wo, &r)) {
      EXPECT_EQ(maxComponent(diffuse + exact.albedo), 0);
      return;
    }
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(r.glossy[c], exact.albedo[c], 0.003f * exact.albedo[c]);
      EXPECT_NEAR(r.diffuse[c], diffuse[c], 0.003f * diffuse[c]);
    }
    EXPECT_EQ(r.n, Vec3f(0, 0, wo.z > 0 ? 1.f : -1.f));
    EXPECT_LT(length(r.mirror - Vec3f(-wo.x, -wo.y, wo.z)), 1e-6f);
    const float energy = luminance(exact.albedo);
    if (!(energy > 0)) return;
    const Vec3f mean = exact.first / energy;
    EXPECT_GT(dot(normalize(mean), normalize(r.r)), std::cos(0.1f * kPi / 180));
    EXPECT_NEAR(1 - length(r.r), 1 - length(mean), 0.01f * (1 - length(mean)));
  });
}

TEST(ReflectionTables, LobesAddUpToAlbedoAndMeanDirection) {
  forAll([](size_t i, Vec3f wo) {
    Reflection r, summary;
    if (!sharedTables().at(shared().materials[i], {0, 0, 1}, wo, &r)) return;
    ASSERT_TRUE(sharedTables().summary(shared().materials[i], {0, 0, 1}, wo, &summary));
    EXPECT_EQ(summary.r, r.r);
    EXPECT_EQ(r.count > 0, luminance(r.glossy) > 0);
    if (r.count == 0) return;
    Rgb sum{};
    Vec3f first{};
    for (const ReflectedLobe& lobe : std::span(r.lobes).first(static_cast<size_t>(r.count))) {
      EXPECT_NEAR(length(lobe.axis), 1, 1e-5f);
      sum += lobe.alpha;
      first += lobe.axis * (luminance(lobe.alpha) * lobes::meanResultant(lobe.kappa));
    }
    EXPECT_LT(length(sum - r.glossy), 1e-4f * length(sum));
    // Between elevations moments of lobes are not quite linear; coloured ones are not all alike.
    EXPECT_LT(length(first / luminance(sum) - r.r), 0.02f);
  });
}

// Relative L1 distance over the sphere.
double distance(const Bsdf& glossy, Vec3f wo, const Reflection& r) {
  static const GeodesicGrid grid(5);
  double sum = 0;
  for (size_t i = 0; i < grid.count(); ++i) {
    const Vec3f w = grid.directions()[i];
    float fit = 0;
    for (const ReflectedLobe& lobe : std::span(r.lobes).first(static_cast<size_t>(r.count)))
      fit += luminance(lobe.alpha) * lobes::vmfPdf(lobe.axis, lobe.kappa, w);
    sum += static_cast<double>(std::abs(luminance(evaluate(glossy, wo, w)) - fit) *
                               grid.solidAngles()[i]);
  }
  return sum / static_cast<double>(luminance(r.glossy));
}

TEST(ReflectionTables, LobesLookLikeTheBsdf) {
  struct Expected {
    size_t material;
    double at0, at30, at60, at75;
  };
  const Expected all[] = {{0, 0.015, 0.015, 0.03, 0.09},  // Phong 64
                          {1, 0.06, 0.05, 0.09, 0.22},    // Beckmann 0.2
                          {2, 0.05, 0.1, 0.23, 0.4},      // GGX 0.1
                          {5, 0.02, 0.04, 0.13, 0.37}};   // Ward 0.1
  for (const Expected& expected : all)
    for (const auto& [degrees, most] : {std::pair(0.f, expected.at0),
                                        {30.f, expected.at30},
                                        {60.f, expected.at60},
                                        {75.f, expected.at75}}) {
      SCOPED_TRACE(shared().scene[shared().materials[expected.material]].name + " " +
                   std::to_string(degrees));
      const float angle = degrees * kPi / 180;
      const Vec3f wo(std::sin(angle), 0, std::cos(angle));
      Reflection r;
      ASSERT_TRUE(sharedTables().at(shared().materials[expected.material], {0, 0, 1}, wo, &r));
      EXPECT_LT(distance(glossyPart(bsdfOf(expected.material, wo)), wo, r), most);
    }
}

TEST(ReflectionTables, AreTheSameForAnyNumberOfThreads) {
  Samples some;
  some.add(phongMaterial(64));
  some.add(microfacets(MaterialType::roughPlastic, Distribution::ggx, 0.1f));
  const ReflectionTables several(some.scene);
  const ThreadLimit limit(1);
  const ReflectionTables alone(some.scene);
  for (const MaterialHandle material : some.materials)
    for (const float cosine : {0.99f, 0.6f, 0.1f}) {
      const Vec3f wo(0, std::sqrt(1 - cosine * cosine), cosine);
      Reflection one, many;
      ASSERT_TRUE(alone.at(material, {0, 0, 1}, wo, &one));
      ASSERT_TRUE(several.at(material, {0, 0, 1}, wo, &many));
      EXPECT_EQ(one.r, many.r);
      ASSERT_EQ(one.count, many.count);
      for (size_t j = 0; j < static_cast<size_t>(one.count); ++j) {
        EXPECT_EQ(one.lobes[j].axis, many.lobes[j].axis);
        EXPECT_EQ(one.lobes[j].kappa, many.lobes[j].kappa);
      }
    }
}

TEST(ReflectionTables, OfMaterialsThatAreAlikeEverywhere) {
  Scene scene = test::boxScene(false);
  Material anisotropic = microfacets(MaterialType::roughConductor, Distribution::ggx, 0.1f);
  anisotropic.alphaV = 0.3f;
  Material bare = microfacets(MaterialType::roughConductor, Distribution::ggx, 0.1f);
  const MaterialHandle a = test::addMaterial(scene, anisotropic);
  const MaterialHandle unused = test::addMaterial(scene, bare);
  const MaterialHandle metal = test::addMaterial(scene, bare);
  scene.instances[test::floorWall].material = a;
  scene.instances[test::leftWall].material = metal;
  const ReflectionTables tables(scene);
  EXPECT_TRUE(tables.has(scene.instances[test::backWall].material));
  EXPECT_TRUE(tables.has(metal));
  EXPECT_FALSE(tables.has(a));
  EXPECT_FALSE(tables.has(unused));
  EXPECT_FALSE(tables.has({}));
  EXPECT_GE(tables.sharpest(metal), 74);  // .74 / alpha^2: the narrower lobe at the normal
  EXPECT_LT(tables.sharpest(metal), 400);
  EXPECT_GT(tables.sharpest(a), 20) << "it has no table";
  EXPECT_LT(tables.sharpest(a), 400);
  EXPECT_EQ(tables.sharpest(unused), 0);
  EXPECT_EQ(tables.sharpest({}), 0);
  for (Instance& instance : scene.instances) instance.material = {0};
  EXPECT_EQ(ReflectionTables(scene).sharpest({0}), 0) << "it is diffuse";
}

TEST(ReflectionTables, OneSidedMaterialsReflectInFrontAlone) {
  Reflection r;
  const MaterialHandle phong = shared().materials[0], both = shared().materials[7];
  const Vec3f n = normalize(Vec3f(1, 2, -0.5f)), t = frameFromNormal(n).s;
  EXPECT_TRUE(sharedTables().at(phong, n, normalize(n + t), &r));
  EXPECT_GT(dot(r.lobes[0].axis, normalize(n - t)), 0.999f);
  EXPECT_FALSE(sharedTables().at(phong, n, normalize(t - n), &r));
  EXPECT_FALSE(sharedTables().summary(phong, n, normalize(t - n), &r));
  ASSERT_TRUE(sharedTables().at(both, n, normalize(t - n), &r));  // its back is diffuse
  EXPECT_EQ(r.count, 0);
  EXPECT_NEAR(r.diffuse.x, 0.4f, 1e-6f);
  EXPECT_EQ(r.n, -n);
}

// Sum of the lobes' densities times their alphas.
float density(const Reflection& r, Vec3f d) {
  float sum = 0;
  for (size_t i = 0; i < static_cast<size_t>(r.count); ++i)
    sum += luminance(r.lobes[i].alpha) * lobes::vmfPdf(r.lobes[i].axis, r.lobes[i].kappa, d);
  return sum;
}

TEST(ReflectionTables, OfAnisotropicMaterialsAreByAzimuthToo) {
  Scene scene;
  Material brushed = microfacets(MaterialType::roughConductor, Distribution::ggx, 0.3f);
  brushed.alphaU = 0.08f;
  Material wrapped = named(MaterialType::twoSided, "both sides");
  wrapped.a = test::addMaterial(scene, brushed);
  for (const MaterialHandle m : {wrapped.a, test::addMaterial(scene, wrapped)})
    test::addQuad(scene, {0, 0, 0}, {1, 0.3f, 0}, {-0.2f, 0.5f, 0.7f}, m);
  const ReflectionTables tables(scene);
  Rng rng(6);
  for (int i = 0; i < 60; ++i) {
    const auto instance = static_cast<uint32_t>(i % 2);
    ASSERT_FALSE(tables.has(scene.instances[instance].material));
    const SurfacePoint at = surfacePoint(scene, {0, 0.2f, 0.3f, instance, 0});
    const Vec2f u = rng.next2D();
    const float cosine = (0.1f + 0.9f * u.x) * (i % 4 == 1 ? -1.f : 1.f);
    const float sine = std::sqrt(1 - cosine * cosine), phi = kTwoPi * u.y;
    const Vec3f wo = at.frame.toWorld({sine * std::cos(phi), sine * std::sin(phi), cosine});
    const Bsdf bsdf = makeBsdf(scene, at, wo, 0);
    const LobeMoments exact = exactMoments(glossyPart(bsdf), wo);
    const Reflection found = tables.reflection(scene, at, wo);
    Reflection wanted = reflectionOf(bsdf, wo);
    const Reflection summary = tables.summary(scene, at, wo);
    SCOPED_TRACE(std::to_string(cosine) + " " + std::to_string(phi));
    EXPECT_EQ(summary.glossy, found.glossy);
    EXPECT_EQ(summary.r, found.r);
    EXPECT_LT(length(found.mirror - wanted.mirror), 1e-5f);
    EXPECT_LT(length(found.n - wanted.n), 1e-5f);
    const float energy = luminance(exact.albedo);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(found.glossy[c], exact.albedo[c], 0.01f * exact.albedo[c]);
    EXPECT_LT(length(found.r - exact.first / energy), 0.01f);
    // The row of lobes, where it is highest: within the noise of the tables' points.
    const Bsdf glossy = glossyPart(bsdf);
    wanted.count = reflectedLobes(glossy, glossy.lobes[0], wo, exact, wanted.lobes, kManyPoints);
    ASSERT_EQ(found.count, wanted.count);
    float apart = 0;
    for (size_t j = 0; j < static_cast<size_t>(wanted.count); ++j) {
      const Vec3f d = wanted.lobes[j].axis;
      apart += std::abs(density(found, d) / density(wanted, d) - 1);
    }
    EXPECT_LT(apart / static_cast<float>(wanted.count), 0.12f);
  }
}

}  // namespace
}  // namespace lobelia::transfer
