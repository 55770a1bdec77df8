#include "lobelia/app/render_virtual_lights.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "lobelia/app/band_plan.h"
#include "lobelia/app/gather_options.h"
#include "lobelia/app/light_gather.h"
#include "lobelia/app/light_layers.h"
#include "lobelia/app/own_light.h"
#include "lobelia/app/preview_rows.h"
#include "lobelia/app/sampled_film.h"
#include "lobelia/bsdf/lobe_kind.h"

namespace lobelia::app {
namespace {

// Sample by sample, band by band: the band's receivers, then runs of them gathered. Between runs a
// render may stop or be saved, and another run of the program goes on there.
class VirtualLightRender {
 public:
  VirtualLightRender(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                     const PixelSet& pixels, int maxDepth, const RenderOptions& options, Film& film,
                     Checkpoints* checkpoints, FilmPreview* preview,
                     std::optional<VirtualLights>* firstSet, Context& context)
      : tracer_(tracer),
        emitters_(emitters),
        camera_(camera),
        options_(options),
        maxDepth_(maxDepth),
        film_(film),
        checkpoints_(checkpoints),
        preview_(preview),
        context_(context) {
    photons_ = obtainPhotons(tracer, emitters, maxDepth, 0, options, context);
    VirtualLights lights;
    if (!photons_)
      lights = firstSet != nullptr && *firstSet
                   ? **firstSet
                   : obtainLights(tracer, emitters, maxDepth, 0, options, context);
    if (firstSet != nullptr && !*firstSet) *firstSet = lights;
    report_.lights = countLights(lights);
    if (photons_) {
      report_.photons = photons_->photons().size();
      report_.lights.particles = context.statistics.count("light_particles");
    }
    plan_ =
        planBands(tracer, pixels, maxDepth, gatheredLights(lights.size(), options), options, film);
    first_ = splitLights(std::move(lights));
    report_.sets = plan_.sets;
    rowSamples_.assign(static_cast<size_t>(film.height), 0);
    variance_.emplace(film);
    backup_.emplace(film, plan_.bandRows);
    layers_.emplace(emitters.groups(), options, plan_.eye.sampleCount, film);
    if (!options.exportTrees.empty()) report_.cuts.emplace();
  }

  VirtualLightReport run() {
    resume();
    while (at_.sample < plan_.eye.sampleCount && renderSample()) {
      const int end = plan_.samplesEnd(at_.sample);
      variance_->afterSamples(plan_.eye.sampleCount, end - at_.sample);
      at_.sample = end;
      at_.band = 0;
    }
    save();
    finish();
    return std::move(report_);
  }

 private:
  // What comes next.
  struct Position {
    int32_t sample = 0, band = 0;
    uint32_t traced = 0;  // 1: the band's receivers have added what they add
    uint32_t unused = 0;
    uint64_t point = 0;  // receivers before it have gathered
  };

  bool stopped() const {
    const double seconds = static_cast<double>(nanosecondsNow() - start_) * 1e-9;
    return context_.cancelled() || (options_.timeLimit > 0 && seconds > options_.timeLimit);
  }

  void useLights(int set) {
    if (set == ready_) return;
    lights_.reset();  // before as many lights are made again
    ready_ = -1;
    LightParts parts;
    if (set == 0 && first_) {
      parts = std::move(*first_);
    } else {
      photons_ = obtainPhotons(tracer_, emitters_, maxDepth_, set, options_, context_);
      if (!photons_)
        parts = splitLights(obtainLights(tracer_, emitters_, maxDepth_, set, options_, context_));
    }
    first_.reset();
    if (context_.cancelled()) return;
    if (set == 0 && !photons_) warnOfFewLights(parts, options_, context_);
    plan_.eye.nearDistance = nearDistanceOf(parts, options_);
    parts = reduceParts(tracer_, emitters_, camera_, plan_, set, std::move(parts), options_,
                        &report_.reduction, context_);
    if (context_.cancelled()) return;
    lights_.emplace(tracer_, emitters_, camera_, plan_, set, std::move(parts), options_, context_);
    if (context_.cancelled()) return;
    set_ = ready_ = set;
    markCounts();
  }

  // These return false when stopped before their end.
  bool renderSample() {
    if (stopped()) return false;
    plan_.eye.sample = at_.sample;
    useLights(plan_.set(at_.sample));
    while (at_.band < plan_.bands) {
      if (stopped() || !renderBand()) return false;
      saveWhenDue();
    }
    if (keepsCuts()) report_.cuts->addTrees(*lights_);
    return true;
  }

