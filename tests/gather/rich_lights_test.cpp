// Rich-VPLs: what they send out against the lights that they stand for, and what receivers gather
// against the sum over all lights.
#include "lobelia/gather/rich_lights.h"

#include "gather/lit_corner.h"
#include "gather/strategy_test.h"
#include "lobelia/base/error.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;

// Particles of a place: lobes about its normal n, at surfaces turned by up to `turn`.
struct Particles {
  Vec3f n;
  Rgb cosine;
  std::vector<RichLobe> lobes;
  std::vector<Vec3f> normals;

  Particles(size_t count, float turn, float maxSharpness, uint64_t seed) {
    Rng rng(seed);
    n = randomDirection(&rng);
    cosine = randomColor(&rng) * 0.5f;
    for (size_t i = 0; i < count; ++i) {
      normals.push_back(normalize(n + randomDirection(&rng) * turn));
      const Vec3f axis = normalize(normals.back() + randomDirection(&rng) * 0.9f);
      lobes.push_back({axis, std::pow(maxSharpness, rng.next1D()), randomColor(&rng)});
    }
  }
  void setIn(RichRadiance* radiance) const { radiance->set(0, n, cosine, lobes, normals, 0); }
  Rgb intensity(Vec3f w) const {
    Rgb sum = cosine * std::max(dot(n, w), 0.f);
    for (size_t i = 0; i < lobes.size(); ++i)
      if (dot(normals[i], w) > 0)
        sum += lobes[i].amplitude * lobes::gaussian(lobes[i].axis, lobes[i].sharpness, w);
    return sum;
  }
};

// Integral over directions above the surface, by even directions: spacing sqrt(2 pi / count).
template <class F>
Rgb overHemisphere(Vec3f n, const F& intensity, size_t count = 200'000) {
  const Frame frame = frameFromNormal(n);
  Vec3d sum;
  for (size_t i = 0; i < count; ++i) {
    const float z = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
    const float phi = kTwoPi * static_cast<float>(std::fmod(0.6180339887498949 * double(i), 1.0));
    const float r = std::sqrt(1 - z * z);
    const Rgb v = intensity(frame.toWorld({r * std::cos(phi), r * std::sin(phi), z}));
    sum += Vec3d{double{v.x}, double{v.y}, double{v.z}};
  }
  const double each = 2 * double{kPi} / static_cast<double>(count);
  return {static_cast<float>(sum.x * each), static_cast<float>(sum.y * each),
          static_cast<float>(sum.z * each)};
}

void expectNear(Rgb value, Rgb expected, float relative) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], relative * expected[c]) << c;
}

struct Shape {
  RichForm form;
  int texels, lobes;
};
constexpr Shape kShapes[] = {
    {RichForm::cube, 4, 1}, {RichForm::cube, 16, 1}, {RichForm::vmf, 4, 1}, {RichForm::vmf, 4, 8}};

// The power that all particles send above their surfaces is that of the place, by its own account
// and by the integral over its directions.
TEST(RichRadiance, PowerIsThatOfTheParticles) {
  for (const Shape& shape : kShapes) {
    for (const float turn : {0.f, 0.3f}) {
      SCOPED_TRACE(testing::Message() << int(shape.form) << " " << shape.texels << " "
                                      << shape.lobes << " turned by " << turn);
      const Particles particles(40, turn, 200, 7);
      RichRadiance radiance(shape.form, 1, shape.texels, shape.lobes);
      particles.setIn(&radiance);
      Rgb expected = particles.cosine * kPi;
      for (size_t i = 0; i < 40; ++i) {
        const RichLobe& lobe = particles.lobes[i];
        const double cosine = double{dot(particles.normals[i], lobe.axis)};
        expected += lobe.amplitude * static_cast<float>(lobes::hemisphereIntegralExact(
                                         cosine, double{lobe.sharpness}, 0));
      }
      expectNear(radiance.power(0), expected, 0.004f);
      const Rgb integral =
          overHemisphere(particles.n, [&](Vec3f w) { return radiance.intensity(0, w); });
      expectNear(integral, expected, 0.008f);
    }
  }
}

