// Every SIMD target that this processor has gives the same picture.
#include <gtest/gtest.h>
#include <hwy/highway.h>

#include "gather/random_input.h"

namespace lobelia {
namespace {

using namespace test;

// Makes the next dispatch choose one target; all of the processor's again at the end.
class OnlyTarget {
 public:
  explicit OnlyTarget(int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(target);
  }
  ~OnlyTarget() {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

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
  // Targets of kernels.cpp; the baseline's scalar code is always among them.
  int tested = 0;
  const int64_t usable = hwy::SupportedTargets() & HWY_TARGETS & ~HWY_SSSE3;
  for (int64_t left = usable; left != 0; left &= left - 1) {
    const OnlyTarget target(left & -left);
    SCOPED_TRACE(hwy::TargetName(left & -left));
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
