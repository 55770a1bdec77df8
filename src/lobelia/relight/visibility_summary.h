// What a file of visibility cuts holds, without the scene that it is of.
#pragma once

#include <string>

#include "lobelia/relight/light_samples.h"

namespace lobelia::relight {

struct VisibilitySummary {
  uint64_t sceneHash = 0;  // geometryHash() of its scene
  LightSamples::Kind light = LightSamples::Kind::environment;
  size_t samples = 0, vertices = 0;
  size_t nodes = 0;  // of all cuts
};
// Throws InputError as load() does, but for the scene.
VisibilitySummary summaryOf(const std::string& file);
inline constexpr const char* kVisibilityKind = "visibility-cuts";  // store::kindOf() of such a file

}  // namespace lobelia::relight
