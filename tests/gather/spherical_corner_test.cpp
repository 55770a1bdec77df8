// Corner darkening (methods.md 4.3; Hasan09 figure 4): a wall over a floor that shines evenly.
#include "gather/spherical_setup.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lights/spherical_coverage.h"
#include "lobelia/lights/spherical_radius.h"

namespace lobelia {
namespace {

using namespace test;

constexpr int kColumns = 64, kRows = 32;
// So that the tenth neighbour is 0.22 away: density 10 / (pi 0.22^2).
const float kSide = std::sqrt(kColumns * kRows * kPi * 0.22f * 0.22f / 10);

// The floor is [-side/2, side/2] x [0, side], the wall stands at y = 0.
class Corner : public testing::Test {
 protected:
  Corner() : scene_(makeScene()), tracer_(scene_, context_) {
    Rng random(1);
    lights_.model = "vsl";
    lights_.specularLimit = 0.01f;
    for (int i = 0; i < kColumns; ++i) {
      for (int j = 0; j < kRows; ++j) {
        SphericalLight light{};
        const float u = (static_cast<float>(i) + random.next1D()) / kColumns,
                    v = (static_cast<float>(j) + random.next1D()) / kRows;
        light.p = {(u - 0.5f) * kSide, v * kSide, 0};
        light.power = Rgb(kSide * kSide / (kColumns * kRows));  // irradiance 1
        light.arriving = encodeOctahedral({0, 0, 1});
        // Barycentrics in the quad's triangles (0,0) (1,0) (1,1) and (0,0) (1,1) (0,1).
        light.triangle = u >= v ? 0 : 1;
        light.b1 = u >= v ? u - v : u, light.b2 = u >= v ? v : v - u;
        light.depth = 1;
        lights_.spherical.push_back(light);
      }
    }
    lights_.sphericalDepthEnds = {0, static_cast<uint32_t>(lights_.spherical.size())};
  }

  Scene makeScene() {
    Scene scene;
    const MaterialHandle white = addMaterial(scene, diffuseMaterial(Rgb(1.f)));
    addQuad(scene, {-kSide / 2, 0, 0}, {kSide, 0, 0}, {0, kSide, 0}, white);
    addQuad(scene, {-kSide / 2, 0, 0}, {0, 0, kSide}, {kSide, 0, 0}, white);
    return scene;
  }

  // Irradiance on the wall, a point 1 cm wide averaged over, relative to the floor's form factor.
  double relative(float height, float radiusFactor, SphereShading::Indicator indicator) {
    LightSettings settings;
    settings.radiusFactor = radiusFactor;
    lights_.sphereShading.indicator = indicator;
    chooseRadii(tracer_, settings, &lights_, context_);
    coverSurfaces(tracer_, &lights_, context_);
    Bsdf bsdf;
    bsdf.add(Lobe{});
    Receivers receivers;
    Rng random(2);
    for (int i = 0; i < 512; ++i) {  // along the wall: not at one light's mercy
      const float x = (random.next1D() - 0.5f) * kSide * 0.5f;
      const Receivers one = LitFloor::receivers(Vec3f(x, 0, height) - Vec3f(LitFloor::kMiddle),
                                                {0, 1, 0}, {0, 1, 0.5f}, bsdf, 1);
      receivers.points.push_back(one.points[0]);
      receivers.points.back().pixel = static_cast<uint32_t>(i);
      receivers.points.back().error = 1e-6f;
      receivers.lobes = one.lobes;
    }
    std::vector<Rgb> radiance(receivers.points.size());
    gatherAll(tracer_, receivers, lights_, {}, radiance, context_);
    double sum = 0, truth = 0;
    for (size_t i = 0; i < radiance.size(); ++i) {
      sum += static_cast<double>(radiance[i].x) * static_cast<double>(kPi);
      truth += irradiance(receivers.points[i].p, height);
    }
    return sum / truth;
  }

  // By cosine-weighted directions, stratified.
  double irradiance(Vec3f p, float height) const {
    int hits = 0;
    constexpr int kSteps = 64;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const Vec3f w = sampleHemisphereCosine(
            {(static_cast<float>(i) + 0.5f) / kSteps, (static_cast<float>(j) + 0.5f) / kSteps});
        const Vec3f d(w.x, w.z, w.y);  // about +y
        if (d.z >= 0) continue;
        const Vec3f q = p + d * (height / -d.z);
        hits += std::abs(q.x) < kSide / 2 && q.y < kSide ? 1 : 0;
      }
    return static_cast<double>(hits) / (kSteps * kSteps);  // radiance 1/pi, irradiance hits
  }

