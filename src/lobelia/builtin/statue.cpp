// `statue`: a draped figure of polished stone on a pedestal, in the light of a hall, of the size of
// the statue in [P004 figure 9] (68,000 vertices; theirs is a scanned Hebe).
#include "lobelia/builtin/cupbearer.h"
#include "lobelia/builtin/hall_light.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/refine.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"

namespace lobelia::builtin {
namespace {

class Statue : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make() {
    const MaterialHandle marble = add(coated(Rgb(0.66f, 0.61f, 0.53f), 0.16f), "marble"),
                         granite = add(coated(Rgb(0.10f, 0.085f, 0.08f), 0.10f), "granite"),
                         floor = add(coated(Rgb(0.34f, 0.31f, 0.27f), 0.28f), "floor");
    addPedestal(granite);
    place(add(cupbearer(segments(164, 30)), "cupbearer"), translation({0, kPedestal, 0}), marble,
          "cupbearer");
    place(add(heightfield(6, 6, segments(80, 4), segments(80, 4), [](Vec2f) { return 0.f; }),
              "floor"),
          Mat4{}, floor, "floor");
    refine(scene(), kLongest / detail());
    addHallLight(*this, 95);
    addCamera("front", {1.3, 1.75, 4.2}, {-0.03, 1.42, 0}, 34, 800, 600);
    addCamera("bust", {0.55, 2.15, 1.5}, {-0.03, 1.95, 0.05}, 32, 800, 600);
    scene().integrator = "path";
    scene().maxDepth = 10;
    return take();
  }

 private:
  static constexpr double kPedestal = 0.62;
  static constexpr float kLongest = 0.11f;  // edge at detail 1

  void addPedestal(MaterialHandle stone) {
    const float height = static_cast<float>(kPedestal) - 0.10f;
    place(
        add(withProjectedUvs(roundedBox({0.42f, 0.05f, 0.42f}, 0.012f, segments(3, 1))), "plinth"),
        translation({0, 0.05, 0}), stone, "plinth");
    place(add(lathe({{0, 0},
                     {0.38f, 0},
                     {0.39f, 0.015f},
                     {0.38f, 0.035f},
                     {0.345f, 0.045f},
                     {0.325f, 0.075f},
                     {0.315f, 0.10f},
                     {0.315f, height - 0.11f},
                     {0.325f, height - 0.085f},
                     {0.35f, height - 0.06f},
                     {0.36f, height - 0.035f},
                     {0.36f, height - 0.01f},
                     {0.35f, height},
                     {0, height}},
                    segments(72, 12)),
              "drum"),
          translation({0, 0.10, 0}), stone, "drum");
  }
};

}  // namespace

Scene makeStatue(float detail) { return Statue(detail).make(); }

}  // namespace lobelia::builtin
