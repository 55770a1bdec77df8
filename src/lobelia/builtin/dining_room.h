// The dining room of the built-in scenes `room` and `dining` (internal to this room).
//
// Metres; x right, y up, z to the viewer. The room spans [-2.6, 2.6] x [0, 2.7] x [-2.2, 2.6].
#pragma once

#include "lobelia/builtin/scene_builder.h"

namespace lobelia::builtin {

// What lights it: bulbs, globes and flames that glow, or a spot and point lights in their places.
enum class DiningLight : uint8_t { glow, points };

class DiningRoom : SceneBuilder {
 public:
  DiningRoom(float detail, DiningLight light) : SceneBuilder(detail), light_(light) {}

  Scene make();

 private:
  static constexpr double kLeft = -2.6, kRight = 2.6, kBack = -2.2, kFront = 2.6, kHeight = 2.7;
  static constexpr float kTable = 0.76f;  // height of the table's top
  static constexpr double kTableTop = 0.76;

  // A turned thing. `dining` has few rows for its fine profiles, so normals are the faces' there.
  Mesh turned(const std::vector<Vec2f>& profile, int rows, int around) const;
  Mesh block(Vec3f half, float radius) const;
  void put(Mesh mesh, Vec3d at, MaterialHandle material, const std::string& name);
  // Makes what it is given to glow; nothing in a room lit by points.
  EmitterHandle glow(Rgb radiance, const std::string& name);

  void addMaterials();
  void addShell();
  // Along a wall of the given half length whose frame has x along and z out of it.
  void addPanels(const Mat4& wall, double half, const char* side);
  void addLamps();
  void addPoints();
  void addCurtains();  // drawn, on the left wall, and a rod

  // Furniture.
  Mesh leg(float height, float thick) const;  // a turned one, from the floor up
  void addTable();
  void addChairs();
  void addSideboard();
  void addMirror();

  // What stands on it.
  void addPlaces();
  void candle(Vec3d at, double height, const std::string& name);
  void addCentre();

  DiningLight light_;
  MaterialHandle floor_, wood_, wall_, panel_, ceiling_, brass_, silver_, porcelain_, glaze_,
      leather_, crystal_, linen_, curtain_, wax_, black_;
  MeshHandle stick_, candle_, flame_;
  EmitterHandle glow_;
};

}  // namespace lobelia::builtin