  bool keepsCuts() const { return report_.cuts && at_.sample == 0; }

  bool renderBand() {
    const auto [y0, y1] = plan_.rows(at_.band, film_);
    const std::optional<Receivers> receivers = traceBand(y0, y1);
    if (!receivers || !gatherBand(*receivers)) return false;
    const int samples = plan_.samplesEnd(at_.sample) - at_.sample;
    for (int y = y0; y < y1; ++y) rowSamples_[static_cast<size_t>(y)] += samples;
    show(y0, y1);
    at_ = {.sample = at_.sample, .band = at_.band + 1};
    context_.progress("render",
                      (at_.sample + samples * static_cast<double>(at_.band) / plan_.bands) /
                          plan_.eye.sampleCount);
    return true;
  }

  // All rows of a band have as many samples.
  void show(int y0, int y1) const {
    if (!preview_) return;
    const float samples = static_cast<float>(rowSamples_[static_cast<size_t>(y0)]);
    previewRows(*preview_, film_, options_, y0, y1,
                static_cast<float>(plan_.eye.sampleCount) / samples);
  }

  std::optional<Receivers> traceBand(int y0, int y1) {
    if (resumed_) return std::exchange(resumed_, std::nullopt);
    backup_->take(y0, y1);
    Receivers receivers = traceTogether(plan_, [&](const EyeSettings& eye) {
      return traceReceivers(tracer_, emitters_, camera_, eye, y0, y1, film_, context_);
    });
    if (!context_.cancelled()) {
      addOwnLight({tracer_, emitters_, photons_.get(), plan_, maxDepth_, options_}, receivers,
                  film_, &*layers_, context_);
    }
    if (context_.cancelled()) {
      backup_->restore(y0, y1);
      return {};
    }
    at_.traced = 1;
    countReceivers(receivers);
    markCounts();
    return receivers;
  }

  void countReceivers(const Receivers& receivers) {
    report_.receiverPoints += receivers.points.size();
    for (const Lobe& lobe : receivers.lobes) {
      const bool diffuse = isDiffuse(lobe.type) || lobe.type == LobeType::diffuseTransmission;
      ++(diffuse ? report_.diffuseReceivers : report_.glossyReceivers);
    }
  }

  bool gatherBand(const Receivers& receivers) {
    const size_t points = receivers.points.size(), length = lights_->runLength();
    while (at_.point < points) {
      const size_t end = endOfRun(receivers, at_.point, length, plan_);
      const bool whole = at_.point == 0 && end == points;
      if (!gatherRun(whole ? receivers : slice(receivers, at_.point, end))) return false;
      at_.point = end;
      markCounts();
      if (end == points) break;
      saveWhenDue();
      if (stopped()) return false;
    }
    return true;
  }

  // Adds all of the run or nothing.
  bool gatherRun(const Receivers& run) {
    std::optional<GatherParts> wanted = layers_->wanted();
    const bool raysWanted = wanted && wanted->countRays;
    if (keepsCuts()) {
      if (!wanted) wanted.emplace();
      wanted->recordCuts = wanted->countRays = true;
    }
    LightGather::Light light = lights_->gather(run, wanted, GatherSettings::kAllPixels, context_);
    if (context_.cancelled()) return false;
    if (keepsCuts()) {
      report_.cuts->add(run, light);
      for (std::optional<GatherParts>& parts : light.layers)
        if (parts && !raysWanted) parts->rays.clear();
    }
    for (size_t i = 0; i < std::size(light.layers); ++i)
      if (light.layers[i]) layers_->add(run, *light.layers[i], i < 2);
    for (size_t i = 0; i < run.points.size(); ++i) {
      const ReceiverPoint& point = run.points[i];
      addTo(film_.layers.at(point.primary ? "direct" : "indirect"), point.pixel, light.direct[i]);
      addTo(film_.layers.at("indirect"), point.pixel, light.indirect[i]);
    }
    return true;
  }

  StateFields state() {
    StateFields fields;
    fields.addValue("position", at_);
    fields.addValue("light-set", set_);
    fields.addValue("reduction", report_.reduction);
    fields.add("row-samples", rowSamples_);
    fields.addValue("diffuse-receivers", report_.diffuseReceivers);
    fields.addValue("glossy-receivers", report_.glossyReceivers);
    fields.addValue("receiver-points", report_.receiverPoints);
    addFields(fields, film_);
    variance_->addFields(fields);
    backup_->addFields(fields);
    return fields;
  }

