// What the built-in kitchen is put together with (internal to this room): its materials, and the
// functions that add its parts.
//
// Metres; x right, y up, z towards the main camera. The room spans [0, kWidth] x [0, kHeight] x
// [0, kDepth]. The stove stands at the back wall (z = 0), the window is in the left wall (x = 0).
#pragma once

#include <map>

#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/scene_builder.h"

namespace lobelia::builtin {

struct KitchenPalette {
  MaterialHandle paint, ceiling, trim, floor, wallTiles, lacquer, pale, carcass, oak, walnut,
      marble, steel, steelUpright, chrome, brass, copper, tin, iron, enamel, redEnamel, blackGlass,
      glass, greenGlass, porcelain, blueGlaze, clay, black, cloth, curtain, leaf, orange, apple,
      lemon, pear, stalk, bread, pasta, coffee, paper, bulb, lining, steelDark;
};

enum class KitchenLighting { day, stove, evening };

class KitchenKit : public SceneBuilder {
 public:
  KitchenKit(float detail, KitchenLighting lighting);

  const KitchenPalette& palette() const { return palette_; }
  KitchenLighting lighting() const { return lighting_; }
  // place() with a name that is made unique by a number.
  void put(MeshHandle mesh, const Mat4& toWorld, MaterialHandle material, const std::string& name,
           EmitterHandle emitter = {});
  void put(Mesh mesh, const Mat4& toWorld, MaterialHandle material, const std::string& name);
  // A box from corner to corner with slightly rounded edges; texture coordinates in metres.
  Mesh boxMesh(Vec3f halfExtent, float radius = 0.002f) const;
  void box(Vec3f low, Vec3f high, MaterialHandle material, const std::string& name,
           float radius = 0.002f);

 private:
  void addMetals();
  void addMinerals();
  void addWoodsAndPaints();
  void addFood();

  KitchenPalette palette_;
  KitchenLighting lighting_;
  int large_, small_;  // pixels of textures
  std::map<std::string, int> names_;
};

namespace kitchen {

inline constexpr float kWidth = 4.8f, kHeight = 2.7f, kDepth = 5.8f;
inline constexpr float kWorktop = 0.92f;  // its upper side
// The window's hole in the left wall.
inline constexpr float kWindowLow = 1.08f, kWindowHigh = 2.28f, kWindowBack = 0.95f,
                       kWindowFront = 2.65f;
// The stove, and the hood above it.
inline constexpr float kStoveLeft = 1.54f, kStoveRight = 2.46f, kHoodLow = 1.68f;
inline constexpr float kShelfLow = 1.42f, kShelfHigh = 1.82f;  // upper sides
// The island's top.
inline constexpr Vec3f kIsland{2.5f, 0.94f, 2.75f};
inline constexpr float kIslandHalfX = 0.95f, kIslandHalfZ = 0.42f;

void addRoom(KitchenKit& kit);        // shell, window, curtains, clock, picture
void addCabinets(KitchenKit& kit);    // cabinets, worktops, sink, shelves
void addAppliances(KitchenKit& kit);  // stove, hood, fridge
void addIsland(KitchenKit& kit);      // island, stools
void addCookware(KitchenKit& kit);    // pots, pans, kettle, hanging utensils
void addTableware(KitchenKit& kit);   // plates, cups, glasses, bottles, jars
void addFood(KitchenKit& kit);        // fruit, bread, herbs
void addTools(KitchenKit& kit);       // knife block, boards, mills, toaster
void addLamps(KitchenKit& kit);       // lamps and their light, sun and sky

}  // namespace kitchen
}  // namespace lobelia::builtin
