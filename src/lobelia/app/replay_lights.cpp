#include "lobelia/app/replay_lights.h"

#include <algorithm>

#include "lobelia/app/band_plan.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/app/gather_options.h"
#include "lobelia/app/light_gather.h"
#include "lobelia/app/own_light.h"
#include "lobelia/app/replay_text.h"
#include "lobelia/app/sampled_film.h"

namespace lobelia::app {
namespace {

constexpr size_t kBrightest = 5;         // lights printed per receiver
constexpr size_t kMostLights = 1 << 15;  // of a set whose lights are looked at one by one

// The lights of every class one by one: `one` has the set's settings and a single light. Only those
// that `wanted` says.
template <class Light, class Wanted, class F>
void eachLight(const VirtualLights& set, std::vector<Light> VirtualLights::*array,
               const std::vector<uint32_t>* ends, std::vector<uint32_t> VirtualLights::*arrayEnds,
               const Wanted& wanted, const F& f) {
  const std::vector<Light>& lights = set.*array;
  for (size_t i = 0; i < lights.size(); ++i) {
    if (!wanted(lights[i])) continue;
    VirtualLights one;
    one.specularLimit = set.specularLimit;
    one.sphereShading = set.sphereShading;
    one.gaussianShading = set.gaussianShading;
    (one.*array).push_back(lights[i]);
    if (ends) {
      for (const uint32_t end : *ends) (one.*arrayEnds).push_back(i < end ? 1 : 0);
    }
    f(i, one);
  }
}

struct Contribution {
  std::string light;
  Rgb value;
};

class LightReplay {
 public:
  LightReplay(const Frame& frame, FrameRun& run, uint32_t pixel, int maxDepth, bool all, Film& film,
              Context& context)
      : options_(frame.options),
        camera_(frame.camera),
        run_(run),
        pixel_(pixel),
        maxDepth_(maxDepth),
        all_(all),
        film_(film),
        context_(context) {}

  int run() {
    const PixelSet pixels = choosePixels(camera_, options_);
    VirtualLights lights = obtain(0);
    plan_ = planBands(run_.tracer, pixels, maxDepth_, gatheredLights(lights.size(), options_),
                      options_, film_);
    useLights(0, std::move(lights));
    gather_ = plan_.gather;
    gather_.onlyPixel = pixel_;
    const int row = static_cast<int>(pixel_) / film_.width;
    for (int sample = 0; sample < plan_.eye.sampleCount && !context_.cancelled();
         sample = plan_.samplesEnd(sample)) {
      if (plan_.set(sample) != set_) useLights(plan_.set(sample), obtain(plan_.set(sample)));
      plan_.eye.sample = sample;
      renderSample(sample, row / plan_.bandRows);
    }
    return plan_.eye.sampleCount;
  }

 private:
  VirtualLights obtain(int set) {
    photons_ = obtainPhotons(run_.tracer, run_.emitters, maxDepth_, set, options_, context_);
    if (photons_) return {};
    return obtainLights(run_.tracer, run_.emitters, maxDepth_, set, options_, context_);
  }
  void useLights(int set, VirtualLights lights) {
    lightCount_ = lights.size();
    lights_.reset();
    ReductionReport unused;
    LightParts parts = splitLights(std::move(lights));
    plan_.eye.nearDistance = nearDistanceOf(parts, options_);
    parts = reduceParts(run_.tracer, run_.emitters, camera_, plan_, set, std::move(parts), options_,
                        &unused, context_);
    lights_.emplace(run_.tracer, run_.emitters, camera_, plan_, set, std::move(parts), options_,
                    context_);
    set_ = set;
  }

  void renderSample(int sample, int band) {
    const std::pair<int, int> rows = plan_.rows(band, film_);
    const Rgb direct = film_.rgb(pixel_, "direct"), indirect = film_.rgb(pixel_, "indirect");
    const Receivers receivers = traceTogether(plan_, [&](const EyeSettings& eye) {
      return traceReceivers(run_.tracer, run_.emitters, camera_, eye, rows.first, rows.second,
                            film_, context_);
    });
    const bool shown = all_ || sample < kReplaySamples;
    if (shown) {
      const int last = plan_.samplesEnd(sample) - 1;
      fmt::print("sample {}{}  of light set {} ({})\n  eye pass: direct {}  indirect {}\n", sample,
                 last > sample ? fmt::format(" to {}", last) : "", set_, lightsText(),
                 text(film_.rgb(pixel_, "direct") - direct),
                 text(film_.rgb(pixel_, "indirect") - indirect));
    }
    addOwn(receivers, shown);
    if (photons_) return;
    const size_t points = receivers.points.size(), length = lights_->runLength();
    for (size_t begin = 0, end = 0; begin < points; begin = end) {
      end = endOfRun(receivers, begin, length, plan_);
      gatherRun(begin == 0 && end == points ? receivers : slice(receivers, begin, end), shown);
    }
  }

  std::string lightsText() const {
    return photons_ ? fmt::format("{} photons", photons_->photons().size())
                    : fmt::format("{} lights", lightCount_);
  }

  // What receivers find by rays of their own.
  void addOwn(const Receivers& receivers, bool shown) {
    const std::vector<Rgb> light =
        addOwnLight({run_.tracer, run_.emitters, photons_.get(), plan_, maxDepth_, options_},
                    receivers, film_, nullptr, context_);
    for (size_t i = 0; i < light.size() && shown; ++i) {
      const ReceiverPoint& point = receivers.points[i];
      if (point.pixel != pixel_) continue;
      fmt::print("  receiver at {}  depth {}  lobes {}  weight {}\n    {}: indirect {}\n",
                 place(point.p), point.depth, point.lobeCount, text(point.weight),
                 photons_ ? "final gathering" : "compensation", text(light[i]));
    }
  }

