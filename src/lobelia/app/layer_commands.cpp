#include "lobelia/app/layer_commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/option_checks.h"
#include "lobelia/film/color_map.h"
#include "lobelia/io/image_io.h"
#include "lobelia/scene/light_groups.h"

namespace lobelia::app {
namespace {

struct Scaling {
  std::string group;
  Rgb factor{1.f};
};

// NAME=SCALE or NAME=SCALE,R,G,B; a name may hold any character, '=' too.
Scaling parseScaling(const std::string& text) {
  const auto bad = [&]() -> UsageError {
    return UsageError(fmt::format(
        "--group '{}' is not of the form NAME=SCALE or NAME=SCALE,R,G,B, as in lamp=0.5,1,0.8,0.6",
        text));
  };
  const size_t equals = text.rfind('=');
  if (equals == std::string::npos || equals == 0) throw bad();
  std::vector<float> numbers;
  const char* p = text.data() + equals + 1;
  const char* end = text.data() + text.size();
  for (;;) {
    float value = 0;
    const auto [next, error] = std::from_chars(p, end, value);
    if (error != std::errc() || !std::isfinite(value)) throw bad();
    numbers.push_back(value);
    if (next == end) break;
    if (*next != ',') throw bad();
    p = next + 1;
  }
  if (numbers.size() != 1 && numbers.size() != 4) throw bad();
  if (std::any_of(numbers.begin(), numbers.end(), [](float n) { return n < 0; }))
    throw UsageError(
        fmt::format("--group '{}': light cannot be negative; 0 turns a group off", text));
  Scaling scaling{text.substr(0, equals), Rgb(numbers[0])};
  if (numbers.size() == 4) scaling.factor *= Rgb(numbers[1], numbers[2], numbers[3]);
  return scaling;
}

// "" among the layers is the picture.
std::vector<std::string> layerNames(const Film& film, const std::string& prefix) {
  std::vector<std::string> names;
  for (const auto& [name, layer] : film.layers)
    if (name.starts_with(prefix) && !name.empty()) names.push_back(name.substr(prefix.size()));
  return names;
}

void requirePng(const std::string& file) {
  if (std::filesystem::path(file).extension() != ".png")
    throw UsageError(fmt::format("-o {}: the picture is written as .png", file));
  requireWritable(file);
}

// Layers that are not sums of light, or are of the first surface, stay; others are no longer true.
bool survivesRelighting(const std::string& layer) {
  for (const char* name : {"", "albedo", "normal", "depth", "cost"})
    if (layer == name) return true;
  return layer.starts_with(LightGroups::kLayerPrefix);
}

}  // namespace

void addRelightOptions(CLI::App& c, RelightOptions& o) {
  c.add_option("image", o.image, "EXR rendered with --aov groups")->type_name("FILE")->required();
  c.add_option("--group", o.groups, "Factor of a light group, and a colour that multiplies it")
      ->type_name("NAME=SCALE[,R,G,B]")
      ->allow_extra_args(false);
  c.add_option("-o,--output", o.outputs, "Picture to write: .exr (with its groups), .png")
      ->type_name("FILE")
      ->required()
      ->allow_extra_args(false);
  c.add_option("--exposure", o.exposure, "Stops added to the PNG's automatic exposure")
      ->type_name("STOPS")
      ->check(finiteNumber(-100, 100));
}

ExitCode relight(const RelightOptions& options) {
  RenderOptions outputs;
  outputs.outputs = options.outputs;
  outputs.exposure = options.exposure;
  requireOutputs(outputs);
  std::vector<Scaling> scalings;
  for (const std::string& text : options.groups) scalings.push_back(parseScaling(text));

  Film film = io::readFilm(options.image);
  const std::vector<std::string> names = layerNames(film, LightGroups::kLayerPrefix);
  if (names.empty())
    throw InputError({options.image, 0, 0}, "has no light groups; render it with --aov groups");
  std::map<std::string, Rgb> factors;
  for (const Scaling& s : scalings) {
    if (std::find(names.begin(), names.end(), s.group) == names.end()) {
      throw UsageError(
          fmt::format("--group {}: the picture has no such light group; there are {}{}", s.group,
                      fmt::join(names, ", "), suggestion(s.group, names)));
    }
    if (!factors.emplace(s.group, s.factor).second)
      throw UsageError(fmt::format("--group {} is given twice", s.group));
  }
  std::erase_if(film.layers, [](const auto& layer) { return !survivesRelighting(layer.first); });
  std::vector<float>& picture = film.addLayer("").values;
  for (const std::string& name : names) {
    Layer& layer = film.layers.at(LightGroups::kLayerPrefix + name);
    if (layer.channels != 3)
      throw InputError({options.image, 0, 0}, fmt::format("light group '{}' has no colours", name));
    const auto found = factors.find(name);
    const Rgb factor = found == factors.end() ? Rgb(1.f) : found->second;
    for (size_t i = 0; i < picture.size(); ++i) {
      layer.values[i] *= factor[static_cast<int>(i % 3)];
      picture[i] += layer.values[i];
    }
  }
  film.metadata["lobelia:relight"] = fmt::format("{}", fmt::join(options.groups, " "));
  Context context;
  std::optional<ToneCurve> curve;
  writeOutputs(film, outputs, curve, context);
  return ExitCode::done;
}

void addShowOptions(CLI::App& c, ShowOptions& o) {
  c.add_option("image", o.image, "Image, mostly an EXR with layers")->type_name("FILE")->required();
  c.add_option("--layer", o.layer, "Layer to show; default: the picture")->type_name("NAME");
  c.add_flag("--false-colour,--false-color", o.falseColor,
             "Black (least) through colours to white (most); prints both values");
  c.add_option("--exposure", o.exposure, "Stops added to the automatic exposure")
      ->type_name("STOPS")
      ->check(finiteNumber(-100, 100));
  c.add_option("-o,--output", o.output, "Picture to write: .png")->type_name("FILE")->required();
}

ExitCode show(const ShowOptions& options) {
  requirePng(options.output);
  const Film film = io::readFilm(options.image);
  if (!film.layers.contains(options.layer)) {
    const std::vector<std::string> names = layerNames(film, "");
    if (names.empty())
      throw UsageError(fmt::format("--layer {}: {} has no layers; `render --aov` makes them",
                                   options.layer, options.image));
    throw UsageError(fmt::format("--layer {}: {} has no such layer; there are {}{}", options.layer,
                                 options.image, fmt::join(names, ", "),
                                 suggestion(options.layer, names)));
  }
  if (!options.falseColor) {
    const ToneCurve curve = measureToneCurve(film, {.exposure = options.exposure}, options.layer);
    io::writePng(options.output, toneMap(film, curve, options.layer), film.width, film.height);
    return ExitCode::done;
  }
  const FalseColors colors = falseColors(film, options.layer);
  io::writePng(options.output, colors.pixels, film.width, film.height);
  fmt::print("black {:.6g}\nwhite {:.6g}\n", colors.least, colors.most);
  return ExitCode::done;
}

}  // namespace lobelia::app
