#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "lobelia/app/commands.h"
#include "lobelia/app/data_info.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/app/load_scene.h"
#include "lobelia/io/scene_io.h"
#include "lobelia/scene/light_groups.h"

namespace lobelia::app {
namespace {

using Json = nlohmann::ordered_json;

const char* name(EmitterType type) {
  switch (type) {
    case EmitterType::area:
      return "area";
    case EmitterType::point:
      return "point";
    case EmitterType::spot:
      return "spot";
    case EmitterType::directional:
      return "directional";
    case EmitterType::constant:
      return "constant";
    case EmitterType::environment:
      return "environment";
    case EmitterType::projector:
      return "projector";
    case EmitterType::goniometric:
      return "goniometric";
    case EmitterType::sun:
      return "sun";
  }
  return "";
}

const char* name(Severity severity) {
  switch (severity) {
    case Severity::debug:
      return "debug";
    case Severity::info:
      return "info";
    case Severity::warning:
      return "warning";
    case Severity::error:
      return "error";
  }
  return "";
}

Json describe(const Bounds3f& box) {  // null: of nothing
  if (box.empty()) return nullptr;
  return {{"lo", {box.lo.x, box.lo.y, box.lo.z}}, {"hi", {box.hi.x, box.hi.y, box.hi.z}}};
}

// What designs may name, each once.
template <class T>
Json namesOf(const std::vector<T>& items) {
  Json names = Json::array();
  std::set<std::string> known;
  for (const T& item : items)
    if (!item.name.empty() && known.insert(item.name).second) names.push_back(item.name);
  return names;
}

Json describe(const Scene& scene) {
  Json emitters = Json::object();
  for (const Emitter& emitter : scene.emitters) {
    const std::string key = name(emitter.type);
    emitters[key] = emitters.value(key, 0) + 1;
  }
  Json groups = Json::array();
  const LightGroups lights = lightGroups(scene);
  for (size_t g = 0; g < lights.size(); ++g)
    if (lights.used[g]) groups.push_back(lights.names[g]);
  Json cameras = Json::array();
  for (const Camera& camera : scene.cameras) {
    cameras.push_back({{"name", camera.name}, {"width", camera.width}, {"height", camera.height}});
  }
  Json findings = Json::array();
  for (const Finding& finding : scene.findings) {
    findings.push_back({{"severity", name(finding.severity)},
                        {"where", toString(finding.where)},
                        {"message", finding.message}});
  }
  return {
      {"scene", scene.file.empty() ? scene.name : scene.file},
      {"triangles", triangleCount(scene)},
      {"meshes", scene.meshes.size()},
      {"instances", scene.instances.size()},
      {"materials", scene.materials.size()},
      {"textures", scene.textures.size()},
      {"images", scene.images.size()},
      {"emitters", emitters},
      {"light_groups", groups},
      {"cameras", cameras},
      {"variants", scene.variants},
      {"names", {{"materials", namesOf(scene.materials)}, {"emitters", namesOf(scene.emitters)}}},
      {"bounds", describe(bounds(scene))},
      {"max_depth", scene.maxDepth},
      {"hash", fmt::format("{:016x}", hash(scene))},
      {"findings", findings}};
}

std::string joined(const std::vector<std::string>& words) {
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

std::string cameraText(const Json& camera) {
  const std::string name = camera["name"];
  return fmt::format("{}{}x{}", name.empty() ? "" : name + " ", camera["width"].get<int>(),
                     camera["height"].get<int>());
}

// Of many, the first.
std::string namesText(const Json& names) {
  constexpr size_t kShown = 12;
  std::vector<std::string> words = names.get<std::vector<std::string>>();
  const size_t more = words.size() > kShown ? words.size() - kShown : 0;
  words.resize(words.size() - more);
  return joined(words) + (more > 0 ? fmt::format(" and {} more (--json)", more) : "");
}

// What the JSON says, for eyes.
std::string text(const std::string& key, const Json& value) {
  std::vector<std::string> words;
  if (key == "emitters") {
    for (const auto& [type, count] : value.items())
      words.push_back(fmt::format("{} {}", count.get<int>(), type));
    return joined(words);
  }
  if (key == "cameras") {
    for (const Json& camera : value) words.push_back(cameraText(camera));
    return joined(words);
  }
  if (key == "names")
    return fmt::format("materials {}; emitters {}", namesText(value["materials"]),
                       namesText(value["emitters"]));
  if (key == "bounds") {
    if (value.is_null()) return "empty";
    const auto corner = [](const Json& c) {
      return fmt::format("({:.6g}, {:.6g}, {:.6g})", c[0].get<float>(), c[1].get<float>(),
                         c[2].get<float>());
    };
    return corner(value["lo"]) + " to " + corner(value["hi"]);
  }
  if (key == "max_depth" && value.get<int>() < 0) return "unlimited";
  if (value.is_array()) return joined(value.get<std::vector<std::string>>());
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// Findings that say the same of several places are one line; --json has them all.
void printFindings(const Json& findings) {
  std::vector<std::pair<const Json*, size_t>> lines;
  std::map<std::pair<std::string, std::string>, size_t> known;
  for (const Json& finding : findings) {
    const auto [at, isNew] =
        known.try_emplace({finding["severity"], finding["message"]}, lines.size());
    if (isNew) lines.emplace_back(&finding, 0);
    ++lines[at->second].second;
  }
  for (const auto& [finding, count] : lines) {
    const std::string where = (*finding)["where"];
    fmt::print("{}: {}{}{}\n", (*finding)["severity"].get<std::string>(),
               where.empty() ? "" : where + ": ", (*finding)["message"].get<std::string>(),
               count > 1 ? fmt::format(" ({} times)", count) : "");
  }
}

void printText(const Json& json) {
  for (const auto& [key, value] : json.items())
    if (key != "findings") fmt::print("{:<12} {}\n", key, text(key, value));
  if (json.contains("findings")) printFindings(json["findings"]);
}

// Options of reading a scene, which data does not have.
void requireNone(const SceneOptions& options) {
  const SceneOptions none;
  if (!options.definitions.empty() || !options.environment.empty() || !options.sky.empty() ||
      !options.variant.empty() || !options.design.empty() || !options.meshes.empty() ||
      options.time != none.time || options.detail != none.detail || options.strict)
    throw UsageError(
        fmt::format("{} is data of `lobelia precompute`, not a scene: only --json goes with it",
                    options.scene));
}

}  // namespace

ExitCode info(const InfoOptions& options, const GlobalOptions&) {
  Console console(Verbosity::quiet);  // the findings are the output
  Context context(&console);
  std::optional<Json> data = describeData(options.scene.scene);
  if (data) requireNone(options.scene);
  const Json json = data ? std::move(*data) : describe(loadScene(options.scene, context));
  if (options.json) {
    fmt::print("{}\n", json.dump(2));
  } else {
    printText(json);
  }
  return ExitCode::done;
}

ExitCode convert(const ConvertOptions& options, const GlobalOptions& global) {
  Console console(global.verbosity());
  Context context(&console);
  requireWritableFolder(options.folder);
  io::writeMitsuba(options.folder, loadScene(options.scene, context));
  context.info(fmt::format("wrote {}/scene.xml", options.folder));
  return ExitCode::done;
}

}  // namespace lobelia::app
