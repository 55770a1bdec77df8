// Compensation and photon mapping against the path tracer: means of indirect light over independent
// sets, with standard errors.
#include <gtest/gtest.h>

#include <cmath>

#include "lobelia/app/bench_scene.h"
#include "lobelia/base/random.h"
#include "support/run_program.h"

namespace lobelia::app {
namespace {

class OwnLight : public testing::TestWithParam<const char*> {
 protected:
  OwnLight() : scene_(options(), {.scene = GetParam(), .pixels = 256}, context_) {
    reference_ = pathReference(scene_, 4096, 1, context_).mean;
  }

  // Mean of indirect light relative to the path tracer's; a set of lights for every sample.
  Estimate relative(const std::string& model, const std::string& clamp, bool compensate,
                    uint64_t count, int sets, int spp) {
    std::vector<double> means;
    for (int i = 0; i < sets; ++i) {
      const auto change = [&](RenderOptions& o) {
        o.lights = model, o.clamp = clamp, o.compensate = compensate;
        o.lightCount = count, o.spp = o.passes = spp;
      };
      means.push_back(
          scene_.mean(scene_.virtualLights(change, hashCombine(77, static_cast<uint64_t>(i)))));
    }
    return ratio(estimate(means), reference_);
  }

  void expectCompensated(const std::string& model, const std::string& clamp) {
    SCOPED_TRACE(model + " --clamp " + clamp);
    const Estimate without = relative(model, clamp, false, 400, 12, 16),
                   with = relative(model, clamp, true, 400, 12, 16);
    RecordProperty(model + " without", std::to_string(without.mean));
    RecordProperty(model + " with", std::to_string(with.mean));
    EXPECT_LT(with.error, 0.005);
    EXPECT_NEAR(with.mean, 1, 4 * with.error);
    EXPECT_LT(without.mean, 1 - 10 * without.error);
    EXPECT_LT(without.mean, 1 - 10 * with.error);
  }

 private:
  static BenchOptions options() {
    BenchOptions out;
    out.scene.detail = 0.5f;
    return out;
  }
  Context context_;
  BenchScene scene_;
  Estimate reference_;
};

TEST_P(OwnLight, CompensationMakesClampedLightsUnbiased) {
  expectCompensated("vpl", "0.1");
  expectCompensated("glossy", "0.1");
}

TEST_P(OwnLight, PhotonsConvergeToThePathTracer) {
  const Estimate few = relative("photon", "", false, 2'000, 8, 4),
                 some = relative("photon", "", false, 20'000, 8, 4),
                 many = relative("photon", "", false, 400'000, 8, 4);
  RecordProperty("photons", std::to_string(few.mean) + " " + std::to_string(some.mean) + " " +
                                std::to_string(many.mean));
  EXPECT_GT(std::abs(few.mean - 1), std::abs(some.mean - 1) + 4 * some.error);
  EXPECT_GT(std::abs(some.mean - 1), std::abs(many.mean - 1) + 4 * many.error);
  EXPECT_NEAR(many.mean, 1, 0.01 + 4 * many.error);
}

INSTANTIATE_TEST_SUITE_P(Slow, OwnLight, testing::Values("study-diffuse", "study-ggx"),
                         [](const auto& param) { return param.index == 0 ? "Diffuse" : "Glossy"; });

TEST(OwnLightOptions, WhatDoesNotCombineIsRefused) {
  const auto expectRefused = [](const std::string& options, const char* mentions) {
    const auto r =
        test::runProgram("render cornell --detail 0.1 --size 8x8 --quiet -o /tmp/x.exr " + options);
    EXPECT_EQ(r.exitCode, 2) << options << "\n" << r.err;
    EXPECT_NE(r.err.find(mentions), std::string::npos) << options << "\nsaid: " << r.err;
  };
  expectRefused("--lights path --compensate", "--compensate");
  expectRefused("--lights photon --compensate", "--compensate");
  expectRefused("--lights vpl --compensate --direct lights", "--direct nee");
  expectRefused("--lights photon --direct lights", "--direct nee");
  expectRefused("--lights photon --clamp 3", "--clamp");
  expectRefused("--lights photon --aov types", "types");
  expectRefused("--lights photon --save-lights /tmp/x.dat", "no virtual lights");
}

}  // namespace
}  // namespace lobelia::app
