// The bedroom of the built-in scene `bedroom` (internal to this room).
//
// Metres; x right, y up, z to the viewer. The room spans [-2.1, 2.1] x [0, 2.6] x [-1.9, 2.2]; the
// window is in the left wall, the bed's head at the back wall.
#pragma once

#include "lobelia/builtin/scene_builder.h"

namespace lobelia::builtin {

class Bedroom : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make();

 private:
  static constexpr float kLeft = -2.1f, kRight = 2.1f, kBack = -1.9f, kFront = 2.2f, kHeight = 2.6f;
  // The window's opening.
  static constexpr float kSill = 0.95f, kLintel = 2.15f, kWindowBack = -0.85f, kWindowFront = 0.45f;
  // The bed: its middle, half its width, the top of the mattress, its ends.
  static constexpr float kBedX = -0.12f, kBedHalf = 0.80f, kBedTop = 0.52f, kBedHead = -1.80f,
                         kBedFoot = 0.25f;

  Mesh block(Vec3f half, float radius = 0.006f) const;
  void put(Mesh mesh, Vec3f at, MaterialHandle material, const std::string& name);
  MaterialHandle bothSides(MaterialHandle material, const std::string& name);

  void addMaterials();
  void addShell();
  void addWindow();
  void addCurtains();
  void addCupboard();
  void addNightstands();
  void addLights();

  void addBed();
  void addCover();
  void addPillows();

  MaterialHandle floor_, wood_, wall_, white_, sheet_, cover_, blanket_, curtain_, brass_, shade_,
      glaze_, red_;
};

}  // namespace lobelia::builtin
