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

#include <optional>
#include <span>
#include <vector>

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
  uint32_t firstBad = 0xffffffffu;  // smallest pixel with a path that was not finite
};

struct PathResult {
  Rgb direct{}, indirect{};
  Rgb albedo{};  // of the first surface, if wanted; zero where there is none
  Vec3f normal{};
  float depth = 0;
};

// A path on its way: the ray to be traced next and all that goes with it.
struct PathState {
  PathState(const Ray& first, const PathRandom& numbers, uint32_t where)
      : ray(first), pixel(where), random(numbers) {}
  Ray ray;
  uint32_t pixel;
  PathRandom random;
  PathResult result;
  GroupSums groups;
  uint32_t shadowRays = 0;
  Rgb chain{1.f}, indirect{};         // throughput up to the ray's start
  Rgb metDirect{1.f}, metIndirect{};  // factor of emission that the ray meets
  Vec3f lightNumbers;                 // that choose the light at the vertex that the ray will find
  LightQuery from;                    // where the ray starts, and how it was drawn
  float pdfFrom = 0, eta = 1;
  int samplesFrom = 1;
  bool deltaFrom = true;
  int depth = 1;  // of the vertex that the ray will find
  std::optional<Hit> hit;
};

// A shadow ray that waits for being traced, and what it is worth when nothing blocks it.
struct PathShadow {
  Ray ray;
  PathState* path;
  int sample;  // which of the vertex' emitter samples
  bool seen;   // by the eye, directly or by sharp lobes
  Rgb direct, indirect;
  uint32_t emitter;
  void add() const {
    path->result.direct += direct, path->result.indirect += indirect;
    path->groups.add(emitter, ray.d, direct, indirect);
  }
};

// Rays: Tracer, or what answers the same queries (benchmarks record them). Members are defined in
// path_walk-inl.h and compiled for Tracer in path_walk.cpp.
template <class Rays>
class PathWalk {
 public:
  // described: are PathResult's albedo, normal and depth wanted?
  PathWalk(const Rays& tracer, const EmitterSampler& emitters, const PathSettings& settings,
           bool described)
      : tracer_(tracer), emitters_(emitters), settings_(settings), described_(described) {}
  // Follows the paths to their ends, side by side: while some wait for the memory of the triangle
  // that they hit, others are traced and shaded. First rays, and shadow rays of points that the eye
  // sees directly or by sharp lobes, go in packets. Embree's answers may depend, in their last
  // bits, on the company that a ray has; packets are therefore never shared by pixels: paths of a
  // pixel, which must be neighbours in `paths`, get the same result whatever the others are.
  void trace(std::span<PathState> paths, PathCounts& counts) const;

 private:
  static constexpr size_t kMost = 64;  // paths side by side
  using Shadows = std::vector<PathShadow>;

  void traceSome(std::span<PathState> paths, Shadows& shadows, PathCounts& counts) const;
  void intersectFirst(std::span<PathState> paths) const;
  void prefetch(const Hit& hit) const;
  void chooseLights(std::span<PathState* const> paths) const;
  int directSamples(const PathState& path) const {
    return path.chain != Rgb{} ? std::max(settings_.directSamples, 1) : 1;
  }
  bool advance(PathState& path, Shadows& shadows) const;  // false: the path has ended
  void light(PathState& path, const Bsdf& bsdf, Vec3f wo, Shadows& shadows) const;
  void traceShadows(const Shadows& shadows, PathCounts& counts) const;
  void lit(const PathShadow& shadow) const;
  void tracePixel(std::span<const PathShadow* const> shadows) const;
  void tracePacket(std::span<const PathShadow* const> shadows) const;
  void escape(PathState& path) const;
  void meet(PathState& path, Rgb radiance, const SurfacePoint* hit) const;
  void finish(PathState& path, PathCounts& counts) const;

  const Rays& tracer_;
  const EmitterSampler& emitters_;
  const PathSettings& settings_;
  const bool described_;
};

}  // namespace lobelia
