// Scenes of the studies (`lobelia bench`): one box in several materials.
//
// The box is closed, but no two surfaces of it meet at a sharp edge: the edges of the room are
// rounded and the things in it float. Where surfaces touch at an angle, the geometry term of
// virtual lights grows as 1/d^2 and the variance of their sum has no bound; means over such
// pictures converge as N^(-1/3) and cannot be told from a bias of a percent in reasonable time.
// `study-corners` and `study-ward`, for figures 4 and 5 of [P003], have such edges on purpose.
//
// x right, y up, z to the viewer; the room spans [-1, 1]^3.
#include <algorithm>
#include <cmath>

#include "lobelia/builtin/closed_room.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia::builtin {
namespace {

Material metal(Rgb reflectance, float alpha) {
  Material m;
  m.specular = reflectance;
  m.type = MaterialType::conductor;
  if (alpha == 0) return m;
  m.type = MaterialType::roughConductor;
  m.distribution = Distribution::ggx;
  m.alphaU = m.alphaV = alpha;
  return m;
}
Material ward(Rgb base, Rgb specular, float alpha) {
  Material m;
  m.type = MaterialType::ward;
  m.diffuse = base;
  m.specular = specular;
  m.alphaU = m.alphaV = alpha;
  return m;
}
Material coated(Rgb base, float alpha) {
  Material m;
  m.type = MaterialType::roughPlastic;
  m.distribution = Distribution::ggx;
  m.diffuse = base;
  m.ior = 1.5f;
  m.alphaU = m.alphaV = alpha;
  return m;
}
constexpr float kRounding = 0.3f;

class StudyBox {
 public:
  explicit StudyBox(float detail) : detail_(detail) {}

  // window: the left wall has a hole of the size of its flat part.
  void addRoom(const Material& walls, const Material& left, const Material& right, bool window) {
    Mesh room = roundedBox(Vec3f(1.f), kRounding, scaled(6, 2));
    room.normals.clear();
    std::vector<Vec3u> triangles;
    for (const Vec3u t : room.triangles) {
      const bool inWindow = room.positions[t.x].x < -0.9999f && room.positions[t.y].x < -0.9999f &&
                            room.positions[t.z].x < -0.9999f;
      if (!window || !inWindow) triangles.emplace_back(t.x, t.z, t.y);  // seen from inside
    }
    room.triangles = std::move(triangles);
    add(std::move(room), Mat4(), walls, "room");
    const Mesh ball = revolve(
        [](float t) { return Vec2f(t <= 0 || t >= 1 ? 0 : std::sin(kPi * t), -std::cos(kPi * t)); },
        scaled(32, 8), scaled(64, 12));
    add(ball, translation({-0.4, -0.45, -0.3}) * scaling(Vec3d(0.35)), left, "left ball");
    add(ball, translation({0.4, -0.5, -0.1}) * scaling(Vec3d(0.28)), right, "right ball");
  }

  // Walls that meet at right angles, and a block that stands on the floor in a corner of its own.
  void addSharpRoom(const Material& walls, const Material& left, const Material& right) {
    const Mat4 onFloor = translation({0.35, -0.6, -0.35}) * rotation({0, 1, 0}, 25);
    const Mesh square = io::unitRectangle();
    add(square, translation({0, 0, -1}), walls, "back wall");
    add(square, translation({0, 0, 1}) * rotation({0, 1, 0}, 180), walls, "front wall");
    add(square, translation({0, -1, 0}) * rotation({1, 0, 0}, -90), walls, "floor");
    add(square, translation({0, 1, 0}) * rotation({1, 0, 0}, 90), walls, "ceiling");
    add(square, translation({-1, 0, 0}) * rotation({0, 1, 0}, 90), left, "left wall");
    add(square, translation({1, 0, 0}) * rotation({0, 1, 0}, -90), right, "right wall");
    add(io::unitCube(), onFloor * scaling({0.3, 0.4, 0.3}), walls, "block");
  }

  // A square of the given half side whose normal is +z before it is placed.
  void addLamp(const Mat4& toWorld, Rgb radiance) {
    Emitter emitter;
    emitter.type = EmitterType::area;
    emitter.name = "lamp";
    emitter.radiance = radiance;
    scene_.emitters.push_back(emitter);
    add(io::unitRectangle(), toWorld, SceneBuilder::diffuse(Rgb(0.f)), "lamp");
    scene_.instances.back().emitter = {0};
  }
  void addCeilingLamp() {
    addLamp(translation({0, 0.85, 0}) * rotation({1, 0, 0}, 90) * scaling(Vec3d(0.35)), Rgb(12.f));
  }
  void add(Mesh mesh, const Mat4& toWorld, Material material, const char* name) {
    mesh.name = material.name = name;
    Instance instance;
    instance.name = name;
    instance.mesh = {static_cast<uint32_t>(scene_.meshes.size())};
    instance.material = {static_cast<uint32_t>(scene_.materials.size())};
    instance.toWorld = Transform(toWorld);
    scene_.meshes.push_back(std::move(mesh));
    scene_.materials.push_back(std::move(material));
    scene_.instances.push_back(std::move(instance));
  }

