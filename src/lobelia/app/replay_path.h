// The trace of a pixel's paths (--replay with --lights path).
#pragma once

#include <map>
#include <string>

#include "lobelia/path/path_observer.h"

namespace lobelia::app {

// Prints a path when it ends; the first ones, all those that are not finite, or all.
class PathTrace : public PathObserver {
 public:
  PathTrace(const Scene& scene, bool all) : scene_(scene), all_(all) {}
  void vertex(const PathState& path, const SurfacePoint& at, const Bsdf& bsdf) override;
  void met(const PathState& path, Rgb direct, Rgb indirect) override;
  void lit(const PathShadow& shadow) override;
  void ended(const PathState& path) override;
  int hidden() const { return hidden_; }  // samples not printed

 private:
  const Scene& scene_;
  const bool all_;
  std::map<const PathState*, std::string> lines_;  // of paths on their way
  int sample_ = 0, hidden_ = 0;
};

}  // namespace lobelia::app
