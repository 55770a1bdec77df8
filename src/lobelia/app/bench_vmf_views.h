// Pictures from transfer data beside those of the path tracer, from several sides of a scene.
// Pixels of objects are compared: the environment itself is no result of either.
#pragma once

#include <map>
#include <memory>
#include <span>

#include "lobelia/app/bench_vmf.h"
#include "lobelia/film/metrics.h"
#include "lobelia/transfer/frame.h"

namespace lobelia::app {

// Over views.
struct VmfError {
  double l2 = 0, meanRatio = 0;
};

class VmfViews {
 public:
  static constexpr int kBounces = 2;        // of the data, as in the paper
  static constexpr int kFrameSamples = 16;  // of a pixel's filter
  static constexpr int kPathSamples = 512;  // in two halves
  static constexpr size_t kViews = 3;       // a third of a turn apart

  VmfViews(const std::string& name, const VmfStudy& study);

  const Tracer& tracer() const { return scene_->tracer(); }
  const Scene& scene() const { return tracer().scene(); }
  const Camera& camera(size_t view) const { return cameras_[view]; }
  std::span<const Camera> cameras() const { return cameras_; }
  int samples() const { return samples_; }
  std::string note() const;

  // By the scene's light, before frames.
  void light(transfer::TransferRenderer* renderer) const {
    renderer->relight(scene_->emitters(), study_.context);
  }
  // The picture of passes [first, end) from one side.
  Film frame(transfer::TransferRenderer& renderer, size_t view, int first, int end);
  // Light of at most that many reflections before the last, and of no fewer than `first`.
  const Reference& path(size_t view, int bounces);
  Reference path(size_t view, int first, int bounces);
  // One from each side, of all passes from the first on.
  std::vector<Film> frames(const transfer::TransferData& data, int first = 0);
  // From each side, of as many bounces as the data, from the first on.
  std::vector<Reference> paths(int first = 0);
  VmfError error(std::span<const Film> frames, std::span<const Reference> references) const;
  Comparison compared(const Film& film, size_t view, const Reference& path) const {
    return compare(film, path.first, &path.second, &objects_[view]);
  }

 private:
  std::unique_ptr<BenchScene> sceneOf(int bounces) const;

  const std::string name_;
  const VmfStudy& study_;
  const int samples_;
  std::unique_ptr<BenchScene> scene_;
  std::vector<Camera> cameras_;
  std::vector<Film> objects_;
  std::map<std::pair<size_t, int>, Reference> paths_;
};

}  // namespace lobelia::app
