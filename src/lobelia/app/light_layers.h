// Layers that take a picture's light apart: by light group (--aov groups), by kinds of light and
// receiver (--aov types), and what a pixel cost (--aov cost). The manual says what they hold.
#pragma once

#include <optional>

#include "lobelia/app/render_options.h"
#include "lobelia/film/film.h"
#include "lobelia/gather/gather.h"
#include "lobelia/scene/light_groups.h"

namespace lobelia::app {

// The layers of --aov types, in the order of GatherParts::types.
const std::vector<std::string>& typeLayers();

// Throws UsageError where a method cannot fill the layers that are asked for.
void requireLightLayers(const RenderOptions& options);
// Adds the layers that --aov groups, types and cost stand for.
void addLightLayers(const LightGroups& groups, const RenderOptions& options, Film& film);

// What gathered light adds to those layers.
class LightLayers {
 public:
  LightLayers(const LightGroups& groups, const RenderOptions& options, int sampleCount, Film& film);

  // What is to be gathered; empty: no parts are wanted.
  std::optional<GatherParts> wanted() const;
  // direct: light of emitters themselves, which is direct at a primary receiver.
  void add(const Receivers& receivers, const GatherParts& parts, bool direct);

 private:
  void addLayers(const Receivers& receivers, const std::vector<Rgb>& light,
                 const std::vector<Layer*>& layers, bool direct) const;

  Component component_;
  float costScale_;                     // rays are counted per sample
  std::vector<Layer*> groups_, types_;  // empty: not asked for; null: a group without emitters
  Layer* cost_ = nullptr;
};

Component componentOf(const RenderOptions& options);

}  // namespace lobelia::app