// Directions, not only powers: errors fall with texels and with lobes.
TEST(RichRadiance, FinerDirectionsComeNearerToTheParticles) {
  const Particles particles(40, 0, 60, 3);
  const auto error = [&](const Shape& shape) {
    RichRadiance radiance(shape.form, 1, shape.texels, shape.lobes);
    particles.setIn(&radiance);
    const auto squares = [&](const auto& f) {
      const Rgb sum = overHemisphere(particles.n, [&](Vec3f w) {
        const Rgb value = f(w);
        return value * value;
      });
      return sum.x + sum.y + sum.z;
    };
    return std::sqrt(
        squares([&](Vec3f w) { return radiance.intensity(0, w) - particles.intensity(w); }) /
        squares([&](Vec3f w) { return particles.intensity(w); }));
  };
  const float cube8 = error({RichForm::cube, 8, 1}), cube32 = error({RichForm::cube, 32, 1});
  const float one = error({RichForm::vmf, 4, 1}), eight = error({RichForm::vmf, 4, 8});
  EXPECT_LT(cube32, 0.25f * cube8);
  EXPECT_LT(cube32, 0.02f);
  EXPECT_LT(eight, 0.6f * one);
  EXPECT_LT(error({RichForm::vmf, 4, 40}), 1e-4f) << "as many lobes as particles";
}

TEST(RichRadiance, OnlyDiffuseLightIsACosineLobe) {
  for (const Shape& shape : kShapes) {
    RichRadiance radiance(shape.form, 1, shape.texels, shape.lobes);
    radiance.set(0, {0, 0, 1}, {1, 2, 3}, {}, {}, 0);
    EXPECT_EQ(radiance.light(0).peak, 3);
    expectNear(radiance.intensity(0, {0.6f, 0, 0.8f}), {0.8f, 1.6f, 2.4f}, 1e-6f);
    EXPECT_EQ(radiance.intensity(0, {0.6f, 0, -0.8f}), Rgb{});
  }
}

// A lobe that leaves its own surface but hardly the place's keeps its power and a direction near.
TEST(RichRadiance, LobesBelowTheSurfaceAreLifted) {
  const Vec3f n{0, 0, 1}, own = normalize(Vec3f{1, 0, 0.2f}), axis = normalize(Vec3f{1, 0, -0.4f});
  const RichLobe lobe{axis, 60, Rgb(1.f)};
  for (const Shape& shape : {kShapes[1], kShapes[3]}) {
    RichRadiance radiance(shape.form, 1, shape.texels, shape.lobes);
    radiance.set(0, n, {}, {&lobe, 1}, {&own, 1}, 0);
    expectNear(radiance.power(0), Rgb(lobes::hemisphereIntegral(dot(own, axis), 60)), 0.01f);
    EXPECT_GT(radiance.intensity(0, normalize(Vec3f{1, 0, 0.1f})).x,
              3 * radiance.intensity(0, normalize(Vec3f{1, 0, 0.5f})).x);
  }
}

class RichGather : public StrategyTest {
 protected:
  RichGather() { settings_.spread = 0; }
  std::unique_ptr<PreparedGather> prepare(uint64_t seed) override {
    settings_.gather = gather_;
    settings_.seed = seed;
    return std::make_unique<RichLights>(tracer_, receivers_, lights_, settings_, context_);
  }
  RichSettings settings_;
};

TEST_F(RichGather, APlacePerLightIsTheSum) {
  gather_.maxDepth = 5;
  for (const float clamp : {0.f, 3.f}) {
    gather_.clamp = clamp;
    EXPECT_LT(relativeError(some(), all()), 1e-4) << clamp;
  }
  settings_.form = RichForm::cube;
  settings_.texels = 64;
  EXPECT_LT(relativeError(some(), all()), 0.03);
}

TEST_F(RichGather, EveryClassIsGathered) {
  settings_.lights = 40;
  settings_.spread = 1;
  withEveryClassAlone([&] {
    const std::vector<Rgb> exact = all();
    const bool joined = lights_.diffuse.size() + lights_.glossy.size() > 0;
    if (!joined) return expectEqual(some(), exact);
    EXPECT_NEAR(sum(some()), sum(exact), 0.35 * sum(exact));
  });
}

// Not even one place lets light of a class or of a place be lost.
TEST_F(RichGather, PowerIsKept) {
  const auto powerOf = [](const RichLights& rich) {
    double power = 0;
    for (size_t i = 0; i < rich.radiance().size(); ++i)
      power += double{luminance(rich.radiance().power(i))};
    return power;
  };
  settings_.gather = gather_;
  double expected = 0;
  for (const DiffuseLight& light : lights_.diffuse)
    expected += double{luminance(light.intensity * kPi)};
  for (const GlossyLight& light : lights_.glossy)
    expected += double{luminance(light.intensity)} *
                lobes::hemisphereIntegralExact(double{dot(light.n, light.axis)},
                                               double{light.sharpness}, 0);
  for (const size_t count : {1u, 20u, 300u}) {
    for (const RichForm form : {RichForm::cube, RichForm::vmf}) {
      settings_.lights = count;
      settings_.form = form;
      const RichLights rich(tracer_, receivers_, lights_, settings_, context_);
      EXPECT_EQ(rich.radiance().size(), count);
      EXPECT_EQ(rich.lights().diffuse.size(), count);
      EXPECT_EQ(rich.lights().omni.size(), lights_.omni.size());
      EXPECT_NEAR(powerOf(rich), expected, 0.005 * expected) << count;
    }
  }
}

