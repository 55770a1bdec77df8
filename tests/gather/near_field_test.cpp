// The near field of spherical lights, gathered from all of them beside what stands for them.
#include "lobelia/gather/near_field.h"

#include "gather/mrcs_input.h"
#include "gather/spherical_setup.h"
#include "lobelia/lights/light_order.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;
using Reach = SphereShading::Reach;

class NearFieldTest : public testing::Test {
 protected:
  static constexpr int kWidth = 20, kHeight = 15, kLights = 700;
  static constexpr uint32_t kFirstDepth = 500;  // lights of depth 1

  NearFieldTest() {
    Rng random(4);
    const SphericalLight light = floor_.lights().spherical[0];
    floor_.lights().spherical.clear();
    for (int i = 0; i < kLights; ++i) {
      SphericalLight l = light;
      const Vec2f u{random.next1D(), random.next1D()};
      l.p = Vec3f(LitFloor::kMiddle) + Vec3f{8 * u.x - 4, 8 * u.y - 4, 0};
      l.radius = 0.2f + 0.3f * random.next1D();
      l.power *= random.next1D();
      l.depth = i < static_cast<int>(kFirstDepth) ? 1 : 2;
      floor_.lights().spherical.push_back(l);
    }
    floor_.lights().sphericalDepthEnds = {0, kFirstDepth, kLights};
    Bsdf bsdf;
    bsdf.add(Lobe{});
    for (uint32_t i = 0; i < kWidth * kHeight; ++i) {
      const Vec3f p{6 * random.next1D() - 3, 6 * random.next1D() - 3, 0.1f + 2 * random.next1D()};
      Receivers one = LitFloor::receivers(p, {0, 0, -1}, {0.3f, 0, -1}, bsdf, 1);
      one.points[0].pixel = i;
      one.points[0].firstLobe = i;
      one.points[0].depth = static_cast<uint8_t>(1 + i % 2);
      receivers_.points.push_back(one.points[0]);
      receivers_.lobes.push_back(one.lobes[0]);
    }
  }

  static VirtualLights reaching(VirtualLights lights, Reach reach, float radii) {
    lights.sphereShading.reach = reach;
    lights.sphereShading.nearField = radii;
    return lights;
  }
  std::vector<Rgb> gather(const VirtualLights& lights) {
    std::vector<Rgb> radiance(receivers_.points.size());
    gatherAll(floor_.tracer(), receivers_, lights, settings_, radiance, context_);
    return radiance;
  }
  static double sum(const std::vector<Rgb>& light) {
    double total = 0;
    for (const Rgb& value : light) total += double{value.x} + double{value.y} + double{value.z};
    return total;
  }

  LitFloor floor_{phongMaterial(0.4f, 0.4f, 20), 0.3f, {0.2f, 0, 1}};
  Receivers receivers_;
  GatherSettings settings_;
  Context context_;
};

TEST_F(NearFieldTest, BothPartsAreTheWhole) {
  const std::vector<Rgb> all = gather(floor_.lights());
  double before = 0;
  for (const float radii : {1.f, 3.f, 8.f}) {
    for (const int maxDepth : {-1, 3}) {
      settings_.maxDepth = maxDepth;
      const std::vector<Rgb> whole = gather(floor_.lights());
      const std::vector<Rgb> far = gather(reaching(floor_.lights(), Reach::farField, radii));
      VirtualLights lights = reaching(floor_.lights(), Reach::nearField, radii);
      sortByPlace(floor_.tracer().bounds(), &lights);
      const std::vector<Rgb> near = gather(lights);
      for (size_t i = 0; i < whole.size(); ++i)
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(near[i][c] + far[i][c], whole[i][c], 1e-5f * whole[i][c]) << radii;
      if (maxDepth < 0) {
        EXPECT_GT(sum(near), 1.2 * before) << "a wider field has more of the light";
        EXPECT_LT(sum(near), sum(all));
        before = sum(near);
      } else {
        EXPECT_LT(sum(near) + sum(far), 0.95 * sum(all)) << "lights of depth 2 are left out";
      }
    }
  }
}

// What stands for all lights beyond the near field, and all lights within: the light of all in the
// mean, with less noise than without the near field.
TEST_F(NearFieldTest, RepresentativesBeyondItAreUnbiasedAndLessNoisy) {
  constexpr int kDraws = 200;
  constexpr float kRadii = 4;
  const std::vector<Rgb> all = gather(floor_.lights());
  VirtualLights nearLights = reaching(floor_.lights(), Reach::nearField, kRadii);
  sortByPlace(floor_.tracer().bounds(), &nearLights);
  const std::vector<Rgb> near = gather(nearLights);
  MrcsSettings settings;
  settings.columns = 60;
  double mean = 0, squares = 0, errors[2] = {};
  for (int draw = 0; draw < kDraws; ++draw) {
    settings.seed = static_cast<uint64_t>(draw);
    const Rows rows = rowsOf(receivers_, kWidth, kHeight, 40, settings.seed);
    for (const bool split : {false, true}) {
      const VirtualLights lights =
          split ? reaching(floor_.lights(), Reach::farField, kRadii) : floor_.lights();
      MrcsReport report;
      const VirtualLights few =
          reduceLights(floor_.tracer(), rows, lights, settings, &report, context_);
      ASSERT_LE(few.size(), settings.columns);
      const std::vector<Rgb> far = gather(few);
      for (size_t i = 0; i < all.size(); ++i) {
        const Rgb value = far[i] + (split ? near[i] : Rgb(0.f)) - all[i];
        errors[split] += double{dot(value, value)};
      }
      if (!split) continue;
      const double total = sum(far) + sum(near);
      mean += total / kDraws, squares += total * total / kDraws;
    }
  }
  const double error = std::sqrt((squares - mean * mean) / kDraws);
  EXPECT_GT(error, 0);
  EXPECT_LT(error, 0.02 * mean) << "says too little";
  EXPECT_NEAR(mean, sum(all), 4 * error);
  EXPECT_LT(errors[1], 0.3 * errors[0]);
}

}  // namespace
}  // namespace lobelia
