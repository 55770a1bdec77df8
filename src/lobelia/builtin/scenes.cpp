// The table of built-in scenes.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "lobelia/builtin/builtin_scenes.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/real_meshes.h"

namespace lobelia::builtin {
namespace {

template <TableauFloor floor>
Scene tableau(float detail) {
  return makeTableau(detail, floor);
}

template <int exponent>
Scene teapot(float detail) {
  return makeTeapot(detail, static_cast<float>(exponent));
}

constexpr BuiltinScene kBuiltins[] = {
    {"cornell", makeCornell, 51288, "A glossy Cornell box with a golden knot"},
    {"study-diffuse", makeStudyDiffuse, 9966, "Rounded box for studies: Lambert"},
    {"study-phong", makeStudyPhong, 9966, "Rounded box for studies: Phong"},
    {"study-ggx", makeStudyGgx, 9966, "Rounded box for studies: GGX metals and lacquer"},
    {"study-pane", makeStudyPane, 9976, "Rounded box for studies: lit through a glass pane"},
    {"study-mirror", makeStudyMirror, 9968, "Rounded box for studies: with a mirror"},
    {"study-corners", makeStudyCorners, 26, "Box with sharp corners for studies: Lambert [P003]"},
    {"study-ward", makeStudyWard, 26, "Box with sharp corners for studies: Ward [P003]"},
    {"box", makeBox, 135000, "Glossy Cornell box with a dragon and a flowered screen [P000]"},
    {"tableau", tableau<TableauFloor::constant>, 214600,
     "Three glossy sculptures on a glossy floor [P000]"},
    {"tableau-stripes", tableau<TableauFloor::stripes>, 214600,
     "tableau, the floor's gloss in stripes"},
    {"tableau-card", tableau<TableauFloor::card>, 214600, "tableau, the floor of printed card"},
    {"tableau-satin", tableau<TableauFloor::satin>, 214600, "tableau, the floor of satin"},
    {"tableau-ward", tableau<TableauFloor::ward>, 214600,
     "tableau, the floor of brushed metal [P003]"},
    {"treasure", makeTreasure, 928300, "A king's treasure in a hall [P000]"},
    {"kitchen", makeKitchen, 180000, "A kitchen, sun through the window and twenty lamps [P000]"},
    {"kitchen-stove", makeKitchenStove, 180000, "kitchen, lit by the lamps above the stove [P003]"},
    {"kitchen-view2", makeKitchenView2, 180000, "kitchen in the evening, a second view"},
    {"hall", makeHall, 38000, "A concert hall of curved metal sails in sun and sky [P003]"},
    {"glasses", makeGlasses, 155000, "Glossy drinking vessels on a glossy table [P002]"},
    {"bird", makeBird, 69000, "A glossy wren on a glossy table [P002]"},
    {"dragon", makeDragon, 152000, "A glossy dragon on a glossy base [P002]"},
    {"teapot", teapot<128>, 82700, "A teapot of Phong exponent 128 [P002]"},
    {"teapot-32", teapot<32>, 82700, "teapot, Phong exponent 32"},
    {"teapot-64", teapot<64>, 82700, "teapot, Phong exponent 64"},
    {"teapot-128", teapot<128>, 82700, "teapot, Phong exponent 128"},
    {"teapot-256", teapot<256>, 82700, "teapot, Phong exponent 256"},
    {"teapot-512", teapot<512>, 82700, "teapot, Phong exponent 512"},
    {"room", makeRoom, 144000, "A dining room lit by its lamps and candles [P004]"},
    {"statue", makeStatue, 136000, "A statue in folds of cloth, in the light of a hall [P004]"},
    {"machine", makeMachine, 218000, "A motorcycle in a studio [P004]"},
    {"plants", makePlants, 187000, "A table with potted plants and fruit [P004]"},
    {"teapot-lamp", makeTeapotLamp, 176000, "A teapot and cups in the light of two lamps [P004]"},
    {"dining", makeDining, 123000, "The dining room lit by a spot and point lights [P004]"},
    {"bedroom", makeBedroom, 212000,
     "A bedroom with daylight through its window and a lamp [P004]"},
    {"study-room", makeStudyRoom, 100354, "Closed wavy room for measuring rates of rays"},
};

}  // namespace

std::span<const BuiltinScene> builtinScenes() { return kBuiltins; }

std::vector<std::string> builtinSceneNames() {
  std::vector<std::string> names;
  for (const BuiltinScene& builtin : kBuiltins) names.emplace_back(builtin.name);
  return names;
}

Scene builtinScene(const std::string& name, float detail, const std::string& meshes) {
  if (!std::isfinite(detail) || detail < 0.05f || detail > 20)
    throw UsageError(fmt::format("detail {}: must be a number from 0.05 to 20", detail));
  for (const BuiltinScene& builtin : kBuiltins)
    if (name == builtin.name) {
      Scene scene = builtin.make(detail);
      scene.name = name;
      if (!meshes.empty()) useRealMeshes(scene, meshes);
      return scene;
    }
  const std::vector<std::string> names = builtinSceneNames();
  throw UsageError(fmt::format("no built-in scene '{}'{}; there are: {}", name,
                               suggestion(name, names), fmt::join(names, ", ")));
}

}  // namespace lobelia::builtin