TEST_F(RichGather, ErrorsFallWithPlaces) {
  layOnFloor(&receivers_, 1);
  scene_ = trianglesAboveFloor();
  const Tracer tracer(scene_, context_);
  use_ = &tracer;
  lights_ = wallOfLights(3000, 4);
  const std::vector<Rgb> exact = all();
  settings_.spread = 1;
  settings_.texels = 32;
  for (const RichForm form : {RichForm::cube, RichForm::vmf}) {
    settings_.form = form;
    settings_.gather = gather_;
    double before = 0.5;
    for (const size_t count : {20u, 150u, 1500u}) {
      settings_.lights = count;
      const RichLights rich(tracer, receivers_, lights_, settings_, context_);
      const double error = relativeError(lightOf(rich, receivers_, context_), exact);
      EXPECT_LT(error, 0.6 * before) << count;
      before = error;
    }
    EXPECT_LT(before, 0.03);
  }
}

// Places that only they see matter to receivers: others are joined from afar.
TEST_F(RichGather, PlacesLieWhereThePictureSeesThem) {
  layOnFloor(&receivers_, 1);
  lights_ = wallOfLights(1000, 4);
  for (size_t i = 0; i < 500; i += 2) {  // half of them on the other side of the floor
    lights_.diffuse[i].p.z *= -1;
    lights_.glossy[i].p.z *= -1;
  }
  settings_.gather = gather_;
  settings_.lights = 100;
  const RichLights rich(tracer_, receivers_, lights_, settings_, context_);
  size_t below = 0;
  for (const DiffuseLight& light : rich.lights().diffuse) below += light.p.z < 0 ? 1 : 0;
  EXPECT_LT(below, 30u);
  EXPECT_GT(below, 0u) << "a part of them is drawn by power";
}

// What a receiver is denied by its depth, it is denied of every place.
TEST_F(RichGather, DepthsLimitTheSharesOfPlaces) {
  settings_.lights = 30;
  gather_.maxDepth = 3;
  const double limited = sum(some());
  gather_.maxDepth = -1;
  const double whole = sum(some());
  gather_.maxDepth = 3;
  const double exact = sum(all());
  gather_.maxDepth = -1;
  EXPECT_NEAR(limited / whole, exact / sum(all()), 0.08);
  EXPECT_LT(limited, 0.9 * whole);

  RichRadiance radiance(RichForm::vmf, 2, 4, 1);
  radiance.limitDepth(4, 3, {0.25f, 0.5f, 1, 0, 0, 1});
  EXPECT_EQ(radiance.share(0, 1), 1);
  EXPECT_EQ(radiance.share(0, 2), 0.5f);
  EXPECT_EQ(radiance.share(0, 3), 0.25f);
  EXPECT_EQ(radiance.share(0, 4), 0);
  EXPECT_EQ(radiance.share(1, 2), 0);
}

TEST_F(RichGather, ThreadsDoNotMatterAndSeedsDo) {
  settings_.lights = 40;
  for (const RichForm form : {RichForm::cube, RichForm::vmf}) {
    settings_.form = form;
    expectSameForAnyThreads();
  }
}
TEST_F(RichGather, OnePixelAloneHasTheSameBits) {
  settings_.lights = 40;
  expectSameBitsForOnePixel();
}
TEST_F(RichGather, PartsAddUp) {
  settings_.lights = 1000;
  settings_.gather = gather_;
  lights_.groups = {"a", "b"};  // of places as of lights
  for (size_t i = 0; i < lights_.diffuse.size(); ++i)
    lights_.diffuse[i].tag |= static_cast<uint32_t>(i % 2) << 8;
  const RichLights rich(tracer_, receivers_, lights_, settings_, context_);
  VirtualLights lights = lights_;
  test::expectPartsAddUp(lights, context_, [&](GatherParts* parts) {
    return lightOf(rich, receivers_, context_, parts);
  });
}

