// The motorcycle of the built-in scene `machine` (internal to this room).
//
// Metres; x ahead, y up, z to the rider's right. The wheels touch y = 0.
#pragma once

#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin {

class Machine : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make();

 private:
  static constexpr Vec3f kRearAxle{-0.70f, 0.32f, 0}, kFrontAxle{0.76f, 0.33f, 0};
  static constexpr Vec3f kGearbox{-0.17f, 0.34f, 0};  // the front sprocket's axis
  static constexpr float kChainZ = -0.105f, kRearSprocket = 0.100f, kFrontSprocket = 0.042f;

  // A cross-section of a hull: where, its centre's height, half height and half width.
  struct Station {
    float x, y, halfY, halfZ;
  };
  // A smooth closed body through stations along x; `squareness` 1: ellipses, towards 0: boxes.
  Mesh hull(const std::vector<Station>& stations, float squareness, int along, int around) const;
  // A round bar through points with rounded corners.
  Mesh bar(const std::vector<Vec3f>& points, float radius, float bend, int along,
           int around = 12) const;
  Mesh lathed(const std::vector<Vec2f>& profile, int around) const;
  void put(Mesh mesh, MaterialHandle material, const std::string& name, const Mat4& to = {});
  // On both sides, mirrored at z = 0.
  void putPair(const Mesh& mesh, MaterialHandle material, const std::string& name);

  void addMaterials();
  void addBody();
  void addControls();

  void addFrame();
  void addSuspension();

  void addWheel(Vec3f axle, float radius, float width, const std::string& name);
  void addMudguards();
  void addChain();

  void addEngine();
  void addCylinder(const Mat4& base, const std::string& name);
  void addExhaust();

  MaterialHandle paint_, chrome_, steel_, aluminium_, iron_, black_, rubber_, leather_, brass_,
      amber_, red_, lens_, floor_;
};

}  // namespace lobelia::builtin
