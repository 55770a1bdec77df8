// The table of built-in scenes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "lobelia/builtin/builtin_scenes.h"
#include "lobelia/builtin/makers.h"

namespace lobelia::builtin {
namespace {

template <TableauFloor floor>
Scene tableau(float detail) {
  return makeTableau(detail, floor);
}

constexpr BuiltinScene kBuiltins[] = {
    {"cornell", makeCornell, 51288, "A glossy Cornell box with a golden knot"},
    {"study-diffuse", makeStudyDiffuse, 9966, "Rounded box for studies: Lambert"},
    {"study-phong", makeStudyPhong, 9966, "Rounded box for studies: Phong"},
    {"study-ggx", makeStudyGgx, 9966, "Rounded box for studies: GGX metals and lacquer"},
    {"study-pane", makeStudyPane, 9976, "Rounded box for studies: lit through a glass pane"},
    {"study-mirror", makeStudyMirror, 9968, "Rounded box for studies: with a mirror"},
    {"box", makeBox, 135000, "Glossy Cornell box with a dragon and a flowered screen [P000]"},
    {"tableau", tableau<TableauFloor::constant>, 222000,
     "Three glossy sculptures on a glossy floor [P000]"},
    {"tableau-stripes", tableau<TableauFloor::stripes>, 222000,
     "tableau, the floor's gloss in stripes"},
    {"tableau-ward", tableau<TableauFloor::ward>, 222000,
     "tableau, the floor of brushed metal [P003]"},
    {"study-room", makeStudyRoom, 100354, "Closed wavy room for measuring rates of rays"},
};

}  // namespace

std::span<const BuiltinScene> builtinScenes() { return kBuiltins; }

std::vector<std::string> builtinSceneNames() {
  std::vector<std::string> names;
  for (const BuiltinScene& builtin : kBuiltins) names.emplace_back(builtin.name);
  return names;
}

Scene builtinScene(const std::string& name, float detail) {
  if (!std::isfinite(detail) || detail < 0.05f || detail > 20)
    throw UsageError(fmt::format("detail {}: must be a number from 0.05 to 20", detail));
  for (const BuiltinScene& builtin : kBuiltins)
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
