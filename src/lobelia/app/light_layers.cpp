#include "lobelia/app/light_layers.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/sampled_film.h"
#include "lobelia/app/vsgl_options.h"
#include "lobelia/base/error.h"

namespace lobelia::app {
namespace {

bool asked(const RenderOptions& options, const std::string& name) {
  const std::vector<std::string> layers = requestedLayers(options);
  return std::find(layers.begin(), layers.end(), name) != layers.end();
}

Layer* find(Film& film, const std::string& name) {
  const auto it = film.layers.find(name);
  return it == film.layers.end() ? nullptr : &it->second;
}

}  // namespace

const std::vector<std::string>& typeLayers() {
  static const std::vector<std::string> names{"od", "os", "nd", "ns", "dd", "ds",
                                              "sd", "ss", "vd", "vs", "gd", "gs"};
  static_assert(GatherParts::kTypes == 12);
  return names;
}

Component componentOf(const RenderOptions& options) {
  return options.component == "direct"     ? Component::direct
         : options.component == "indirect" ? Component::indirect
                                           : Component::all;
}

void requireLightLayers(const RenderOptions& options) {
  const bool virtualLights =
      options.lights != "path" && options.lights != "light" && options.lights != "photon";
  if (!virtualLights && asked(options, "types")) {
    throw UsageError(
        fmt::format("--aov types takes virtual lights apart and --lights {} has none; use vpl, "
                    "glossy, vsl or vsgl",
                    options.lights));
  }
  if (shadowRaysOf(options) > 0 &&
      (asked(options, "types") || asked(options, "groups") || asked(options, "cost"))) {
    throw UsageError(fmt::format(
        "--aov groups, types and cost need a shadow ray to every light; --vsgl-shadows {} traces "
        "some; leave it out",
        options.vsglShadows));
  }
  if (options.lights == "vsl" && options.sphereSampling != "product" && asked(options, "types")) {
    throw UsageError(fmt::format(
        "--aov types needs --vsl-sampling product; {} integrates a material's lobes together",
        options.sphereSampling));
  }
  if (options.lights == "light" && asked(options, "cost"))
    throw UsageError("--aov cost: the particles of --lights light belong to no pixel");
}

void addLightLayers(const LightGroups& groups, const RenderOptions& options, Film& film) {
  if (asked(options, "groups"))
    for (size_t g = 0; g < groups.size(); ++g)
      if (groups.used[g]) film.addLayer(groups.layer(g));
  if (asked(options, "types"))
    for (const std::string& name : typeLayers()) film.addLayer(name);
  if (asked(options, "cost")) film.addLayer("cost", 1);
}

LightLayers::LightLayers(const LightGroups& groups, const RenderOptions& options, int sampleCount,
                         Film& film)
    : component_(componentOf(options)),
      costScale_(1 / static_cast<float>(sampleCount)),
      cost_(find(film, "cost")) {
  for (size_t g = 0; g < groups.size(); ++g) groups_.push_back(find(film, groups.layer(g)));
  if (std::count(groups_.begin(), groups_.end(), nullptr) == std::ssize(groups_)) groups_.clear();
  for (const std::string& name : typeLayers())
    if (Layer* layer = find(film, name)) types_.push_back(layer);
}

std::optional<GatherParts> LightLayers::wanted() const {
  if (groups_.empty() && types_.empty() && cost_ == nullptr) return {};
  GatherParts parts;
  parts.groupCount = groups_.size();
  parts.byType = !types_.empty();
  parts.countRays = cost_ != nullptr;
  return parts;
}

void LightLayers::add(const Receivers& receivers, const GatherParts& parts, bool direct) {
  addLayers(receivers, parts.groups, groups_, direct);
  addLayers(receivers, parts.types, types_, direct);
  for (size_t i = 0; i < parts.rays.size(); ++i)
    cost_->values[receivers.points[i].pixel] += static_cast<float>(parts.rays[i]) * costScale_;
}

void LightLayers::addLayers(const Receivers& receivers, const std::vector<Rgb>& light,
                            const std::vector<Layer*>& layers, bool direct) const {
  if (light.empty()) return;
  const size_t points = receivers.points.size();
  for (size_t k = 0; k < layers.size(); ++k) {
    if (layers[k] == nullptr) continue;
    for (size_t i = 0; i < points; ++i) {
      const ReceiverPoint& point = receivers.points[i];
      const Component hidden = direct && point.primary ? Component::indirect : Component::direct;
      if (component_ == hidden) continue;
      addTo(*layers[k], point.pixel, light[k * points + i]);
    }
  }
}

}  // namespace lobelia::app
