// Virtual spherical Gaussian lights against the point lights that they stand for.
#include <gtest/gtest.h>

#include <optional>

#include "gather/random_input.h"
#include "lobelia/gather/depth_maps.h"
#include "lobelia/gather/gaussian.h"
#include "lobelia/lights/cluster_sums.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

using namespace test;

// Points of a patch in the plane z = 0 that shines upwards, normally distributed with deviation 1.
struct PatchSettings {
  int count = 20000;
  float diffuse = 1, glossy = 0;
  Vec3f axis{0, 0, 1};
  float sharpness = 50;
  float curvature = 0;  // of the surface: normals turn by so much over a distance of 1
};

std::vector<LightPoint> patch(const PatchSettings& settings) {
  std::vector<LightPoint> points;
  for (int i = 0; i < settings.count; ++i) {  // along a spiral, evenly
    const double u = (i + 0.5) / settings.count, turn = i * 0.6180339887498949;
    const float r = static_cast<float>(std::sqrt(-2 * std::log(1 - u)));
    const float phi = kTwoPi * static_cast<float>(turn - std::floor(turn));
    LightPoint point;
    point.p = {r * std::cos(phi), r * std::sin(phi), 0};
    point.n = normalize(Vec3f{settings.curvature * point.p.x, settings.curvature * point.p.y, 1});
    const float share = 1 / static_cast<float>(settings.count);
    point.diffuse = Rgb(1.f, 0.8f, 0.6f) * (settings.diffuse * share);
    point.glossy = Rgb(0.9f, 1.f, 0.7f) * (settings.glossy * share);
    point.axis = normalize(settings.axis + Vec3f{point.n.x, point.n.y, 0});
    point.sharpness = settings.sharpness;
    point.depth = 1;
    points.push_back(point);
  }
  return points;
}

VirtualLights clustered(const std::vector<LightPoint>& points, const GaussianShading& shading) {
  Clusters one;
  for (uint32_t i = 0; i < points.size(); ++i) one.order.push_back(i);
  one.ends = {static_cast<uint32_t>(points.size())};
  VirtualLights lights;
  lights.gaussian = clusterLights(points, one, shading.toksvig, 1);
  lights.gaussianDepthEnds = {0, 1};
  lights.gaussianShading = shading;
  return lights;
}

VirtualLights pointLights(const std::vector<LightPoint>& points) {
  VirtualLights lights;
  addPointLights(points, &lights);
  return lights;
}

// One receiver at p, whose normal and view are along n.
Receivers receiver(Vec3f p, Vec3f n, const Lobe& lobe, Vec3f wo) {
  Receivers receivers;
  ReceiverPoint point;
  point.p = p;
  point.ng = n;
  point.frame = frameFromNormal(n);
  point.wo = wo;
  point.weight = Rgb(1.f);
  point.lobeCount = 1;
  receivers.points.push_back(point);
  receivers.lobes.push_back(lobe);
  return receivers;
}

Lobe phong(float exponent) {
  Lobe lobe;
  lobe.type = LobeType::phong;
  lobe.alphaX = exponent;
  return lobe;
}

class GaussianLightGather : public ::testing::Test {
 protected:
  Rgb gathered(const Receivers& receivers, const VirtualLights& lights) {
    Rgb value;
    gatherAll(tracer_, receivers, lights, settings_, std::span(&value, 1), context_);
    return value;
  }
  // Largest relative difference of the channels.
  float difference(const Receivers& receivers, const std::vector<LightPoint>& points,
                   const GaussianShading& shading) {
    const Rgb all = gathered(receivers, pointLights(points));
    const Rgb one = gathered(receivers, clustered(points, shading));
    float most = 0;
    for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(one[c] / all[c] - 1));
    return most;
  }

  const Scene scene_ = [] {  // nothing in the way
    Scene scene = randomTriangles(1, 3);
    for (Vec3f& p : scene.meshes[0].positions) p = p * 0.01f + Vec3f(0, 0, -1e4f);
    return scene;
  }();
  Context context_;
  const Tracer tracer_{scene_, context_};
  GatherSettings settings_;
};

Vec3f slanted(float degrees) {
  const float t = degrees * kPi / 180;
  return {std::sin(t), 0, std::cos(t)};
}

