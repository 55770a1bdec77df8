#include "lobelia/app/light_sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <memory>

#include "lobelia/app/gather_options.h"
#include "lobelia/app/gaussian_lights.h"
#include "lobelia/app/vsgl_options.h"
#include "lobelia/lights/light_spacing.h"
#include "lobelia/lights/spherical_coverage.h"
#include "lobelia/lights/spherical_radius.h"

namespace lobelia::app {
namespace {

constexpr size_t kDefaultLights = 512, kDefaultPhotons = 200'000;

// Moves all but the first n, which are copied; a set may fill most of the memory.
template <class Light>
void splitAt(size_t n, std::vector<Light>& lights, std::vector<Light>& first,
             std::vector<Light>& rest) {
  const auto at = lights.begin() + static_cast<ptrdiff_t>(std::min(n, lights.size()));
  first.assign(lights.begin(), at);
  lights.erase(lights.begin(), at);
  rest = std::move(lights);
}

size_t emitterLights(const std::vector<uint32_t>& ends) { return ends.empty() ? 0 : ends.front(); }

void splitEnds(const std::vector<uint32_t>& ends, std::vector<uint32_t>& first,
               std::vector<uint32_t>& rest) {
  const uint32_t n = static_cast<uint32_t>(emitterLights(ends));
  first.assign(ends.empty() ? 0 : 1, n);
  rest = ends;
  for (uint32_t& end : rest) end -= n;
}

}  // namespace

LightCounts countLights(const VirtualLights& lights) {
  LightCounts counts;
  for (const gather::LightClass lightClass : gather::kLightClasses)
    counts.byClass[static_cast<size_t>(lightClass)] = gather::lightCount(lights, lightClass);
  counts.total = lights.size();
  counts.bytes = lights.omni.size() * sizeof(OmniLight) +
                 lights.directional.size() * sizeof(DirectionalLight) +
                 lights.diffuse.size() * sizeof(DiffuseLight) +
                 lights.glossy.size() * sizeof(GlossyLight) +
                 lights.spherical.size() * sizeof(SphericalLight) +
                 lights.gaussian.size() * sizeof(GaussianLight);
  counts.particles = lights.particles;
  return counts;
}

bool combinesWithNearLights(const RenderOptions& options) {
  return options.lights == "vpl" || options.lights == "glossy" || options.lights == "vsl";
}

float nearLightsOf(const RenderOptions& options) {
  if (options.nearLights >= 0) return options.nearLights + 0.f;  // -0 is 0
  return combinesWithNearLights(options) && !options.compensate ? 4.f : 0.f;
}

void warnOfFewLights(const LightParts& lights, const RenderOptions& options, Context& context) {
  size_t count = 0;  // of those that LightSpacing counts
  for (const VirtualLights* part : {&lights.direct, &lights.indirect})
    count += part->diffuse.size() + part->glossy.size() + part->spherical.size();
  if (options.nearLights > static_cast<float>(count))
    context.warning(
        fmt::format("--near-lights {}: there are {} virtual lights, so every surface is near and "
                    "the receivers' own rays find all light",
                    options.nearLights, count));
}

std::function<float(Vec3f)> nearDistanceOf(const LightParts& lights, const RenderOptions& options) {
  const float count = nearLightsOf(options);
  // Without lights on emitters, direct light is the eye pass's.
  const bool gathersNone = options.component == "direct" && options.direct != "lights";
  if (!(count > 0) || gathersNone) return {};
  const auto spacing = std::make_shared<const LightSpacing>(
      std::initializer_list<const VirtualLights*>{&lights.direct, &lights.indirect});
  return [spacing, count](Vec3f p) { return spacing->distance(p, count); };
}

LightParts splitLights(VirtualLights lights) {
  LightParts parts;
  VirtualLights &direct = parts.direct, &indirect = parts.indirect;
  direct.omni = std::move(lights.omni);
  direct.directional = std::move(lights.directional);
  direct.omniGroups = std::move(lights.omniGroups);
  direct.directionalGroups = std::move(lights.directionalGroups);
  splitAt(emitterLights(lights.diffuseDepthEnds), lights.diffuse, direct.diffuse, indirect.diffuse);
  splitAt(emitterLights(lights.glossyDepthEnds), lights.glossy, direct.glossy, indirect.glossy);
  splitAt(emitterLights(lights.glossyDepthEnds), lights.glossyGroups, direct.glossyGroups,
          indirect.glossyGroups);
  splitAt(emitterLights(lights.sphericalDepthEnds), lights.spherical, direct.spherical,
          indirect.spherical);
  splitAt(emitterLights(lights.gaussianDepthEnds), lights.gaussian, direct.gaussian,
          indirect.gaussian);
  splitEnds(lights.gaussianDepthEnds, direct.gaussianDepthEnds, indirect.gaussianDepthEnds);
  splitEnds(lights.diffuseDepthEnds, direct.diffuseDepthEnds, indirect.diffuseDepthEnds);
  splitEnds(lights.glossyDepthEnds, direct.glossyDepthEnds, indirect.glossyDepthEnds);
  splitEnds(lights.sphericalDepthEnds, direct.sphericalDepthEnds, indirect.sphericalDepthEnds);
  direct.sphereShading = indirect.sphereShading = lights.sphereShading;
  direct.gaussianShading = indirect.gaussianShading = lights.gaussianShading;
  direct.specularLimit = indirect.specularLimit = lights.specularLimit;
  direct.seed = indirect.seed = lights.seed;
  direct.groups = indirect.groups = std::move(lights.groups);
  return parts;
}

// Radius of the lights of pass `set` over the first pass': r_{k+1}^2 = r_k^2 (k + a) / (k + 1)
// [Knaus11 section 3; Hachisuka09]. The mean over the passes converges to the truth: its bias goes
// to zero, and its variance, though a pass' grows.
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
  shading.sampling = options.sphereSampling == "paper"  ? SphereShading::Sampling::paper
                     : options.sphereSampling == "cone" ? SphereShading::Sampling::cone
                                                        : SphereShading::Sampling::product;
  shading.maxSamples = options.sphereSamples;
  return shading;
}

