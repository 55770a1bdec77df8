#include "lobelia/app/load_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "lobelia/builtin/builtin_scenes.h"
#include "lobelia/io/design.h"
#include "lobelia/io/scene_io.h"

namespace lobelia::app {
namespace {

std::string describe(const Finding& finding) {
  return finding.where.file.empty() ? finding.message
                                    : toString(finding.where) + ": " + finding.message;
}

io::ReadSettings readSettings(const SceneOptions& options) {
  io::ReadSettings settings;
  settings.strict = options.strict;
  settings.environment = options.environment;
  settings.sky = options.sky;
  settings.time = options.time;
  settings.variant = options.variant;
  for (const std::string& definition : options.definitions) {
    const size_t equals = definition.find('=');
    if (equals == std::string::npos || equals == 0) {
      throw UsageError(fmt::format("-D {}: not name=value, as in -D spp=64", definition));
    }
    settings.definitions[definition.substr(0, equals)] = definition.substr(equals + 1);
  }
  return settings;
}

// Of a file that is not there: its folder, or a file of nearly the same name in it.
[[noreturn]] void throwMissing(const std::string& name) {
  namespace fs = std::filesystem;
  const fs::path file(name), folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error))
    throw InputError({name}, fmt::format("there is no folder '{}'", folder.string()));
  std::vector<std::string> others;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    others.push_back(it->path().filename().string());
  std::sort(others.begin(), others.end());
  throw InputError({name}, fmt::format("there is no such file in '{}'{}; built-in scenes are "
                                       "named without a suffix",
                                       fs::weakly_canonical(folder, error).string(),
                                       suggestion(file.filename().string(), others)));
}

// A file goes before a built-in scene of the same name.
bool isBuiltin(const std::string& name) {
  std::error_code error;  // of folders that may not be looked into: reading will say so
  const std::filesystem::file_status status = std::filesystem::status(name, error);
  if (std::filesystem::is_directory(status))
    throw InputError({name}, "is a folder; name the scene file in it");
  if (std::filesystem::exists(status) || error == std::errc::permission_denied) return false;
  const std::vector<std::string> names = builtin::builtinSceneNames();
  if (std::find(names.begin(), names.end(), name) != names.end()) return true;
  if (std::filesystem::path(name).has_extension()) throwMissing(name);
  throw InputError({}, fmt::format("'{}' is neither a file nor a built-in scene; there are {}{}",
                                   name, fmt::join(names, ", "), suggestion(name, names)));
}

}  // namespace

void reportFindings(std::span<const Finding> findings, Context& context) {
  constexpr size_t shown = 10;
  size_t warnings = 0;
  for (const Finding& finding : findings) {
    if (finding.severity != Severity::warning) {
      context.debug(describe(finding));
    } else if (++warnings <= shown) {
      context.warning(describe(finding));
    } else {
      context.debug(describe(finding));
    }
  }
  if (warnings > shown) {
    context.warning(
        fmt::format("{} more warnings; `lobelia info` lists them all", warnings - shown));
  }
}

Scene loadScene(const SceneOptions& options, Context& context) {
  const StageTimer timer(context, "load");
  const io::ReadSettings settings = readSettings(options);
  Scene scene;
  if (isBuiltin(options.scene)) {
    if (!settings.definitions.empty()) throw UsageError("-D: built-in scenes have no definitions");
    if (!settings.variant.empty())
      throw UsageError("--variant: built-in scenes have no material variants");
    if (settings.time != 0) throw UsageError("--time: built-in scenes do not move");
    scene = builtin::builtinScene(options.scene, options.detail, options.meshes);
    io::applyEnvironment(scene, settings);
  } else {
    if (!options.meshes.empty())
      throw UsageError("--meshes: only built-in scenes have stand-ins for real meshes");
    if (options.detail != 1) throw UsageError("--detail: only built-in scenes have it");
    scene = io::readScene(options.scene, settings, context);
  }
  if (!options.design.empty()) io::applyDesign(options.design, settings, scene, context);
  if (context.cancelled()) throw Cancelled{};  // and no judgement of half a scene
  for (Finding& finding : validate(scene)) {
    if (finding.where.file.empty()) finding.where.file = scene.file;
    scene.findings.push_back(std::move(finding));
  }
  for (const Finding& finding : scene.findings) {
    const bool fatal = finding.severity == Severity::error ||
                       (options.strict && finding.severity == Severity::warning);
    if (fatal) throw InputError(finding.where, finding.message);
  }
  if (scene.cameras.empty()) {
    throw InputError({options.scene, 0, 0}, "the scene has no camera; add a <sensor>");
  }
  reportFindings(scene.findings, context);
  return scene;
}

}  // namespace lobelia::app