TEST_F(GaussianLightGather, FarAwayItIsItsPoints) {
  GaussianShading shading;
  shading.spread = 1;
  for (const PatchSettings& settings :
       {PatchSettings{}, PatchSettings{.curvature = 0.2f},
        PatchSettings{.diffuse = 0.3f, .glossy = 1, .axis = normalize(Vec3f{0.2f, 0, 1})},
        PatchSettings{.diffuse = 0, .glossy = 1, .sharpness = 8, .curvature = 0.05f}}) {
    const std::vector<LightPoint> points = patch(settings);
    for (const float degrees : {0.f, 20.f, 50.f}) {
      const Vec3f d = slanted(degrees);
      const Receivers diffuse = receiver(d * 200.f, -d, Lobe{}, -d);
      const Receivers glossy = receiver(d * 200.f, -d, phong(60), -d);
      // In the far tail of a glossy lobe the merged Gaussian is no longer that of the points.
      const float within = settings.glossy > 0 && degrees > 30 ? 0.06f : 0.01f;
      EXPECT_LT(difference(diffuse, points, shading), within) << degrees;
      EXPECT_LT(difference(glossy, points, shading), within) << degrees;
    }
  }
}

// The nearest are half a standard deviation away.
TEST_F(GaussianLightGather, NearByItIsItsPoints) {
  const std::vector<LightPoint> points = patch({.count = 200000});
  GaussianShading shading;
  shading.spread = 1;
  for (const float distance : {0.5f, 1.f, 2.f, 4.f, 8.f, 16.f}) {
    const Vec3f p{0, 0, distance}, down{0, 0, -1};
    EXPECT_LT(difference(receiver(p, down, phong(99), down), points, shading), 0.05f) << distance;
  }
  // Seen at 60 degrees, by its covariance: by half of its trace a fifth of the light were lost.
  for (const auto& [distance, within] :
       {std::pair{4.f, 0.12f}, std::pair{8.f, 0.06f}, std::pair{16.f, 0.03f}}) {
    const Vec3f d = slanted(60);
    const Receivers slantwise = receiver(d * distance, -d, phong(99), -d);
    EXPECT_LT(difference(slantwise, points, shading), within) << distance;
  }
  shading.projected = false;
  const Vec3f d = slanted(60);
  EXPECT_GT(difference(receiver(d * 4.f, -d, phong(99), -d), points, shading), 0.2f);
}

TEST_F(GaussianLightGather, IsFiniteWhereverTheReceiverIs) {
  const std::vector<LightPoint> points = patch({.count = 100, .glossy = 1});
  for (const auto form : {GaussianShading::Form::accurate, GaussianShading::Form::product,
                          GaussianShading::Form::pulled}) {
    GaussianShading shading;
    shading.form = form;
    const VirtualLights lights = clustered(points, shading);
    for (const float distance : {0.f, 1e-6f, 1e-3f, 1.f, 1e3f, 1e6f}) {
      const Receivers r = receiver(lights.gaussian[0].mean + Vec3f{0, 0, distance}, {0, 0, -1},
                                   phong(99), {0, 0, -1});
      const Rgb value = gathered(r, lights);
      EXPECT_TRUE(isFinite(value));
      // No more than radiance at the middle of the patch over a hemisphere: no spike.
      EXPECT_LT(maxComponent(value), 30.f) << distance;
    }
  }
  EXPECT_EQ(context_.statistics.count("nonfinite"), 0);
}

TEST_F(GaussianLightGather, OneSidedLightsSendNothingBehind) {
  const std::vector<LightPoint> points = patch({});
  const Vec3f p{0, 0, -3}, up{0, 0, 1};
  EXPECT_EQ(gathered(receiver(p, up, Lobe{}, up), clustered(points, {})), Rgb{});
}

// ---- The paper's forms, against its formulas
// -----------------------------------------------------

Rgb paperDiffuse(const GaussianLight& light, Vec3f p, Vec3f n, float spread, bool pulled) {
  const float trace = light.covariance[0] + light.covariance[1] + light.covariance[2];
  const float variance = 0.5f * spread * trace;
  const Vec3f d = light.mean - p;
  const float mean = 2 / 3.f * lobes::meanResultant(light.normalSharpness);
  const float sharpness = lobes::inverseMeanResultant(mean);
  const lobes::SphericalGaussian place{normalize(d), lengthSquared(d) / variance, 1};
  const lobes::SphericalGaussian leaving{-light.normal, sharpness, 1};
  const lobes::SphericalGaussian in = lobes::product(place, leaving);
  const float c = in.amplitude / (lobes::integral(sharpness) * kTwoPi * variance);
  const float value = pulled ? 2 * c / in.sharpness * std::max(0.f, dot(in.axis, n))
                             : c * lobes::productIntegral({in.axis, in.sharpness, 1},
                                                          {n, 2, 1 / lobes::integral(2)});
  return light.diffuse * value;
}