// Default clamp of `vpl` and of what gets compensated: the geometry term of a light nearer than a
// twentieth of the scene's radius, the customary cure of its spikes.
float clampValue(const RenderOptions& options, float sceneRadius) {
  if (options.clamp == "off" || options.lights == "vsl" || options.lights == "vsgl") return 0;
  if (options.clamp.empty()) {
    return options.lights == "vpl" || options.compensate
               ? kInvPi / sqr(0.05f * std::max(sceneRadius, 1e-6f))
               : 0;
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

LightSettings lightSettings(const RenderOptions& options, int maxDepth, int set) {
  LightSettings settings;
  settings.count = options.lightCount > 0       ? options.lightCount
                   : options.lights == "photon" ? kDefaultPhotons
                                                : kDefaultLights;
  settings.set = static_cast<uint32_t>(set);
  settings.maxDepth = maxDepth;
  settings.specularLimit = options.specularLimit;
  settings.kind = options.lights == "vpl"    ? LightKind::diffuse
                  : options.lights == "vsl"  ? LightKind::spherical
                  : options.lights == "vsgl" ? LightKind::gaussian
                                             : LightKind::glossy;
  settings.directAsLights = options.direct == "lights";
  settings.environmentLights = options.environmentLights;
  settings.radiusFactor = options.radius;
  settings.radiusScale = progressiveRadiusScale(set);
  settings.sets = lightSetCount(options, virtualLightSamples(options));
  settings.sphereShading = sphereShadingOf(options);
  return settings;
}

VirtualLights obtainLights(const Tracer& tracer, const EmitterSampler& emitters, int maxDepth,
                           int set, const RenderOptions& options, Context& context) {
  const LightSettings settings = lightSettings(options, maxDepth, set);
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
    lights.gaussianShading = gaussianShadingOf(options);
    // Radii and discs are this render's affair.
    if (!lights.spherical.empty()) {
      chooseRadii(tracer, settings, &lights, context);
      coverSurfaces(tracer, &lights, context);
    }
    return lights;
  }
  VirtualLights lights = options.lights == "vsgl"
                             ? makeGaussianLights(tracer, emitters, settings, options, context)
                             : makeLights(tracer, emitters, settings, context);
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
  // What gathers pixels whole shares lights among samples.
  constexpr int kSamplesOfSet = 16;
  const int sets = oneSet                   ? 1
                   : gathersPixels(options) ? (sampleCount + kSamplesOfSet - 1) / kSamplesOfSet
                                            : sampleCount;
  return std::min(options.passes > 0 ? options.passes : sets, sampleCount);
}

int lightSetOf(int sample, int sampleCount, int setCount) {
  return static_cast<int>(int64_t{sample} * setCount / sampleCount);
}

}  // namespace lobelia::app
