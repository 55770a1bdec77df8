// Paths by which scattered light comes from infinity [Green06].
#pragma once

#include <optional>

#include "lobelia/base/random.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::transfer {

// Where a path left the scene.
struct PathEnd {
  size_t reflections = 0;  // at other surfaces
  size_t lobeClass = 0;    // TransferData; of a pass after the first
  Rgb weight{1, 1, 1};     // what the other surfaces leave of light
  Vec3f d{};               // unit, away from the scene
};

// For one thread.
class ScatterPaths {
 public:
  // Keeps a reference. classCount: TransferData's.
  ScatterPaths(const Tracer& tracer, size_t mostReflections, int classCount)
      : tracer_(tracer), most_(mostReflections), classCount_(classCount) {}
  // From a point off a surface. Surfaces reflect by the parts that transfer knows (reflection.h),
  // sampled by their BRDFs. Empty: the path ends at a surface.
  std::optional<PathEnd> follow(Vec3f from, Vec3f d, Sampler& random);
  uint64_t segments() const { return segments_; }  // since it was made

 private:
  const Tracer& tracer_;
  const size_t most_;
  const int classCount_;
  uint64_t segments_ = 0;
};

}  // namespace lobelia::transfer