TEST_F(GaussianLightGather, DiffuseReceiversAsInThePaper) {
  const std::vector<LightPoint> points = patch({.curvature = 0.1f});
  for (const bool pulled : {false, true}) {
    GaussianShading shading;
    shading.form = pulled ? GaussianShading::Form::pulled : GaussianShading::Form::product;
    shading.projected = false;
    const VirtualLights lights = clustered(points, shading);
    for (const float distance : {2.f, 5.f, 30.f}) {
      const Vec3f p = slanted(35) * distance, n = normalize(Vec3f{-0.2f, 0.3f, -1});
      const Rgb value = gathered(receiver(p, n, Lobe{}, n), lights);
      const Rgb expected = paperDiffuse(lights.gaussian[0], p, n, shading.spread, pulled);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], 2e-4f * expected[c]);
    }
  }
}

TEST_F(GaussianLightGather, MicrofacetsAsInThePaperComeNear) {
  const std::vector<LightPoint> points = patch({});
  GaussianShading shading;
  shading.form = GaussianShading::Form::pulled;
  shading.spread = 1;
  shading.toksvig = true;  // with exact means a diffuse lobe is half as bright again along its axis
  Lobe lobe;
  lobe.type = LobeType::microfacetReflection;
  lobe.distribution = Distribution::beckmann;
  lobe.alphaX = lobe.alphaY = 0.2f;
  for (const float degrees : {0.f, 30.f, 60.f}) {
    const Vec3f down{0, 0, -1}, p{0, 0, 6};
    const Vec3f n = -slanted(degrees), wo = 2 * dot(down, n) * n - down;
    EXPECT_LT(difference(receiver(p, n, lobe, wo), points, shading), 0.2f) << degrees;
  }
}

// ---- Shadows
// -------------------------------------------------------------------------------------

// Small lights at random places.
VirtualLights scatteredLights(int count, uint64_t seed) {
  Rng rng(seed);
  VirtualLights lights;
  for (int i = 0; i < count; ++i) {
    LightPoint point;
    point.p = randomPoint(&rng, 1.f);
    point.n = randomDirection(&rng);
    point.diffuse = randomColor(&rng);
    point.glossy = randomColor(&rng);
    point.axis = point.n;
    point.sharpness = 20;
    const uint32_t first = 0;
    lights.gaussian.push_back(clusterLight(std::span(&point, 1), std::span(&first, 1), false, 1));
    for (int k = 0; k < 3; ++k) lights.gaussian.back().covariance[k] = 0.003f;
  }
  lights.gaussianDepthEnds = {static_cast<uint32_t>(lights.gaussian.size())};
  return lights;
}

TEST(GaussianShadows, FewRaysPerReceiverGiveTheSameMean) {
  const Scene scene = randomTriangles(120, 7);
  Context context;
  const Tracer tracer(scene, context);
  VirtualLights lights = scatteredLights(300, 9);
  const Receivers receivers = randomReceivers(
      200, {LobeType::lambert, LobeType::phong, LobeType::microfacetReflection}, 2, 4);
  GatherSettings settings;
  settings.direct = true;
  const auto gathered = [&](int rays, uint64_t seed) {
    settings.shadowRays = rays;
    lights.seed = seed;
    std::vector<Rgb> values(receivers.points.size());
    gatherAll(tracer, receivers, lights, settings, values, context);
    return values;
  };
  const std::vector<Rgb> all = gathered(-1, 0), none = gathered(0, 0);
  constexpr int kRuns = 128;
  std::vector<double> sum(all.size()), square(all.size());
  for (int run = 0; run < kRuns; ++run) {
    const std::vector<Rgb> some = gathered(8, static_cast<uint64_t>(run));
    for (size_t i = 0; i < all.size(); ++i) {
      const double v = static_cast<double>(luminance(some[i]));
      sum[i] += v / kRuns, square[i] += v * v / kRuns;
    }
  }
  size_t darker = 0, beyond = 0, lit = 0;
  double mean = 0, whole = 0;
  for (size_t i = 0; i < all.size(); ++i) {
    const double truth = static_cast<double>(luminance(all[i]));
    const double error = std::sqrt(std::max(square[i] - sum[i] * sum[i], 0.0) / (kRuns - 1));
    if (truth > 0) ++lit;
    mean += sum[i], whole += truth;
    if (luminance(none[i]) > 1.01f * luminance(all[i])) ++darker;
    if (std::abs(sum[i] - truth) > 4 * error + 1e-5 * truth) ++beyond;
  }
  EXPECT_NEAR(mean, whole, 0.01 * whole);
  EXPECT_GT(darker, 100u);
  EXPECT_GT(lit, 150u);
  EXPECT_LE(beyond, 3u);
}

