// Particle pass: virtual lights from every emitter.
#pragma once

#include "lobelia/lights/light_point.h"
#include "lobelia/lights/photon.h"
#include "lobelia/lights/virtual_lights.h"
#include "lobelia/path/emitter_sampling.h"

namespace lobelia {

// What a particle leaves where it scatters by rough lobes.
enum class LightKind : uint8_t {
  diffuse,    // their diffuse part (--lights vpl)
  glossy,     // that and spherical Gaussians
  spherical,  // one spherical light for all of them (--lights vsl)
  gaussian,   // light points, of which clusters are made (--lights vsgl); not for makeLights()
};

struct LightSettings {
  size_t count = 4096;  // lights aimed at; particles are traced until about that many
  uint32_t set = 0;     // which of many independent sets of lights
  int maxDepth = -1;    // of whole paths: lights reach depth maxDepth - 2
  float specularLimit = 0.08f;
  LightKind kind = LightKind::glossy;
  bool directAsLights = false;  // --direct lights: emitters themselves become lights
  // Directional lights for environments (--env-lights), with directAsLights only: without it their
  // direct light is sampled at the receivers. 0: as many as give a good image.
  size_t environmentLights = 0;
  int gaussiansPerLobe = 24;  // of the expansion of a BSDF (bsdf/gaussians.h); 1: the paper's form
  bool photons =
      false;  // for makePhotons(), which sets it: particles leave these instead of lights
  // true: all of them become lights; false: one is drawn per vertex, as always for light points
  bool everyGaussian = false;
  // Spherical lights: radius over the distance of the tenth neighbour; 0: chosen automatically
  // (spherical_radius.h). radiusScale multiplies either (progressive rendering).
  float radiusFactor = 0, radiusScale = 1;
  int sets = 1;  // whose mean the picture is: radii that nobody named follow it
  SphereShading sphereShading;
};

// Unbiased per particle: the expected sum of lights does not depend on `count`. Same seed, same
// lights, any number of threads. Counts "light_particles", "path_rays", "paths_cut",
// "lights_dropped" (no power) and "nonfinite"; books seconds to "lights".
VirtualLights makeLights(const Tracer& tracer, const EmitterSampler& emitters,
                         const LightSettings& settings, Context& context);

// The lights of emitters without an area (directAsLights), with all that makeLights() says about
// lights; no others.
VirtualLights emitterLights(const EmitterSampler& emitters, const LightSettings& settings,
                            Context& context);

// Light points, settings.count about: one per side of a surface with rough lobes that a particle
// meets, and with directAsLights those on area emitters; whatever settings.kind. Sorted by group,
// then depth, and the particles' order. Expected sums and statistics as makeLights() has them.
std::vector<LightPoint> makeLightPoints(const Tracer& tracer, const EmitterSampler& emitters,
                                        const LightSettings& settings, Context& context);

// Photons: what particles bring to surfaces with rough lobes, settings.count about. Emitters and
// what lobes make of it are not theirs. Statistics as makeLights() has them, and "photons".
std::vector<Photon> makePhotons(const Tracer& tracer, const EmitterSampler& emitters,
                                const LightSettings& settings, Context& context);

// Directional lights that stand for an environment: structured importance sampling (Agarwal et al.
// 2003): strata of about equal energy x (solid angle)^(1/4), each light the energy of its stratum.
std::vector<DirectionalLight> environmentLights(const EmitterSampler& emitters, size_t count,
                                                uint64_t seed);
std::vector<DirectionalLight> environmentLights(const Scene& scene, size_t count, uint64_t seed);

// Directional lights that stand for directional emitters (one each) and suns (`count` each, evenly
// over their discs).
std::vector<DirectionalLight> sunLights(const Scene& scene, size_t count, uint64_t seed);

// Whole or not at all; refuses another scene's lights, wrong versions and damaged files
// (InputError).
void saveLights(const std::string& file, const VirtualLights& lights);
VirtualLights loadLights(const std::string& file, uint64_t sceneHash);
// Throws InputError when lights of a file cannot stand for those that makeLights() would make with
// these settings: another specular limit (light would be counted twice or lost), lights of emitters
// or of deep paths missing, emitters that the scene does not have. Number, seed and Gaussians per
// lobe are the file's affair.
void requireFit(const std::string& file, const VirtualLights& lights, const LightSettings& settings,
                const Scene& scene);

}  // namespace lobelia
