#include "lobelia/app/light_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace lobelia::app {
namespace {

template <class Light>
void splitByDepth(const std::vector<Light>& lights, const std::vector<uint32_t>& ends,
                  std::vector<Light>& direct, std::vector<uint32_t>& directEnds,
                  std::vector<Light>& indirect, std::vector<uint32_t>& indirectEnds) {
  const uint32_t n = ends.empty() ? 0 : ends.front();
  direct.assign(lights.begin(), lights.begin() + n);
  indirect.assign(lights.begin() + n, lights.end());
  directEnds.assign(ends.empty() ? 0 : 1, n);
  indirectEnds = ends;
  for (uint32_t& end : indirectEnds) end -= n;
}

}  // namespace

LightParts splitLights(const VirtualLights& lights) {
  LightParts parts;
  parts.direct.omni = lights.omni;
  parts.direct.directional = lights.directional;
  splitByDepth(lights.diffuse, lights.diffuseDepthEnds, parts.direct.diffuse,
               parts.direct.diffuseDepthEnds, parts.indirect.diffuse,
               parts.indirect.diffuseDepthEnds);
  splitByDepth(lights.glossy, lights.glossyDepthEnds, parts.direct.glossy,
               parts.direct.glossyDepthEnds, parts.indirect.glossy, parts.indirect.glossyDepthEnds);
  splitByDepth(lights.spherical, lights.sphericalDepthEnds, parts.direct.spherical,
               parts.direct.sphericalDepthEnds, parts.indirect.spherical,
               parts.indirect.sphericalDepthEnds);
  parts.direct.sphereShading = parts.indirect.sphereShading = lights.sphereShading;
  parts.direct.specularLimit = parts.indirect.specularLimit = lights.specularLimit;
  parts.direct.groups = parts.indirect.groups = lights.groups;
  parts.direct.omniGroups = lights.omniGroups;
  parts.direct.directionalGroups = lights.directionalGroups;
  if (!lights.glossyGroups.empty()) {
    std::vector<uint32_t> ends;
    splitByDepth(lights.glossyGroups, lights.glossyDepthEnds, parts.direct.glossyGroups, ends,
                 parts.indirect.glossyGroups, ends);
  }
  return parts;
}

// Radius of the lights of pass `set` over the first pass' [Hachisuka and Jensen 2009, eq. 5 as
// methods of progressive density estimation have it]: r_{k+1}^2 = r_k^2 (k + a) / (k + 1). The mean
// over the passes converges to the truth.
float progressiveRadiusScale(int set) {
  constexpr double kAlpha = 2.0 / 3;
  double square = 1;
  for (int k = 1; k <= set; ++k) square *= (k + kAlpha) / (k + 1);
  return static_cast<float>(std::sqrt(square));
}

SphereShading sphereShadingOf(const RenderOptions& options) {
  SphereShading shading;
  shading.indicator = options.sphereIndicator == "cosine" ? SphereShading::Indicator::cosine
                                                          : SphereShading::Indicator::planar;
  shading.sampling = options.sphereSampling == "paper" ? SphereShading::Sampling::paper
                                                       : SphereShading::Sampling::product;
  shading.maxSamples = options.sphereSamples;
  return shading;
}

// Default clamp of `vpl`: the geometry term of a light nearer than a twentieth of the scene's
// radius, the customary cure of its spikes.
float clampValue(const RenderOptions& options, float sceneRadius) {
  if (options.clamp == "off") return 0;
  if (options.clamp.empty()) {
    return options.lights == "vpl" ? kInvPi / sqr(0.05f * std::max(sceneRadius, 1e-6f)) : 0;
  }
  float value = 0;
  const char* end = options.clamp.data() + options.clamp.size();
  const auto [next, error] = std::from_chars(options.clamp.data(), end, value);
  if (error != std::errc() || next != end || !(value > 0) || !std::isfinite(value)) {
    throw UsageError(
        fmt::format("--clamp '{}' is neither a positive number nor 'off'", options.clamp));
  }
  return value;
}

VirtualLights obtainLights(const Tracer& tracer, const EmitterSampler& emitters, int maxDepth,
                           int set, const RenderOptions& options, Context& context) {
  LightSettings settings;
  settings.count = options.lightCount;
  settings.set = static_cast<uint32_t>(set);
  settings.maxDepth = maxDepth;
  settings.specularLimit = options.specularLimit;
  settings.kind = options.lights == "vpl"   ? LightKind::diffuse
                  : options.lights == "vsl" ? LightKind::spherical
                                            : LightKind::glossy;
  settings.directAsLights = options.direct == "lights";
  settings.environmentLights = options.environmentLights;
  settings.radiusFactor = options.radius;
  settings.radiusScale = progressiveRadiusScale(set);
  settings.sphereShading = sphereShadingOf(options);
  if (!options.loadLights.empty()) {
    const StageTimer timer(context, "lights");  // as makeLights() books its own seconds
    VirtualLights lights = loadLights(options.loadLights, hash(tracer.scene()));
    if (lights.model != options.lights) {
      throw InputError({options.loadLights, 0, 0},
                       fmt::format("holds lights of model '{}'; render with --lights {}",
                                   lights.model, lights.model));
    }
    requireFit(options.loadLights, lights, settings, tracer.scene());
    lights.sphereShading = settings.sphereShading;
    return lights;
  }
  VirtualLights lights = makeLights(tracer, emitters, settings, context);
  lights.model = options.lights;
  // Lights of a pass that was stopped lack a part of their power: of no use later.
  if (!options.saveLights.empty() && !context.cancelled()) {
    lights.sceneHash = hash(tracer.scene());
    saveLights(options.saveLights, lights);
  }
  return lights;
}

int virtualLightSamples(const RenderOptions& options) { return options.spp > 0 ? options.spp : 16; }

int lightSetCount(const RenderOptions& options, int sampleCount) {
  const bool oneSet = !options.saveLights.empty() || !options.loadLights.empty();
  return std::min(options.passes > 0 ? options.passes : oneSet ? 1 : sampleCount, sampleCount);
}

int lightSetOf(int sample, int sampleCount, int setCount) {
  return static_cast<int>(int64_t{sample} * setCount / sampleCount);
}

}  // namespace lobelia::app
