#include "lobelia/gather/light_block.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lobelia/base/parallel.h"
#include "lobelia/scene/shading.h"

namespace lobelia::gather {
namespace {

// Position error assumed for a light: it was found by a ray, so its coordinates are good to some
// units in the last place.
float positionError(Vec3f p) {
  return 4e-7f * std::max(std::abs(p.x), std::max(std::abs(p.y), std::abs(p.z)));
}

// expf() is exactly zero below this argument.
constexpr float kZeroExponent = 104.f;

PreparedLight prepared(const OmniLight& light) {
  PreparedLight r;
  r.p = r.end = light.p;
  r.intensity = light.intensity;
  return r;
}
PreparedLight prepared(const DirectionalLight& light) {
  PreparedLight r;
  r.p = r.end = light.direction;
  r.intensity = light.irradiance;
  return r;
}
PreparedLight prepared(const DiffuseLight& light) {
  PreparedLight r;
  r.p = light.p;
  r.n = decodeOctahedral(light.normal);
  r.end = liftedEnd(r.p, r.n);
  r.intensity = light.intensity;
  return r;
}
PreparedLight prepared(const GlossyLight& light) {
  PreparedLight r;
  r.p = light.p;
  r.n = light.n;
  r.axis = light.axis;
  r.sharpness = light.sharpness;
  r.end = liftedEnd(r.p, r.n);
  r.intensity = light.intensity;
  r.cutoff = glossyCutoff(light.sharpness);
  return r;
}

template <class Light>
void prepareAll(const std::vector<Light>& lights, LightBlock* block) {
  // Lights may be anywhere: memory is waited for together.
  for (int i = 0; i < block->count; ++i) {
    const Light* light = &lights[block->index[i]];
    __builtin_prefetch(light);
    __builtin_prefetch(reinterpret_cast<const char*>(light + 1) - 1);
  }
  for (int i = 0; i < block->count; ++i) {
    block->lights[i] = prepared(lights[block->index[i]]);
  }
}

void prepareSpheres(const VirtualLights& lights, const Scene& scene,
                    const std::vector<PreparedSphere>& shared, uint32_t wanted, LightBlock* block) {
  block->sphereShading = lights.sphereShading;
  if (shared.empty()) block->ownSpheres.resize(kBlockLights);
  for (size_t i = 0; i < static_cast<size_t>(block->count); ++i) {
    block->spheres[i] = shared.empty() ? &block->ownSpheres[i] : &shared[block->index[i]];
    if (shared.empty() && (wanted >> i & 1))
      prepareSphere(scene, lights.spherical[block->index[i]], lights.specularLimit,
                    &block->ownSpheres[i]);
  }
  for (int i = 0; i < block->count; ++i) {
    const SphericalLight& light = lights.spherical[block->index[i]];
    const PreparedSphere& sphere = *block->spheres[i];
    PreparedLight& out = block->lights[i];
    out = {};
    out.p = light.p;
    out.reach.to = 0;
    if ((wanted >> i & 1) == 0) continue;
    out.n = sphere.disc.n;
    out.end = liftedEnd(light.p, out.n);
    out.endBehind = liftedEnd(light.p, -out.n);
    out.transmits = sphere.transmits;
    out.reach = reachOf(lights.sphereShading, light.radius);
    out.intensity = light.power / (kPi * sphere.squaredRadius);
  }
}

void preparePatterns(const std::vector<OmniLight>& lights, const Scene& scene, LightBlock* block) {
  for (int i = 0; i < block->count; ++i) {
    const uint32_t emitter = lights[block->index[i]].emitter;
    if (emitter == 0xffffffffu) continue;
    block->lights[i].pattern = static_cast<uint32_t>(block->patterns.size());
    block->patterns.emplace_back(scene, scene.emitters[emitter]);
  }
}

size_t upToDepth(const std::vector<uint32_t>& ends, size_t count, int depth) {
  if (depth < 0) return 0;
  const size_t d = static_cast<size_t>(depth);
  return d < ends.size() ? std::min<size_t>(ends[d], count) : count;
}

void prepareGaussians(const VirtualLights& lights, const std::vector<PreparedGaussian>& shared,
                      LightBlock* block) {
  block->gaussianShading = lights.gaussianShading;
  for (int i = 0; i < block->count; ++i) {
    const uint32_t index = block->index[i];
    PreparedGaussian& gaussian = block->gaussians[i];
    gaussian = shared.empty() ? prepareGaussian(lights.gaussian[index], lights.gaussianShading)
                              : shared[index];
    PreparedLight& out = block->lights[i];
    out = {};
    out.p = gaussian.mean;
    out.end = gaussian.ends[0];
    out.n = gaussian.diffuse.axis;
    out.cutoff = -gaussian.facingSine * std::abs(gaussian.facingSine);
    out.extent = gaussian.extent;
    out.intensity = Rgb(1.f);
  }
}

}  // namespace

Vec3f liftedEnd(Vec3f p, Vec3f n) { return offsetOrigin(p, n, positionError(p), n); }

float glossyCutoff(float sharpness) {
  // A little wider than where the exponent underflows, for the rounding of the cosine.
  const float c = sharpness > 0 ? 1 - 1.01f * kZeroExponent / sharpness - 1e-6f : -2.f;
  return c * std::abs(c);
}

uint16_t groupOf(const VirtualLights& lights, LightClass lightClass, size_t index) {
  const auto at = [&](const std::vector<uint16_t>& groups) {
    return groups.empty() ? uint16_t{0} : groups[index];
  };
  switch (lightClass) {
    case LightClass::omni:
      return at(lights.omniGroups);
    case LightClass::directional:
      return at(lights.directionalGroups);
    case LightClass::diffuse:
      return static_cast<uint16_t>(lights.diffuse[index].tag >> 8);
    case LightClass::spherical:
      return lights.spherical[index].group;
    case LightClass::gaussian:
      return lights.gaussian[index].group;
    case LightClass::glossy:
      break;
  }
  return at(lights.glossyGroups);
}

size_t lightCount(const VirtualLights& lights, LightClass lightClass) {
  switch (lightClass) {
    case LightClass::omni:
      return lights.omni.size();
    case LightClass::directional:
      return lights.directional.size();
    case LightClass::diffuse:
      return lights.diffuse.size();
    case LightClass::spherical:
      return lights.spherical.size();
    case LightClass::gaussian:
      return lights.gaussian.size();
    case LightClass::glossy:
      break;
  }
  return lights.glossy.size();
}

size_t lightsUpToDepth(const VirtualLights& lights, LightClass lightClass, int depth) {
  switch (lightClass) {
    case LightClass::omni:
    case LightClass::directional:
      return depth < 0 ? 0 : lightCount(lights, lightClass);
    case LightClass::diffuse:
      return upToDepth(lights.diffuseDepthEnds, lights.diffuse.size(), depth);
    case LightClass::spherical:
      return upToDepth(lights.sphericalDepthEnds, lights.spherical.size(), depth);
    case LightClass::gaussian:
      return upToDepth(lights.gaussianDepthEnds, lights.gaussian.size(), depth);
    case LightClass::glossy:
      break;
  }
  return upToDepth(lights.glossyDepthEnds, lights.glossy.size(), depth);
}

size_t emitterLightCount(const VirtualLights& lights, LightClass lightClass) {
  const auto first = [](const std::vector<uint32_t>& ends) {
    return ends.empty() ? size_t{0} : size_t{ends[0]};
  };
  switch (lightClass) {
    case LightClass::omni:
    case LightClass::directional:
      return lightCount(lights, lightClass);
    case LightClass::diffuse:
      return first(lights.diffuseDepthEnds);
    case LightClass::spherical:
      return first(lights.sphericalDepthEnds);
    case LightClass::gaussian:
      return first(lights.gaussianDepthEnds);
    case LightClass::glossy:
      break;
  }
  return first(lights.glossyDepthEnds);
}

PreparedLights prepareLights(const VirtualLights& lights, const Scene& scene, bool spheres) {
  constexpr size_t kMostBytes = size_t{512} << 20;
  PreparedLights prepared;
  if (spheres && lights.spherical.size() <= kMostBytes / sizeof(PreparedSphere)) {
    prepared.spheres.resize(lights.spherical.size());
    parallelFor(prepared.spheres.size(), 64, [&](size_t i) {
      prepareSphere(scene, lights.spherical[i], lights.specularLimit, &prepared.spheres[i]);
    });
  }
  if (lights.gaussian.size() <= kMostBytes / sizeof(PreparedGaussian)) {
    prepared.gaussians.resize(lights.gaussian.size());
    parallelFor(prepared.gaussians.size(), 64, [&](size_t i) {
      prepared.gaussians[i] = prepareGaussian(lights.gaussian[i], lights.gaussianShading);
    });
  }
  return prepared;
}

void prepare(const VirtualLights& lights, const Scene& scene, LightClass lightClass, size_t first,
             size_t count, LightBlock* block, const PreparedLights& shared, uint32_t wanted) {
  uint32_t indices[kBlockLights];
  count = std::min(count, kBlockLights);
  for (size_t i = 0; i < count; ++i) indices[i] = static_cast<uint32_t>(first + i);
  prepareChosen(lights, scene, lightClass, {indices, count}, block, shared, wanted);
}

void prepareChosen(const VirtualLights& lights, const Scene& scene, LightClass lightClass,
                   std::span<const uint32_t> indices, LightBlock* block,
                   const PreparedLights& shared, uint32_t wanted) {
  if (indices.size() > kBlockLights) throw std::invalid_argument("prepareChosen: too many");
  block->patterns.clear();
  block->rich = nullptr;
  block->depthMaps = nullptr;
  block->lightClass = lightClass;
  block->count = static_cast<int>(indices.size());
  std::copy(indices.begin(), indices.end(), block->index);
  switch (lightClass) {
    case LightClass::omni:
      prepareAll(lights.omni, block);
      return preparePatterns(lights.omni, scene, block);
    case LightClass::directional:
      return prepareAll(lights.directional, block);
    case LightClass::diffuse:
      return prepareAll(lights.diffuse, block);
    case LightClass::glossy:
      return prepareAll(lights.glossy, block);
    case LightClass::spherical:
      return prepareSpheres(lights, scene, shared.spheres, wanted, block);
    case LightClass::gaussian:
      return prepareGaussians(lights, shared.gaussians, block);
  }
}

}  // namespace lobelia::gather
