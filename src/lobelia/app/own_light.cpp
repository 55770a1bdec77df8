#include "lobelia/app/own_light.h"

#include <fmt/format.h>

#include "lobelia/app/light_sets.h"
#include "lobelia/app/render_frame.h"
#include "lobelia/app/sampled_film.h"
#include "lobelia/base/error.h"
#include "lobelia/gather/compensation.h"
#include "lobelia/gather/final_gather.h"

namespace lobelia::app {
namespace {

ReceiverRaySettings raySettings(const BandPlan& plan, const Film& film) {
  return {plan.eye.sample, film.x0, film.y0, film.width, plan.gather.onlyPixel};
}

void trace(const OwnLightInput& in, const Receivers& receivers, const Film& film,
           std::span<Rgb> light, Context& context, GatherParts* parts) {
  const LightSettings lights = lightSettings(in.options, in.maxDepth, 0);
  if (in.photons != nullptr) {
    FinalGatherSettings settings;
    settings.rays = raySettings(in.plan, film);
    settings.rayCount = in.options.gatherRays;
    settings.nearest = in.options.photonsNearest;
    settings.maxRadius = in.options.photonRadius > 0 ? static_cast<float>(in.options.photonRadius)
                                                     : 0.1f * in.tracer.bounds().radius();
    settings.maxDepth = in.maxDepth;
    settings.specularLimit = lights.specularLimit;
    return finalGather(in.tracer, receivers, *in.photons, settings, light, context, parts);
  }
  CompensationSettings settings;
  settings.rays = raySettings(in.plan, film);
  settings.clamp = in.plan.gather.clamp;
  settings.glossy = lights.kind == LightKind::glossy;
  settings.maxDepth = in.maxDepth;
  settings.specularLimit = lights.specularLimit;
  settings.gaussiansPerLobe = lights.gaussiansPerLobe;
  compensate(in.tracer, in.emitters, receivers, settings, light, context, parts);
}

}  // namespace

void requireOwnLight(const RenderOptions& options) {
  const bool photon = options.lights == "photon";
  if (options.compensate && options.lights != "vpl" && options.lights != "glossy") {
    throw UsageError(fmt::format(
        "--compensate adds what vpl and glossy lights leave out; --lights {} does not combine",
        options.lights));
  }
  if (options.nearLights > 0) {
    if (options.compensate)
      throw UsageError(
          "--near-lights and --compensate both replace what near virtual lights get wrong; leave "
          "out one of them");
    if (usesVirtualLights(options) && !combinesWithNearLights(options))
      throw UsageError(fmt::format(
          "--near-lights takes over from vpl, glossy and vsl lights; --lights {} does not combine",
          options.lights));
  }
  if ((options.compensate || photon) && options.direct == "lights") {
    throw UsageError(
        fmt::format("{} leaves direct light to --direct nee; leave out --direct lights",
                    photon ? "--lights photon" : "--compensate"));
  }
  if (photon && !options.clamp.empty())
    throw UsageError("--clamp limits virtual lights and --lights photon has none");
}

std::unique_ptr<PhotonMap> obtainPhotons(const Tracer& tracer, const EmitterSampler& emitters,
                                         int maxDepth, int set, const RenderOptions& options,
                                         Context& context) {
  if (options.lights != "photon") return nullptr;
  return std::make_unique<PhotonMap>(
      makePhotons(tracer, emitters, lightSettings(options, maxDepth, set), context));
}

std::vector<Rgb> addOwnLight(const OwnLightInput& in, const Receivers& receivers, Film& film,
                             LightLayers* layers, Context& context) {
  const bool wanted = in.photons != nullptr || in.options.compensate;
  if (!wanted || in.options.component == "direct") return {};
  std::vector<Rgb> light(receivers.points.size());
  auto parts = layers != nullptr ? layers->wanted() : std::nullopt;
  trace(in, receivers, film, light, context, parts ? &*parts : nullptr);
  if (context.cancelled()) return {};
  if (parts) layers->add(receivers, *parts, false);
  for (size_t i = 0; i < light.size(); ++i)
    addTo(film.layers.at("indirect"), receivers.points[i].pixel, light[i]);
  return light;
}

}  // namespace lobelia::app