  void gather(const Receivers& run, const VirtualLights& lights, std::span<Rgb> radiance,
              Context& context) {
    if (lights.size() > 0) gatherAll(run_.tracer, run, lights, gather_, radiance, context);
  }

  // As the render does, in its order.
  void gatherRun(const Receivers& run, bool shown) {
    const auto mine = [&](const ReceiverPoint& point) { return point.pixel == pixel_; };
    if (std::none_of(run.points.begin(), run.points.end(), mine)) return;
    const auto [direct, indirect, layers] = lights_->gather(run, {}, pixel_, context_);
    for (size_t i = 0; i < run.points.size(); ++i) {
      const ReceiverPoint& point = run.points[i];
      if (!mine(point)) continue;
      addTo(film_.layers.at(point.primary ? "direct" : "indirect"), pixel_, direct[i]);
      addTo(film_.layers.at("indirect"), pixel_, indirect[i]);
      if (!shown) continue;
      fmt::print(
          "  receiver at {}  depth {}  lobes {}  weight {}\n    gathered: direct {}  "
          "indirect {}\n",
          place(point.p), point.depth, point.lobeCount, text(point.weight), text(direct[i]),
          text(indirect[i]));
      printBrightest(slice(run, i, i + 1));
    }
  }

  static std::string extent(const std::vector<SphericalLight>& light) {
    if (light.empty()) return {};
    return fmt::format(" at {}, radius {:.3g}", place(light[0].p), light[0].radius);
  }

  // Lights alone, each for itself: their sum may differ from the gathered one by rounding.
  void printBrightest(const Receivers& receiver) {
    const LightParts& parts = lights_->parts();
    if (!all_ && parts.size() > kMostLights) {
      fmt::print("    (more than {} lights: --verbose looks at each)\n", kMostLights);
      return;
    }
    Context own;
    std::vector<Contribution> lights;
    size_t visible = 0, all = 0;
    using L = VirtualLights;
    for (const auto& [source, part] : {std::pair{"of an emitter", &parts.direct},
                                       std::pair{"of a near emitter", &parts.nearDirect},
                                       std::pair{"of a bounce", &parts.indirect},
                                       std::pair{"of a near bounce", &parts.nearIndirect}}) {
      const auto reaches = [&, shading = part->sphereShading](const auto& light) {
        if constexpr (std::is_same_v<std::decay_t<decltype(light)>, SphericalLight>) {
          const float d2 = lengthSquared(light.p - receiver.points[0].p);
          return d2 < 1.001f * gather::reachOf(shading, light.radius).to;
        }
        return true;
      };
      const auto addClass = [&, source = source, part = part](const char* kind, auto array,
                                                              const std::vector<uint32_t>* ends,
                                                              auto arrayEnds) {
        eachLight(*part, array, ends, arrayEnds, reaches, [&](size_t i, const VirtualLights& one) {
          ++all;
          Rgb value;
          gather(receiver, one, std::span(&value, 1), own);
          if (value == Rgb{}) return;
          ++visible;
          lights.push_back(
              {fmt::format("{} light {} {}{}", kind, source, i, extent(one.spherical)), value});
        });
      };
      addClass("omni", &L::omni, nullptr, &L::diffuseDepthEnds);
      addClass("directional", &L::directional, nullptr, &L::diffuseDepthEnds);
      addClass("diffuse", &L::diffuse, &part->diffuseDepthEnds, &L::diffuseDepthEnds);
      addClass("glossy", &L::glossy, &part->glossyDepthEnds, &L::glossyDepthEnds);
      addClass("spherical", &L::spherical, &part->sphericalDepthEnds, &L::sphericalDepthEnds);
      addClass("spherical Gaussian", &L::gaussian, &part->gaussianDepthEnds, &L::gaussianDepthEnds);
    }
    const size_t count = std::min(kBrightest, lights.size());
    std::partial_sort(lights.begin(), lights.begin() + static_cast<ptrdiff_t>(count), lights.end(),
                      [](const Contribution& a, const Contribution& b) {
                        return maxComponent(a.value) > maxComponent(b.value);
                      });
    fmt::print(
        "    {} of {} lights contribute{}\n", visible, all,
        own.statistics.count("nonfinite") > 0
            ? fmt::format("; NOT FINITE: {} pairs, left out", own.statistics.count("nonfinite"))
            : "");
    for (size_t i = 0; i < count; ++i)
      fmt::print("      {}: {}\n", lights[i].light, text(lights[i].value));
  }

  const RenderOptions& options_;
  const Camera& camera_;
  FrameRun& run_;
  const uint32_t pixel_;
  const int maxDepth_;
  const bool all_;
  Film& film_;
  Context& context_;
  BandPlan plan_;
  GatherSettings gather_;  // of this pixel alone
  std::optional<LightGather> lights_;
  std::unique_ptr<PhotonMap> photons_;  // --lights photon, in the place of lights
  size_t lightCount_ = 0;
  int set_ = 0;
};

}  // namespace

int replayVirtualLights(const Frame& frame, FrameRun& run, uint32_t pixel, int maxDepth, bool all,
                        Film& film, Context& context) {
  return LightReplay(frame, run, pixel, maxDepth, all, film, context).run();
}

}  // namespace lobelia::app
