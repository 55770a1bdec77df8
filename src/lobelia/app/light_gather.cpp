#include "lobelia/app/light_gather.h"

#include <cmath>

#include "lobelia/app/gather_options.h"
#include "lobelia/app/receiver_sample.h"
#include "lobelia/app/vsgl_options.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/gather_cuts.h"
#include "lobelia/gather/gather_pairs.h"
#include "lobelia/gather/illumination_cut.h"
#include "lobelia/gather/light_slices.h"
#include "lobelia/gather/lightcuts.h"
#include "lobelia/gather/multidimensional_lightcuts.h"
#include "lobelia/gather/rich_lights.h"
#include "lobelia/gather/stochastic_lightcuts.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kStream = 0x73676c63;  // of everything random here

using Prepared = std::unique_ptr<gather::PreparedGather>;

gather::CutGatherSettings cutSettings(const RenderOptions& options, const BandPlan& plan,
                                      const Camera& camera) {
  gather::CutGatherSettings settings;
  settings.gather = plan.gather;
  settings.cut.nodes = cutSizeOf(options);
  // The picture is the mean of samples, whose receivers lie apart and draw lights of their own.
  settings.cut.error =
      static_cast<float>(options.error * std::sqrt(static_cast<double>(plan.eye.sampleCount)));
  settings.shared = cutModeOf(options) == "shared";
  settings.width = camera.cropX1 - camera.cropX0;
  return settings;
}

gather::PairGatherSettings pairSettings(const RenderOptions& options,
                                        const GatherSettings& common) {
  using gather::TraversalSettings;
  gather::PairGatherSettings settings;
  settings.gather = common;
  settings.threshold = thresholdOf(options);
  if (boundOf(options) == "conservative")
    settings.traversal.error = TraversalSettings::Error::conservative;
  if (boundFormOf(options) == "corrected") settings.traversal.bounds = gather::BoundForm::corrected;
  if (childrenOf(options) == "paper")
    settings.traversal.children = TraversalSettings::ChildRule::paper;
  if (shareOf(options) == "radiance") settings.share = gather::Share::radiance;
  return settings;
}

// Of the strategies whose cuts a threshold and a size limit.
template <class Settings>
Settings boundedCutSettings(const RenderOptions& options, const GatherSettings& common) {
  Settings settings;
  settings.gather = common;
  settings.threshold = thresholdOf(options);
  settings.cutSize = cutSizeOf(options);
  return settings;
}

gather::IlluminationCutSettings illumcutSettings(const RenderOptions& options,
                                                 const GatherSettings& common) {
  gather::IlluminationCutSettings settings;
  settings.gather = common;
  settings.threshold = thresholdOf(options);
  settings.sampled = illumcutRaysOf(options) == "sampled";
  return settings;
}

gather::SliceSettings sliceSettings(const RenderOptions& options, const GatherSettings& common) {
  gather::SliceSettings settings;
  settings.gather = common;
  settings.slices = slicesOf(options);
  settings.columns = sliceColumnsOf(options);
  settings.memory = memoryOf(options);
  return settings;
}

gather::RichSettings richSettings(const RenderOptions& options, const GatherSettings& common) {
  gather::RichSettings settings;
  settings.gather = common;
  settings.lights = richLightsOf(options);
  settings.form =
      richRadianceOf(options) == "cube" ? gather::RichForm::cube : gather::RichForm::vmf;
  settings.texels = richTexelsOf(options);
  settings.lobes = richLobesOf(options);
  settings.memory = memoryOf(options);
  return settings;
}

// Pixels of which slices are made, or for which places are chosen.
size_t sampledPixels(const RenderOptions& options) {
  constexpr size_t kPixelsPerSlice = 64, kPixelsOfPlaces = 128;
  return options.lights == "richvpl" ? kPixelsOfPlaces : kPixelsPerSlice * slicesOf(options);
}

template <class Strategy, class Settings>
Prepared prepareTrees(const Tracer& tracer, const VirtualLights& lights, Settings settings,
                      uint64_t seed, Context& context) {
  settings.seed = seed;
  return std::make_unique<Strategy>(tracer, lights, settings, context);
}

// The same of strategies that are made for a sample of the picture.
template <class Strategy, class Settings>
Prepared prepareFor(const Tracer& tracer, const Receivers& sample, const VirtualLights& lights,
                    Settings settings, uint64_t seed, Context& context) {
  settings.seed = seed;
  return std::make_unique<Strategy>(tracer, sample, lights, settings, context);
}

}  // namespace