// ||a - b|| / ||b|| of luminances.
double relativeDistance(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
  double square = 0, whole = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double l = static_cast<double>(luminance(b[i]));
    const double d = static_cast<double>(luminance(a[i])) - l;
    square += d * d, whole += l * l;
  }
  return std::sqrt(square / whole);
}

// texels: of shadow maps, 0: none; rays: GatherSettings::shadowRays.
std::vector<Rgb> gatheredByMaps(const Tracer& tracer, const Receivers& receivers,
                                const VirtualLights& lights, int texels, int rays) {
  Context context;
  std::optional<gather::DepthMaps> maps;
  if (texels > 0) maps.emplace(tracer, lights, texels, context);
  GatherSettings settings;
  settings.direct = true;
  settings.depthMaps = maps ? &*maps : nullptr;
  settings.shadowRays = rays;
  std::vector<Rgb> values(receivers.points.size());
  gatherAll(tracer, receivers, lights, settings, values, context);
  return values;
}

TEST(GaussianShadows, MapsComeToRaysWithTheirTexels) {
  const Scene scene = randomTriangles(120, 7);
  Context context;
  const Tracer tracer(scene, context);
  const VirtualLights lights = scatteredLights(40, 9);
  const Receivers receivers = randomReceivers(400, {LobeType::lambert, LobeType::phong}, 2, 4);
  const auto gathered = [&](int texels, int rays) {
    return gatheredByMaps(tracer, receivers, lights, texels, rays);
  };
  const std::vector<Rgb> byRays = gathered(0, -1);
  EXPECT_GT(relativeDistance(gathered(0, 0), byRays), 0.1);  // there are shadows
  const double coarse = relativeDistance(gathered(16, -1), byRays);
  const double fine = relativeDistance(gathered(512, -1), byRays);
  EXPECT_GT(coarse, 0.01);
  EXPECT_LT(coarse, 0.4);
  EXPECT_LT(fine, 0.03);
}

// Whatever the angle: on a floor that nothing else is above, all that faces a light is lit.
TEST(GaussianShadows, MapsDoNotShadowTheFloorThatTheyShow) {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(mesh);
  scene.materials.emplace_back();
  Instance instance;
  instance.mesh = MeshHandle{0}, instance.material = MaterialHandle{0};
  scene.instances.push_back(instance);
  Context context;
  const Tracer tracer(scene, context);
  VirtualLights lights = scatteredLights(20, 3);
  for (GaussianLight& light : lights.gaussian) {
    light.mean.z = light.places[0].p.z = 0.05f + std::abs(light.mean.z);
    for (GaussianLight::Place& place : light.places) place = light.places[0];
  }
  Receivers receivers = randomReceivers(400, {LobeType::lambert}, 1, 4);
  for (ReceiverPoint& r : receivers.points) {
    r.p = Vec3f{20 * r.p.x, 20 * r.p.y, 0};
    r.frame = frameFromNormal({0, 0, 1});
    r.ng = {0, 0, 1};
  }
  const auto gathered = [&](int texels, int rays) {
    return gatheredByMaps(tracer, receivers, lights, texels, rays);
  };
  const std::vector<Rgb> unshadowed = gathered(0, 0);
  for (const int texels : {8, 64, 100}) {
    const std::vector<Rgb> maps = gathered(texels, -1);
    for (size_t i = 0; i < maps.size(); ++i)
      EXPECT_EQ(luminance(maps[i]), luminance(unshadowed[i])) << texels << " " << i;
  }
}

}  // namespace
}  // namespace lobelia
