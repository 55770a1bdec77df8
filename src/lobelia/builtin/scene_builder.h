// What every built-in scene is put together with (internal to this room): handles for what is
// added, materials by their everyday names.
#pragma once

#include <string>

#include "lobelia/base/transform.h"
#include "lobelia/scene/scene.h"

namespace lobelia::builtin {

// Index of refraction and absorption of metals at red, green and blue.
struct MetalConstants {
  Rgb eta, k;
};
inline constexpr MetalConstants kGold{{0.1431f, 0.3749f, 1.4424f}, {3.9831f, 2.3857f, 1.6032f}};
inline constexpr MetalConstants kSilver{{0.1552f, 0.1168f, 0.1383f}, {4.8284f, 3.1223f, 2.1470f}};
inline constexpr MetalConstants kCopper{{0.2004f, 0.9240f, 1.1022f}, {3.9129f, 2.4528f, 2.1421f}};
inline constexpr MetalConstants kAluminium{{1.6574f, 0.8803f, 0.5212f},
                                           {9.2239f, 6.2695f, 4.8370f}};
inline constexpr MetalConstants kSteel{{2.9f, 2.9f, 2.5f}, {3.1f, 3.2f, 3.0f}};

class SceneBuilder {
 public:
  explicit SceneBuilder(float detail) : detail_(detail) {}

  // Number of segments at detail 1, scaled, and never so few that the shape collapses.
  int segments(int atDetailOne, int least) const;
  float detail() const { return detail_; }

  MaterialHandle add(Material material, std::string name);
  TextureHandle add(Texture texture);
  TextureHandle add(Rgb constant);
  ImageHandle add(Image image);
  // An image that repeats every 1 / perUv of the texture coordinates.
  TextureHandle addBitmap(Image image, Vec2f perUv = {1, 1}, std::string name = {});
  // `material` on a surface whose height is `height` (0 to 1) times `metres`.
  MaterialHandle addBumped(Material material, TextureHandle height, float metres, std::string name);
  MeshHandle add(Mesh mesh, std::string name);
  EmitterHandle add(Emitter emitter, std::string name);
  // Returns the index of the instance.
  size_t place(MeshHandle mesh, const Mat4& toWorld, MaterialHandle material, std::string name,
               EmitterHandle emitter = {});
  void addCamera(std::string name, Vec3d eye, Vec3d target, double fovXDegrees, int width,
                 int height);

  // Local lights; intensity in W/sr. A spot's light is full within `beamDegrees` of its axis and
  // falls to nothing at `cutoffDegrees`.
  void addPoint(Vec3d at, Rgb intensity, std::string name);
  void addSpot(Vec3d at, Vec3d target, Rgb intensity, double beamDegrees, double cutoffDegrees,
               std::string name);

  static Material diffuse(ColorParam color);
  // A GGX coat of roughness alpha over a diffuse base (lacquer, glaze, varnish).
  static Material coated(ColorParam color, FloatParam alpha);
  static Material metal(const MetalConstants& constants, FloatParam alpha);
  static Material metal(const MetalConstants& constants, FloatParam alphaU, FloatParam alphaV);
  static Material phong(ColorParam diffuse, ColorParam specular, FloatParam exponent);
  static Material glass(float ior = 1.5f);

  Scene& scene() { return scene_; }
  const Mesh& mesh(MeshHandle handle) const { return scene_[handle]; }
  Scene take() { return std::move(scene_); }

 private:
  float detail_;
  Scene scene_;
};

// Translation that puts a mesh, turned by `turn`, with its lowest point onto `at`.
Mat4 standing(const Mesh& mesh, const Mat4& turn, Vec3d at);

}  // namespace lobelia::builtin