  Context context_;
  Scene scene_;
  Tracer tracer_;
  VirtualLights lights_;
};

TEST_F(Corner, PlanarIndicatorKeepsCornersLit) {
  using enum SphereShading::Indicator;
  EXPECT_NEAR(relative(0.02f, 1, planar), 0.92, 0.06);
  EXPECT_NEAR(relative(0.1f, 1, planar), 1, 0.04);
  EXPECT_NEAR(relative(0.3f, 1, planar), 1, 0.03);
  EXPECT_NEAR(relative(1, 1, planar), 1, 0.02);
}

// Whatever part of a disc lies on the surface, it carries the whole power, seen from wherever.
TEST_F(Corner, MissingPartsOfDiscsLoseAndAddNoPower) {
  LightSettings settings;
  settings.radiusFactor = 2;
  chooseRadii(tracer_, settings, &lights_, context_);
  coverSurfaces(tracer_, &lights_, context_);
  Rng random(4);
  size_t partial = 0;
  for (SphericalLight light : lights_.spherical) {
    partial += (light.coverage[0] & light.coverage[1]) != ~0u;
    for (const bool invented : {false, true}) {
      if (invented) {  // any other shape, too
        light.coverage[0] = random.nextUint() & random.nextUint();
        light.coverage[1] = random.nextUint() | 0x18;
      }
      const auto weights = cellWeights(light);
      constexpr int kSteps = 32 * kDiscCells;
      double sum = 0, area = 0;
      for (int i = 0; i < kSteps * kSteps; ++i) {
        const float x = (static_cast<float>(i % kSteps) + 0.5f) * 2 / kSteps - 1,
                    y = (static_cast<float>(i / kSteps) + 0.5f) * 2 / kSteps - 1;
        if (x * x + y * y > 1) continue;
        area += 1;
        sum += static_cast<double>(
            weights[static_cast<size_t>(i / kSteps / 32 * kDiscCells + i % kSteps / 32)]);
      }
      ASSERT_NEAR(sum / area, 1, 0.01);
    }
  }
  EXPECT_GT(partial, lights_.spherical.size() / 20);
}

// The paper's indicator darkens them: the test above would notice.
TEST_F(Corner, CosineIndicatorDarkensThem) {
  EXPECT_LT(relative(0.02f, 1, SphereShading::Indicator::cosine), 0.65);
}

// Without a factor: twice that distance; of many sets less near the wall, where light changes
// quickly.
TEST_F(Corner, AutomaticRadiusIsSmallerInCreases) {
  const std::vector<float> distances = tenthNeighbourDistances(tracer_, lights_.spherical);
  chooseRadii(tracer_, {}, &lights_, context_);
  for (size_t i = 0; i < distances.size(); ++i)
    EXPECT_EQ(lights_.spherical[i].radius, 2 * distances[i]) << "of one set";
  LightSettings settings;
  settings.sets = 16;
  chooseRadii(tracer_, settings, &lights_, context_);
  size_t open = 0, crease = 0;
  for (size_t i = 0; i < distances.size(); ++i) {
    const SphericalLight& light = lights_.spherical[i];
    const float over = light.radius / distances[i];
    EXPECT_LE(over, 2.0001f);
    EXPECT_GE(over, 0.7999f);
    if (light.p.y > 8 * distances[i]) open += over > 1.9999f;
    if (light.p.y < distances[i]) crease += over < 1.9f;
  }
  EXPECT_GT(open, lights_.spherical.size() / 4);
  EXPECT_GT(crease, 10u);
  EXPECT_EQ(context_.statistics.count("path_rays"), 16 * lights_.spherical.size());
}

// A light without any neighbour, and lights at one place, shine from some area, too.
TEST_F(Corner, LonelyLightsHaveARadius) {
  const SphericalLight light = lights_.spherical[0];
  for (const size_t count : {1, 2, 20}) {
    lights_.spherical.assign(count, light);
    lights_.sphericalDepthEnds = {0, static_cast<uint32_t>(count)};
    chooseRadii(tracer_, {}, &lights_, context_);
    const float size = tracer_.bounds().radius();
    for (const SphericalLight& l : lights_.spherical) {
      EXPECT_GT(l.radius, 1e-6f * size) << count;
      EXPECT_LT(l.radius, size) << count;
    }
  }
}

TEST_F(Corner, RadiusIsTheTenthNeighboursDistance) {
  const std::vector<float> distances = tenthNeighbourDistances(tracer_, lights_.spherical);
  double mean = 0;
  for (size_t i = 0; i < distances.size(); i += 37) {
    std::vector<float> all;
    for (const SphericalLight& other : lights_.spherical)
      all.push_back(length(other.p - lights_.spherical[i].p));
    std::nth_element(all.begin(), all.begin() + 10, all.end());  // the first is itself
    EXPECT_NEAR(distances[i], all[10], 1e-5f);
  }
  for (const float d : distances)
    mean += static_cast<double>(d) / static_cast<double>(distances.size());
  EXPECT_NEAR(mean, 0.22, 0.03);
}

}  // namespace
}  // namespace lobelia
