// Who wants to know what paths do: --replay. One thread at a time when one pixel is rendered.
#pragma once

#include "lobelia/path/path_walk.h"

namespace lobelia {

class PathObserver {
 public:
  virtual ~PathObserver() = default;
  // A surface, before the path scatters there.
  virtual void vertex(const PathState& path, const SurfacePoint& at, const Bsdf& bsdf) = 0;
  // Emission that the path has met, and an emitter sample that nothing blocks: their light.
  virtual void met(const PathState& path, Rgb direct, Rgb indirect) = 0;
  virtual void lit(const PathShadow& shadow) = 0;
  // The result is final but for values that are not finite. Paths end in the order of samples.
  virtual void ended(const PathState& path) = 0;
};

}  // namespace lobelia
