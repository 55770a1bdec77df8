// `kitchen`, `kitchen-stove`, `kitchen-view2`: a glossy kitchen after the two that papers show it
// in: lit by the sun through the window and twenty point lights [P000 figure 7], and by the lamps
// above the stove alone, so that most light is indirect [P003 figures 1 and 6]; and one more
// lighting, the evening sky and the pendants over the island. Each has the cameras `main` and
// `second`.
#include "lobelia/builtin/kitchen_kit.h"
#include "lobelia/builtin/makers.h"

namespace lobelia::builtin {
namespace {

Scene make(float detail, KitchenLighting lighting) {
  KitchenKit kit(detail, lighting);
  kitchen::addRoom(kit);
  kitchen::addCabinets(kit);
  kitchen::addAppliances(kit);
  kitchen::addIsland(kit);
  kitchen::addCookware(kit);
  kitchen::addTableware(kit);
  kitchen::addFood(kit);
  kitchen::addTools(kit);
  kitchen::addLamps(kit);
  // Horizontal angles of lenses of 28 and 31 mm. The first camera is the one that is used.
  const auto main = [&] {
    kit.addCamera("main", {3.80, 1.46, 5.05}, {1.84, 1.03, 0.5}, 65, 800, 600);
  };
  const auto second = [&] {
    kit.addCamera("second", {0.95, 1.50, 2.55}, {2.55, 1.02, 0.30}, 60, 800, 600);
  };
  if (lighting != KitchenLighting::evening) main();
  second();
  if (lighting == KitchenLighting::evening) main();
  Scene scene = kit.take();
  scene.integrator = "path";
  scene.maxDepth = 16;
  return scene;
}

}  // namespace

Scene makeKitchen(float detail) { return make(detail, KitchenLighting::day); }
Scene makeKitchenStove(float detail) { return make(detail, KitchenLighting::stove); }
Scene makeKitchenView2(float detail) { return make(detail, KitchenLighting::evening); }

}  // namespace lobelia::builtin
