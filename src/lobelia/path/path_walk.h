// One path from the eye, its light split into "direct" and "indirect" (docs/architecture.md,
// section 4).
//
// Reading a path from the eye, every vertex scatters by a sharp (S) or a rough (R) lobe before
// light is met (L). Direct are S* L (emission seen through the eye's specular chain) and S* R L;
// indirect is all the rest. One path samples both: its throughput is the sum of two, `chain` (sharp
// lobes only so far) and `indirect`. At a vertex with f = f_sharp + f_rough light that is met
// counts chain * f to direct and indirect * f to indirect; past it
//     indirect' = (indirect f + chain f_rough) / p,   chain' = chain f_sharp / p.
#pragma once

#include "lobelia/base/random.h"
#include "lobelia/path/direct_light.h"
#include "lobelia/path/path_tracer.h"

namespace lobelia {

// Sobol' points for the first vertices, where stratification pays, independent numbers after them.
class PathRandom {
 public:
  PathRandom(uint64_t seed, uint64_t stream, uint32_t index)
      : sobol_(seed, stream, index), random_(hashCombine(seed, stream), index) {}
  float next1D() { return sobol_.dimension() < kSobol ? sobol_.next1D() : random_.next1D(); }
  Vec2f next2D() { return sobol_.dimension() < kSobol ? sobol_.next2D() : random_.next2D(); }

 private:
  static constexpr uint32_t kSobol = 24;
  Sampler sobol_;
  Rng random_;
};

// The part of a BSDF sample's weight that is due to sharp lobes.
Rgb sharpPart(const Bsdf& bsdf, Vec3f wo, const BsdfSample& s, Transport transport);

// Survival of a path at a vertex beyond the roulette depth: Mitsuba's rule, throughput times eta^2.
inline float rouletteSurvival(Rgb throughput, float eta) {
  return std::min(maxComponent(throughput) * eta * eta, 0.95f);
}

struct PathCounts {
  uint64_t pathRays = 0, shadowRays = 0, nonFinite = 0;
};

struct PathResult {
  Rgb direct{}, indirect{};
  Rgb albedo{};  // of the first surface; zero where there is none
  Vec3f normal{};
  float depth = 0;
};

// Rays: Tracer, or what answers the same queries (benchmarks record them). trace() is defined in
// path_walk-inl.h and compiled for Tracer in path_walk.cpp.
template <class Rays>
class PathWalk {
 public:
  PathWalk(const Rays& tracer, const EmitterSampler& emitters, const PathSettings& settings)
      : tracer_(tracer), emitters_(emitters), settings_(settings) {}
  PathResult trace(Ray ray, PathRandom& random, PathCounts& counts) const;

 private:
  const Rays& tracer_;
  const EmitterSampler& emitters_;
  const PathSettings& settings_;
};

}  // namespace lobelia
