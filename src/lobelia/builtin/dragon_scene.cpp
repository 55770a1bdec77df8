// `dragon`: the scaly dragon (dragon.cpp) on a glossy base, in the light of an environment, after
// the Dragon scene of [P002]: many small curved parts that reflect and hide each other. Phong
// exponents 64 and 128.
#include <algorithm>

#include "lobelia/builtin/creatures.h"
#include "lobelia/builtin/hall_light.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/refine.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/shapes.h"

namespace lobelia::builtin {
namespace {

class Dragon : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make() {
    const MaterialHandle skin = add(phong(Rgb(0.03f, 0.10f, 0.055f), Rgb(0.50f, 0.62f, 0.46f), 64),
                                    "skin"),
                         stone =
                             add(phong(Rgb(0.11f, 0.095f, 0.085f), Rgb(0.45f, 0.44f, 0.42f), 128),
                                 "stone");
    place(add(dragonStatue(segments(113, 24), 0.042f / std::min(detail(), 1.f)), "dragon"),
          rotation({0, 1, 0}, -32), skin, "dragon");
    place(add(refined(roundedBox({1.35f, 0.07f, 1.05f}, 0.03f, segments(4, 1)), 0.07f / detail()),
              "base"),
          translation({0, -0.07, 0}), stone, "base");
    addHallLight(*this, 60);
    addCamera("front", {-0.9, 1.75, 3.9}, {0.02, 0.66, 0}, 35, 800, 600);
    addCamera("head", {-2.3, 1.9, 1.9}, {-0.45, 0.95, 0.1}, 35, 800, 600);
    scene().integrator = "path";
    scene().maxDepth = 10;
    return take();
  }
};

}  // namespace

Scene makeDragon(float detail) { return Dragon(detail).make(); }

}  // namespace lobelia::builtin