  void saveWhenDue() {
    if (checkpoints_ && checkpoints_->due()) save();
  }
  void save() {
    if (checkpoints_) checkpoints_->save(kStage, state());
  }

  void markCounts() {
    if (checkpoints_) checkpoints_->markCounts();
  }

  // Lights and receivers are made again: they are the same.
  void resume() {
    if (checkpoints_ && checkpoints_->load(kStage, state())) {
      requirePosition();
      const ReductionReport reduction = report_.reduction;  // has the set that is made again
      if (set_ == plan_.set(at_.sample)) useLights(set_);
      report_.reduction = reduction;
      if (at_.traced != 0) resumed_ = traceAgain();
      checkpoints_->restoreCounts();
    }
    markCounts();
  }

  void requirePosition() const {
    const bool good = at_.sample >= 0 && at_.sample <= plan_.eye.sampleCount && at_.band >= 0 &&
                      at_.band + static_cast<int>(at_.traced) <= plan_.bands && at_.traced <= 1 &&
                      set_ >= -1 && set_ < plan_.sets;
    if (!good) throw InputError({}, "the checkpoint's position is out of range; start afresh");
  }

  Receivers traceAgain() {
    plan_.eye.sample = at_.sample;
    Film shape;  // without layers: what the receivers add is there already
    shape.fullWidth = film_.fullWidth, shape.fullHeight = film_.fullHeight;
    shape.x0 = film_.x0, shape.y0 = film_.y0;
    shape.width = film_.width, shape.height = film_.height;
    const std::pair<int, int> rows = plan_.rows(at_.band, film_);
    return traceTogether(plan_, [&](const EyeSettings& eye) {
      return traceReceivers(tracer_, emitters_, camera_, eye, rows.first, rows.second, shape,
                            context_);
    });
  }

  void finish() {
    const int samples = plan_.eye.sampleCount;
    if (at_.sample < samples) {
      context_.info(
          fmt::format("stopped: {} of {} samples per pixel are complete", at_.sample, samples));
      if (at_.traced != 0) {
        const auto [y0, y1] = plan_.rows(at_.band, film_);
        backup_->restore(y0, y1);
      }
      variance_->afterSamples(samples, plan_.samplesEnd(at_.sample) - at_.sample);
      if (!context_.cancelled() &&
          std::find(rowSamples_.begin(), rowSamples_.end(), 0) != rowSamples_.end()) {
        context_.warning("--time-limit ended before every pixel had a sample; these have alpha 0");
      }
    }
    finishPartial(film_, rowSamples_, samples);
    std::vector<int> rowGroups;
    for (const int rows : rowSamples_) rowGroups.push_back(plan_.groupsOf(rows));
    variance_->finish(rowSamples_, rowGroups, samples);
  }

  static constexpr const char* kStage = "virtual lights";
  const Tracer& tracer_;
  const EmitterSampler& emitters_;
  const Camera& camera_;
  const RenderOptions& options_;
  const int maxDepth_;
  Film& film_;
  Checkpoints* const checkpoints_;
  FilmPreview* const preview_;
  Context& context_;
  const int64_t start_ = nanosecondsNow();

  int set_ = -1;                     // used last; -1: none yet, and none is in the counts
  int ready_ = -1;                   // whose lights lights_ holds
  std::optional<LightParts> first_;  // the first set until it is used
  std::optional<LightGather> lights_;
  std::unique_ptr<PhotonMap> photons_;  // --lights photon, in the place of lights
  BandPlan plan_;
  Position at_;
  std::vector<int> rowSamples_;
  std::optional<VarianceMeter> variance_;
  std::optional<BandBackup> backup_;
  std::optional<LightLayers> layers_;
  std::optional<Receivers> resumed_;  // of the band in which the checkpoint was made
  VirtualLightReport report_;
};

}  // namespace

VirtualLightReport renderVirtualLights(const Tracer& tracer, const EmitterSampler& emitters,
                                       const Camera& camera, const PixelSet& pixels, int maxDepth,
                                       const RenderOptions& options, Film& film, Context& context,
                                       Checkpoints* checkpoints, FilmPreview* preview,
                                       std::optional<VirtualLights>* firstSet) {
  return VirtualLightRender(tracer, emitters, camera, pixels, maxDepth, options, film, checkpoints,
                            preview, firstSet, context)
      .run();
}

}  // namespace lobelia::app
