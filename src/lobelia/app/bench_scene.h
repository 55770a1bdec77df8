// A scene under study: its light by path tracing and by virtual lights on the same pixels.
#pragma once

#include <functional>

#include "lobelia/app/bench.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/path/path_tracer.h"

namespace lobelia::app {

struct Estimate {
  double mean = 0, error = 0;  // standard error of the mean
};
Estimate estimate(const std::vector<double>& independent);
Estimate ratio(Estimate a, Estimate b);  // of independent estimates

class BenchScene {
 public:
  struct Defaults {  // where the options say nothing
    std::string scene;
    uint64_t pixels = 0;  // 0: all
    int width = 0;        // 0: the scene's
    std::string component = "indirect";
  };
  BenchScene(const BenchOptions& options, const Defaults& defaults, Context& context);

  // Pictures, or what there is of them when cancelled.
  Film pathTraced(int spp, uint64_t seed);
  Film virtualLights(const std::string& model, const std::string& clamp, uint64_t lightCount,
                     int spp, uint64_t seed);

  // By virtual lights, one set, with options as `change` leaves them.
  Film virtualLights(const std::function<void(RenderOptions&)>& change, uint64_t seed);

  double mean(const Film& film) const;  // over the pixels and channels
  float radius() const { return tracer_.bounds().radius(); }
  const std::string& name() const { return name_; }
  size_t pixelCount() const;
  const Camera& camera() const { return camera_; }

 private:
  Film render(uint64_t seed, const std::function<void(Film&)>& method);

  std::string name_;
  RenderOptions options_;
  Context& context_;
  Scene scene_;
  Camera camera_;
  PixelSet pixels_;
  int maxDepth_;
  Tracer tracer_;
  EmitterSampler emitters_;
};

// A reference in two independent halves, each of several runs.
struct Reference {
  Film first, second;
  Estimate mean;
};
Reference pathReference(BenchScene& scene, int spp, uint64_t seed, Context& context);

}  // namespace lobelia::app
