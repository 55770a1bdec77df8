#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "lobelia/app/commands.h"
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
  return {{"scene", scene.file.empty() ? scene.name : scene.file},
          {"triangles", triangleCount(scene)},
          {"meshes", scene.meshes.size()},
          {"instances", scene.instances.size()},
          {"materials", scene.materials.size()},
          {"textures", scene.textures.size()},
          {"images", scene.images.size()},
          {"emitters", emitters},
          {"light_groups", groups},
          {"cameras", cameras},
          {"bounds", describe(bounds(scene))},
          {"max_depth", scene.maxDepth},
          {"hash", fmt::format("{:016x}", hash(scene))},
          {"findings", findings}};
}

std::string text(const Json& value) {
  if (value.is_null()) return "empty";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

void printText(const Json& json) {
  for (const auto& [key, value] : json.items()) {
    if (key == "findings") continue;
    fmt::print("{:<10} {}\n", key, text(value));
  }
  for (const Json& finding : json["findings"]) {
    fmt::print("{}: {}: {}\n", finding["severity"].get<std::string>(),
               finding["where"].get<std::string>(), finding["message"].get<std::string>());
  }
}

}  // namespace

ExitCode info(const InfoOptions& options, const GlobalOptions&) {
  Console console(Verbosity::quiet);  // the findings are the output
  Context context(&console);
  const Json json = describe(loadScene(options.scene, context));
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
  io::writeMitsuba(options.folder, loadScene(options.scene, context));
  context.info(fmt::format("wrote {}/scene.xml", options.folder));
  return ExitCode::done;
}

}  // namespace lobelia::app
