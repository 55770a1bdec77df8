#include <fmt/format.h>

#include <cmath>

#include "lobelia/builtin/builtin_scenes.h"
#include "lobelia/builtin/makers.h"

namespace lobelia::builtin {
namespace {

struct Builtin {
  const char* name;
  Scene (*make)(float detail);
};
constexpr Builtin kBuiltins[] = {
    {"cornell", makeCornell},        {"study-diffuse", makeStudyDiffuse},
    {"study-phong", makeStudyPhong}, {"study-ggx", makeStudyGgx},
    {"study-pane", makeStudyPane},   {"study-mirror", makeStudyMirror},
    {"study-room", makeStudyRoom},
};

}  // namespace

std::vector<std::string> builtinSceneNames() {
  std::vector<std::string> names;
  for (const Builtin& builtin : kBuiltins) names.emplace_back(builtin.name);
  return names;
}

Scene builtinScene(const std::string& name, float detail) {
  if (!std::isfinite(detail) || detail < 0.05f || detail > 20)
    throw UsageError(fmt::format("detail {}: must be a number from 0.05 to 20", detail));
  for (const Builtin& builtin : kBuiltins)
    if (name == builtin.name) {
      Scene scene = builtin.make(detail);
      scene.name = name;
      return scene;
    }
  const std::vector<std::string> names = builtinSceneNames();
  throw UsageError(fmt::format("no built-in scene '{}'{}; there are: {}", name,
                               suggestion(name, names), fmt::join(names, ", ")));
}

}  // namespace lobelia::builtin
