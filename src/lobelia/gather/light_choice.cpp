#include "lobelia/gather/light_choice.h"

#include <algorithm>

namespace lobelia::gather {
namespace {

size_t blocksOf(const LightRange& range) {
  return (range.size() + kBlockLights - 1) / kBlockLights;
}

template <class Light>
void take(const std::vector<Light>& from, const std::vector<uint16_t>* groups, Rgb Light::*power,
          const ChosenLight& choice, std::vector<Light>* to, std::vector<uint16_t>* toGroups) {
  to->push_back(from[choice.index]);
  to->back().*power *= choice.scale;
  if (groups != nullptr && !groups->empty()) toGroups->push_back((*groups)[choice.index]);
}

std::vector<uint32_t> endsAmong(const std::vector<uint32_t>& ends,
                                std::span<const ChosenLight> chosen, LightClass lightClass) {
  std::vector<uint32_t> out;
  for (const uint32_t end : ends) {
    const auto below = [&](const ChosenLight& c) {
      return c.lightClass == lightClass && c.index < end;
    };
    out.push_back(static_cast<uint32_t>(std::count_if(chosen.begin(), chosen.end(), below)));
  }
  return out;
}

}  // namespace

VirtualLights chooseLights(const VirtualLights& lights, std::span<const ChosenLight> chosen) {
  VirtualLights out;
  out.model = lights.model;
  out.groups = lights.groups;
  out.sceneHash = lights.sceneHash;
  out.seed = lights.seed;
  out.particles = lights.particles;
  out.maxDepth = lights.maxDepth;
  out.specularLimit = lights.specularLimit;
  out.direct = lights.direct;
  out.sphereShading = lights.sphereShading;
  out.gaussianShading = lights.gaussianShading;
  for (const ChosenLight& choice : chosen) {
    switch (choice.lightClass) {
      case LightClass::omni:
        take(lights.omni, &lights.omniGroups, &OmniLight::intensity, choice, &out.omni,
             &out.omniGroups);
        break;
      case LightClass::directional:
        take(lights.directional, &lights.directionalGroups, &DirectionalLight::irradiance, choice,
             &out.directional, &out.directionalGroups);
        break;
      case LightClass::diffuse:
        take(lights.diffuse, nullptr, &DiffuseLight::intensity, choice, &out.diffuse, nullptr);
        break;
      case LightClass::glossy:
        take(lights.glossy, &lights.glossyGroups, &GlossyLight::intensity, choice, &out.glossy,
             &out.glossyGroups);
        break;
      case LightClass::spherical:
        take(lights.spherical, nullptr, &SphericalLight::power, choice, &out.spherical, nullptr);
        break;
      case LightClass::gaussian:
        take(lights.gaussian, nullptr, &GaussianLight::diffuse, choice, &out.gaussian, nullptr);
        out.gaussian.back().glossy *= choice.scale;
        break;
    }
  }
  out.diffuseDepthEnds = endsAmong(lights.diffuseDepthEnds, chosen, LightClass::diffuse);
  out.glossyDepthEnds = endsAmong(lights.glossyDepthEnds, chosen, LightClass::glossy);
  out.sphericalDepthEnds = endsAmong(lights.sphericalDepthEnds, chosen, LightClass::spherical);
  out.gaussianDepthEnds = endsAmong(lights.gaussianDepthEnds, chosen, LightClass::gaussian);
  return out;
}

LightNumbers::LightNumbers(const VirtualLights& lights, const GatherSettings& settings) {
  for (const LightClass lightClass : kLightClasses) {
    LightRange& range = ranges_[static_cast<size_t>(lightClass)];
    range = rangeForDepth(lights, lightClass, settings, 1);
    count_ += range.size();
    blocks_ += blocksOf(range);
  }
}

LightNumbers::Block LightNumbers::block(size_t i) const {
  Block block;
  for (const LightClass lightClass : kLightClasses) {
    const LightRange& range = ranges_[static_cast<size_t>(lightClass)];
    const size_t blocks = blocksOf(range);
    if (i < blocks) {
      block.lightClass = lightClass;
      block.first = range.begin + i * kBlockLights;
      block.count = std::min(kBlockLights, range.end - block.first);
      block.number += i * kBlockLights;
      return block;
    }
    i -= blocks;
    block.number += range.size();
  }
  return block;
}

ChosenLight LightNumbers::at(size_t number) const {
  ChosenLight light;
  for (const LightClass lightClass : kLightClasses) {
    const LightRange& range = ranges_[static_cast<size_t>(lightClass)];
    light.lightClass = lightClass;
    light.index = range.begin + number;
    if (number < range.size()) return light;
    number -= range.size();
  }
  return light;
}

}  // namespace lobelia::gather
