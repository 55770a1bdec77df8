// Light groups: emitters that a picture keeps apart in layers of their own, so that they can be
// re-balanced without rendering again (`--aov groups`, `lobelia relight`).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lobelia/scene/scene.h"

namespace lobelia {

struct LightGroups {
  // The first is kDefaultGroup, of emitters without group (or with that very name); the others in
  // alphabetical order.
  std::vector<std::string> names;
  std::vector<uint16_t> ofEmitter;  // index into names; empty: every emitter is of the first
  std::vector<bool> used;           // has the group any emitter?

  size_t size() const { return names.size(); }
  uint16_t of(uint32_t emitter) const {
    return emitter < ofEmitter.size() ? ofEmitter[emitter] : uint16_t{0};
  }
  std::string layer(size_t group) const { return kLayerPrefix + names[group]; }

  static constexpr const char* kDefaultGroup = "default";
  static constexpr const char* kLayerPrefix = "group.";
};

// Throws InputError when there are more groups than 16 bits tell apart.
LightGroups lightGroups(const Scene& scene);

}  // namespace lobelia
