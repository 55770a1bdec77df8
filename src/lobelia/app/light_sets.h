// The independent sets of virtual lights of a picture (--passes), made one after the other or read
// from a file.
#pragma once

#include <functional>

#include "lobelia/app/render_options.h"
#include "lobelia/gather/light_block.h"
#include "lobelia/lights/light_pass.h"

namespace lobelia::app {

// Lights on emitters themselves (--direct lights) and lights of bounces, gathered into different
// layers.
struct LightParts {
  VirtualLights direct, indirect;
  // All lights of those that others stand for, for the receivers near them.
  VirtualLights nearDirect, nearIndirect;
  // What all receivers gather.
  size_t size() const { return direct.size() + indirect.size(); }
};

// What statistics say about a set.
struct LightCounts {
  uint64_t byClass[std::size(gather::kLightClasses)] = {};
  uint64_t total = 0, bytes = 0, particles = 0;
};
LightCounts countLights(const VirtualLights& lights);

LightSettings lightSettings(const RenderOptions& options, int maxDepth, int set);
VirtualLights obtainLights(const Tracer& tracer, const EmitterSampler& emitters, int maxDepth,
                           int set, const RenderOptions& options, Context& context);
LightParts splitLights(VirtualLights lights);
// May receivers find near light by rays of their own? --near-lights with its default filled in.
bool combinesWithNearLights(const RenderOptions& options);
float nearLightsOf(const RenderOptions& options);
// Warns where --near-lights asks for more lights than there are.
void warnOfFewLights(const LightParts& lights, const RenderOptions& options, Context& context);
// EyeSettings::nearDistance with these lights (--near-lights).
std::function<float(Vec3f)> nearDistanceOf(const LightParts& lights, const RenderOptions& options);
// Samples per pixel with virtual lights.
int virtualLightSamples(const RenderOptions& options);
// How many sets the samples of a pixel share, and which of them a sample gathers.
int lightSetCount(const RenderOptions& options, int sampleCount);
int lightSetOf(int sample, int sampleCount, int setCount);
// Radius of spherical lights of a pass over the first pass' (progressive rendering).
float progressiveRadiusScale(int set);
SphereShading sphereShadingOf(const RenderOptions& options);
// --clamp; 0: off.
float clampValue(const RenderOptions& options, float sceneRadius);

}  // namespace lobelia::app
