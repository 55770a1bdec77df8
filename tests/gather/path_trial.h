// Means of a scene's picture over independent runs, by the path tracer and by other ways.
#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "lobelia/gather/gather.h"
#include "lobelia/lights/light_pass.h"
#include "support/test_scenes.h"

namespace lobelia::test {

struct Mean {
  double value = 0, error = 0;  // standard error
};
inline Mean meanOf(const std::vector<double>& runs) {
  const double n = static_cast<double>(runs.size());
  double sum = 0, squares = 0;
  for (const double v : runs) sum += v;
  for (const double v : runs) squares += (v - sum / n) * (v - sum / n);
  return {sum / n, std::sqrt(squares / (n * (n - 1)))};
}

inline constexpr uint64_t kRuns = 16;

class PathTrial {
 public:
  explicit PathTrial(Scene scene) : scene_(std::move(scene)), tracer_(scene_, context_) {}

  // Mean over the picture of a layer that is path-traced.
  Mean path(int maxDepth, const char* layer = "indirect") {
    PathSettings settings;
    settings.spp = 64;
    settings.maxDepth = maxDepth;
    std::vector<double> runs;
    for (uint64_t run = 0; run < kRuns; ++run) {
      context_.seed = 1000 + run;
      Film film = filmFor(camera(), {"direct", "indirect"});
      renderPath(tracer_, emitters_, camera(), settings, film, context_);
      runs.push_back(sum(film, layer));
    }
    return meanOf(runs);
  }

 protected:
  // once(): of one run.
  template <class Once>
  Mean mean(const Once& once) {
    std::vector<double> runs;
    for (uint64_t run = 0; run < kRuns; ++run) {
      context_.seed = run;
      runs.push_back(once());
    }
    return meanOf(runs);
  }
  // What the eye pass adds to the film's layers, and the light of all lights, which it returns, as
  // a mean over the picture. more(receivers, sample, radiance): adds what else there is.
  template <class More>
  double gathered(EyeSettings eye, const VirtualLights& lights, const GatherSettings& settings,
                  Film* film, const More& more) {
    double sum = 0;
    for (eye.sample = 0; eye.sample < eye.sampleCount; ++eye.sample) {
      const Receivers receivers =
          traceReceivers(tracer_, emitters_, camera(), eye, 0, camera().height, *film, context_);
      std::vector<Rgb> radiance(receivers.points.size());
      gatherAll(tracer_, receivers, lights, settings, radiance, context_);
      more(receivers, eye.sample, &radiance);
      for (const Rgb v : radiance) sum += double{v.x} + double{v.y} + double{v.z};
    }
    return sum / static_cast<double>(film->pixelCount());
  }
  const Camera& camera() const { return scene_.cameras[0]; }
  static double sum(const Film& film, const char* layer = "indirect") {
    double out = 0;
    for (const float v : film.layers.at(layer).values) out += double{v};
    return out / static_cast<double>(film.pixelCount());
  }

  Context context_;
  Scene scene_;
  Tracer tracer_;
  EmitterSampler emitters_{scene_, tracer_.bounds()};
};

inline Material material(MaterialType type, float alpha) {
  Material m;
  m.type = type;
  m.diffuse = Rgb(0.6f, 0.5f, 0.4f);
  m.specular = Rgb(0.8f);
  m.ior = 1.6f;
  m.alphaU = m.alphaV = alpha;
  return m;
}

// A box with two coarse smooth-shaded balls and a floor of the given materials.
inline Scene roomWith(const Material& ball, const Material& floor) {
  Scene scene = boxScene();
  const MaterialHandle handle = addMaterial(scene, ball);
  addSphere(scene, {-0.4f, -0.5f, 0.3f}, 0.4f, handle, {}, 8);
  addSphere(scene, {0.5f, -0.3f, 0.2f}, 0.35f, handle, {}, 8);
  scene.instances[floorWall].material = addMaterial(scene, floor);
  return scene;
}

}  // namespace lobelia::test