LightGather::LightGather(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                         const BandPlan& plan, int set, LightParts parts,
                         const RenderOptions& options, Context& context)
    : tracer_(tracer), settings_(plan.gather), options_(options), parts_(std::move(parts)) {
  const uint64_t seed = hashCombine(hashCombine(context.seed, kStream), static_cast<uint64_t>(set));
  std::optional<Receivers> sample;  // for both parts
  const auto sampled = [&]() -> const Receivers& {
    if (!sample) {
      const PixelSet pixels = choosePixelSample(camera, plan, sampledPixels(options), seed).pixels;
      sample = traceSample(tracer, emitters, camera, plan, set, pixels, context);
    }
    return *sample;
  };
  const auto prepare = [&](const VirtualLights& lights, uint64_t number) -> Prepared {
    const uint64_t own = hashCombine(seed, number);
    if (lights.size() == 0 || context.cancelled()) return nullptr;
    if (gathersPairs(options))
      return prepareTrees<gather::LightPairs>(tracer, lights, pairSettings(options, settings_), own,
                                              context);
    if (options.gather == "sglc")
      return prepareTrees<gather::LightCuts>(tracer, lights, cutSettings(options, plan, camera),
                                             own, context);
    if (options.gather == "lightcuts")
      return prepareTrees<gather::Lightcuts>(
          tracer, lights, boundedCutSettings<gather::LightcutsSettings>(options, settings_), own,
          context);
    if (options.gather == "mdlc")
      return prepareTrees<gather::MultidimensionalLightcuts>(
          tracer, lights, boundedCutSettings<gather::MultidimensionalSettings>(options, settings_),
          own, context);
    if (options.gather == "stochastic")
      return prepareTrees<gather::StochasticLightcuts>(
          tracer, lights, boundedCutSettings<gather::StochasticSettings>(options, settings_), own,
          context);
    if (options.gather == "illumcut")
      return prepareTrees<gather::IlluminationCut>(
          tracer, lights, illumcutSettings(options, settings_), own, context);
    if (options.gather == "lightslice")
      return prepareFor<gather::LightSlices>(tracer, sampled(), lights,
                                             sliceSettings(options, settings_), own, context);
    if (options.lights == "richvpl")
      return prepareFor<gather::RichLights>(tracer, sampled(), lights,
                                            richSettings(options, settings_), own, context);
    return nullptr;
  };
  if (const int texels = mapSizeOf(options); texels > 0) {
    if (!parts_.direct.gaussian.empty())
      directMaps_.emplace(tracer, parts_.direct, texels, context);
    if (!parts_.indirect.gaussian.empty() && options.component != "direct")
      indirectMaps_.emplace(tracer, parts_.indirect, texels, context);
  }
  direct_ = prepare(parts_.direct, 0);
  if (options.component != "direct") indirect_ = prepare(parts_.indirect, 1);
}

LightGather::Light LightGather::gather(const Receivers& run,
                                       const std::optional<GatherParts>& wanted, uint32_t onlyPixel,
                                       Context& context) const {
  Light light;
  light.direct.resize(run.points.size());
  light.indirect.resize(run.points.size());
  GatherSettings settings = settings_;
  settings.onlyPixel = onlyPixel;
  const auto add = [&](const VirtualLights& lights, const Prepared& prepared, size_t layer,
                       std::vector<Rgb>* sum, const std::optional<gather::DepthMaps>* maps) {
    if (lights.size() == 0) return;
    settings.depthMaps = maps != nullptr && *maps ? &**maps : nullptr;
    std::optional<GatherParts>& parts = light.layers[layer] = wanted;
    if (prepared) {
      prepared->gather(run, onlyPixel, *sum, context, parts ? &*parts : nullptr);
    } else {
      gatherAll(tracer_, run, lights, settings, *sum, context, parts ? &*parts : nullptr);
    }
  };
  add(parts_.direct, direct_, 0, &light.direct, &directMaps_);
  add(parts_.nearDirect, {}, 1, &light.direct, nullptr);
  if (options_.component == "direct") return light;
  add(parts_.indirect, indirect_, 2, &light.indirect, &indirectMaps_);
  add(parts_.nearIndirect, {}, 3, &light.indirect, nullptr);
  return light;
}

std::vector<gather::ExportedTree> LightGather::exportTrees(bool direct) const {
  const Prepared& prepared = direct ? direct_ : indirect_;
  return prepared ? prepared->exportTrees() : std::vector<gather::ExportedTree>();
}

size_t LightGather::runLength() const {
  return app::runLength(gatheredLights(parts_.size(), options_));
}

}  // namespace lobelia::app
