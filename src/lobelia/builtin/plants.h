// The table with plants of the built-in scene `plants` (internal to this room).
//
// Metres; x right, y up, z to the viewer. Plants root in the middle of the table's top.
#pragma once

#include "lobelia/base/random.h"
#include "lobelia/builtin/foliage.h"
#include "lobelia/builtin/scene_builder.h"

namespace lobelia::builtin {

class Plants : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make();

 private:
  static constexpr float kTop = 0.75f;  // height of the table's top

  void put(Mesh mesh, Vec3f at, MaterialHandle material, const std::string& name);
  float random(float low, float high);

  void addTable();
  void addFruit(Vec3f at);

  // Seen from both sides; lighter along the midrib and the side veins.
  MaterialHandle leafMaterial(Rgb color, Rgb vein, float alpha, const std::string& name);
  // A pot with its soil; plants root at the height that is returned, above `at`.
  float addPot(Vec3f at, float radius, float height, MaterialHandle material,
               const std::string& name);
  void putPlant(const Foliage& plant, MaterialHandle leaves, const std::string& name);
  void addFig(Vec3f at);
  void addFern(Vec3f at);
  void addDracaena(Vec3f at);
  void addIvy(Vec3f at);
  void addDaisies(Vec3f at);

  Rng rng_{4};
  MaterialHandle soil_, stem_, clay_, glaze_, white_;
};

}  // namespace lobelia::builtin