TEST_F(RichGather, GroupsAreNotJoined) {
  lights_.groups = {"a", "b"};
  lights_.omni.clear(), lights_.directional.clear();
  for (size_t i = 0; i < lights_.diffuse.size(); ++i)
    lights_.diffuse[i].tag |= static_cast<uint32_t>(i % 2) << 8;
  lights_.glossyGroups.assign(lights_.glossy.size(), 0);
  for (size_t i = 0; i < lights_.glossy.size(); i += 3) lights_.glossyGroups[i] = 1;
  settings_.gather = gather_;
  settings_.lights = 1;
  const RichLights rich(tracer_, receivers_, lights_, settings_, context_);
  ASSERT_EQ(rich.radiance().size(), 2u) << "a place for each group";
  double power[2] = {}, expected[2] = {};
  for (size_t i = 0; i < 2; ++i)
    power[rich.lights().diffuse[i].tag >> 8] += double{luminance(rich.radiance().power(i))};
  for (const DiffuseLight& light : lights_.diffuse)
    expected[light.tag >> 8] += double{luminance(light.intensity * kPi)};
  for (size_t i = 0; i < lights_.glossy.size(); ++i)
    expected[lights_.glossyGroups[i]] +=
        double{luminance(lights_.glossy[i].intensity)} *
        double{lobes::hemisphereIntegral(dot(lights_.glossy[i].n, lights_.glossy[i].axis),
                                         lights_.glossy[i].sharpness)};
  for (const int g : {0, 1}) EXPECT_NEAR(power[g], expected[g], 0.005 * expected[g]) << g;
}

// Near to its place, light that is spread is no spike.
TEST_F(RichGather, SpreadLimitsTheGeometryTerm) {
  lights_ = {};
  for (const float x : {-0.1f, 0.1f})
    lights_.diffuse.push_back({{x, 0, 0}, Rgb(1.f), encodeOctahedral({0, 0, 1}), 1});
  lights_.diffuseDepthEnds = {0, 2};
  gather_.clamp = 0;
  settings_.lights = 1;
  settings_.spread = 1;
  settings_.gather = gather_;
  const RichLights rich(tracer_, {}, lights_, settings_, context_);
  ASSERT_EQ(rich.radiance().size(), 1u);
  EXPECT_NEAR(rich.radiance().light(0).leastSquared, 0.5f * 0.04f, 1e-6f);

  receivers_ = randomReceivers(1, {LobeType::lambert}, 1, 1);
  ReceiverPoint& above = receivers_.points[0];
  above.p = rich.lights().diffuse[0].p + Vec3f{0, 0, 0.01f};
  above.frame = frameFromNormal({0, 0, -1});
  above.ng = above.wo = {0, 0, -1};
  above.depth = 1;
  scene_ = trianglesAboveFloor();
  const Tracer tracer(scene_, context_);
  settings_.spread = 0;
  const RichLights point(tracer, {}, lights_, settings_, context_);
  settings_.spread = 1;
  const RichLights spread(tracer, {}, lights_, settings_, context_);
  const double spike = sum(lightOf(point, receivers_, context_));
  EXPECT_GT(spike, 0);
  EXPECT_NEAR(sum(lightOf(spread, receivers_, context_)), spike * 1e-4 / 0.02, 1e-4 * spike);
}

TEST_F(RichGather, StatisticsSayWhatPlacesTake) {
  settings_.lights = 30;
  settings_.form = RichForm::cube;
  some();
  EXPECT_EQ(context_.statistics.count("rich_lights"), 30u);
  EXPECT_EQ(context_.statistics.count("rich_bytes"),
            30 * RichRadiance::bytesPerLight(RichForm::cube, 16, 8));
  EXPECT_NEAR(static_cast<double>(RichRadiance::bytesPerLight(RichForm::cube, 16, 8)), 4608, 100);
  EXPECT_NEAR(static_cast<double>(RichRadiance::bytesPerLight(RichForm::vmf, 16, 8)), 224, 100);
  lights_.omni.clear(), lights_.directional.clear();
  settings_.lights = 1000;
  const uint64_t rays = growth("shadow_rays", [&] { some(); });
  EXPECT_LE(rays, 2u * 300 * 300) << "of the sample and of the receivers";
}

TEST_F(RichGather, TooLittleMemoryIsSaid) {
  settings_.form = RichForm::cube;
  settings_.memory = 100'000;
  try {
    some();
    FAIL();
  } catch (const UsageError& e) {
    EXPECT_NE(std::string(e.what()).find("--richvpl-texels"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("--memory"), std::string::npos) << e.what();
  }
}

TEST_F(RichGather, NothingToJoinIsTheSum) {
  lights_.diffuse.clear(), lights_.diffuseDepthEnds.clear();
  lights_.glossy.clear(), lights_.glossyDepthEnds.clear();
  expectEqual(some(), all());
}

}  // namespace
}  // namespace lobelia