  Scene finish() {
    Camera camera;
    camera.name = "front";
    camera.toWorld = Transform(*lookAt({0, 0, 0.92}, {0, -0.1, -1}, {0, 1, 0}));
    camera.fovX = 1.4f;
    camera.focusDistance = 1.9f;  // of the back wall
    camera.nearClip = 1e-3f, camera.farClip = 100;
    camera.width = camera.height = 256;
    camera.filter = PixelFilter::box;
    scene_.cameras.push_back(camera);
    scene_.integrator = "path";
    return std::move(scene_);
  }

 private:
  int scaled(int atDetailOne, int least) const {
    return std::max(least,
                    static_cast<int>(std::lround(static_cast<float>(atDetailOne) * detail_)));
  }
  float detail_;
  Scene scene_;
};

const Rgb kGrey(0.72f, 0.70f, 0.66f), kRed(0.62f, 0.10f, 0.07f), kBlue(0.10f, 0.18f, 0.55f);

}  // namespace

Scene makeStudyDiffuse(float detail) {
  StudyBox box(detail);
  box.addRoom(SceneBuilder::diffuse(kGrey), SceneBuilder::diffuse(kRed),
              SceneBuilder::diffuse(kBlue), false);
  box.addCeilingLamp();
  return box.finish();
}

Scene makeStudyPhong(float detail) {
  StudyBox box(detail);
  box.addRoom(SceneBuilder::phong(kGrey * 0.5f, Rgb(0.35f), 30),
              SceneBuilder::phong(kRed * 0.5f, Rgb(0.4f), 20),
              SceneBuilder::phong(kBlue * 0.5f, Rgb(0.4f), 50), false);
  box.addCeilingLamp();
  return box.finish();
}

Scene makeStudyGgx(float detail) {
  StudyBox box(detail);
  box.addRoom(metal(kGrey, 0.4f), metal({0.9f, 0.65f, 0.35f}, 0.2f), coated(kBlue, 0.3f), false);
  box.addCeilingLamp();
  return box.finish();
}

// All light comes through a slab of glass before the window.
Scene makeStudyPane(float detail) {
  StudyBox box(detail);
  box.addRoom(SceneBuilder::diffuse(kGrey), SceneBuilder::diffuse(kRed),
              SceneBuilder::diffuse(kBlue), true);
  box.addLamp(translation({-1.6, 0, 0}) * rotation({0, 1, 0}, 90) * scaling(Vec3d(0.8)), Rgb(6.f));
  box.add(io::unitCube(), translation({-1.06, 0, 0}) * scaling({0.02, 0.85, 0.85}),
          SceneBuilder::glass(), "pane");
  return box.finish();
}

Scene makeStudyMirror(float detail) {
  StudyBox box(detail);
  box.addRoom(SceneBuilder::diffuse(kGrey), SceneBuilder::diffuse(kRed),
              SceneBuilder::diffuse(kBlue), false);
  box.addCeilingLamp();
  box.add(io::unitRectangle(), translation({0, 0, -0.85}) * scaling({0.6, 0.6, 1}),
          metal(Rgb(0.9f), 0), "mirror");
  return box.finish();
}

Scene makeStudyCorners(float detail) {
  StudyBox box(detail);
  box.addSharpRoom(SceneBuilder::diffuse(kGrey), SceneBuilder::diffuse(kRed),
                   SceneBuilder::diffuse(kBlue));
  box.addCeilingLamp();
  return box.finish();
}

Scene makeStudyWard(float detail) {
  constexpr float kAlpha = 0.03f;  // of all surfaces, as in the paper
  StudyBox box(detail);
  box.addSharpRoom(ward(kGrey * 0.5f, Rgb(0.4f), kAlpha), ward(kRed * 0.5f, Rgb(0.4f), kAlpha),
                   ward(kBlue * 0.5f, Rgb(0.4f), kAlpha));
  box.addCeilingLamp();
  return box.finish();
}

Scene makeStudyRoom(float detail) { return closedRoom(RoomKind::mixed, detail); }

}  // namespace lobelia::builtin
