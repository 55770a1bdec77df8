// A scene under study: its light by path tracing and by virtual lights on the same pixels.
#pragma once

#include <functional>

#include "lobelia/app/bench.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/app/render_virtual_lights.h"
#include "lobelia/lights/virtual_lights.h"
#include "lobelia/path/path_tracer.h"

namespace lobelia::app {

struct Estimate {
  double mean = 0, error = 0;  // standard error of the mean
};
Estimate estimate(const std::vector<double>& independent);
Estimate ratio(Estimate a, Estimate b);  // of independent estimates

// Clamps to try: steps of the square root of ten around 1 / radius^2, the unit of what is clamped,
// `stepsAbove` of them above it, and none (infinity).
std::vector<double> clampValues(float radius, int stepsAbove = 4);
std::string clampText(double value);  // for --clamp

class BenchScene {
 public:
  struct Defaults {  // where the options say nothing
    std::string scene;
    uint64_t pixels = 0;  // 0: all
    int width = 0;        // 0: the scene's
    std::string component = "indirect";
    // Changes the scene before anything is made of it.
    std::function<void(Scene&)> prepare = nullptr;
  };
  BenchScene(const BenchOptions& options, const Defaults& defaults, Context& context);

  // Which pixels are computed: those that --pixels chooses, or all.
  enum class Extent : uint8_t { pixels, picture };

  // Pictures, or what there is of them when cancelled.
  Film pathTraced(int spp, uint64_t seed, Extent extent = Extent::pixels);
  Film directLight(int spp, uint64_t seed,
                   Extent extent);  // of the path tracer, whatever the study
  Film virtualLights(const std::string& model, const std::string& clamp, uint64_t lightCount,
                     int spp, uint64_t seed);

  // By virtual lights, one set, with options as `change` leaves them.
  using Change = std::function<void(RenderOptions&)>;
  Film virtualLights(const Change& change, uint64_t seed, Extent extent = Extent::pixels);
  // The set of lights that this renders with, and a picture with another one.
  VirtualLights lights(const Change& change, uint64_t seed);
  Film withLights(VirtualLights lights, const Change& change, uint64_t seed, Extent extent);

  // A picture with the set `lights`, which is made where it is not there yet, the layers that
  // `change` asks for included, and what there is to tell of it.
  struct Gathered {
    Film film;
    VirtualLightReport report;
  };
  Gathered gathered(std::optional<VirtualLights>* lights, const Change& change, uint64_t seed,
                    Extent extent);
  // The receivers of that picture, whole, and the settings by which they gather.
  std::pair<Receivers, GatherSettings> receivers(const Change& change, uint64_t seed);

  double mean(const Film& film) const;  // over the pixels and channels
  float radius() const { return tracer_.bounds().radius(); }
  const std::string& name() const { return name_; }
  size_t pixelCount() const;
  size_t pictureCount() const;  // pixels of the whole
  const Camera& camera() const { return camera_; }
  // Another view with a film of the same size: the same pixels are compared.
  void setCamera(const Camera& camera) { camera_ = camera; }
  // Another material takes the place of one, for pictures from then on: one that lets neither more
  // nor less light through.
  void setMaterial(MaterialHandle place, const Material& material) {
    scene_.materials[place.index] = material;
  }
  const Tracer& tracer() const { return tracer_; }
  const EmitterSampler& emitters() const { return emitters_; }
  int maxDepth() const { return maxDepth_; }

 private:
  using Method = std::function<void(const PixelSet&, Film&)>;
  Film render(const RenderOptions& options, uint64_t seed, Extent extent, const Method& method);
  Film pathTraced(const RenderOptions& options, int spp, uint64_t seed, Extent extent);

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
