// Every SIMD target that this processor has gives the same picture.
#include <gtest/gtest.h>

#include "gather/random_input.h"
#include "support/simd_targets.h"

namespace lobelia {
namespace {

using namespace test;

TEST(SimdTargets, AgreeOnAllLobesAndLights) {
  const Scene scene = randomTriangles(40, 31);
  Context context;
  const Tracer tracer(scene, context);
  const Receivers receivers =
      randomReceivers(120,
                      {LobeType::lambert, LobeType::coatedDiffuse, LobeType::principledDiffuse,
                       LobeType::microfacetReflection, LobeType::microfacetTransmission,
                       LobeType::phong, LobeType::ward, LobeType::diffuseTransmission},
                      2, 32);
  const VirtualLights lights = randomLights(40, 1e3f, 33);
  GatherSettings settings;
  settings.direct = true;
  const auto gatherWith = [&] {
    std::vector<Rgb> radiance(receivers.points.size());
    gatherAll(tracer, receivers, lights, settings, radiance, context);
    return radiance;
  };
  const std::vector<Rgb> best = gatherWith();
  int tested = 0;
  for (const int64_t each : usableTargets()) {
    const OnlyTarget target(each);
    SCOPED_TRACE(hwy::TargetName(each));
    const std::vector<Rgb> radiance = gatherWith();
    ++tested;
    for (size_t i = 0; i < best.size(); ++i) {
      const float tolerance = 1e-5f * maxComponent(best[i]);
      EXPECT_NEAR(radiance[i].x, best[i].x, tolerance) << "point " << i;
      EXPECT_NEAR(radiance[i].y, best[i].y, tolerance) << "point " << i;
      EXPECT_NEAR(radiance[i].z, best[i].z, tolerance) << "point " << i;
    }
  }
  EXPECT_GE(tested, 1);
}

}  // namespace
}  // namespace lobelia
