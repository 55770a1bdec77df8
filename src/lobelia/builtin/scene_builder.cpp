#include "lobelia/builtin/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lobelia::builtin {
namespace {

// Appends and returns the handle.
template <class Handle, class T>
Handle append(std::vector<T>& all, T item) {
  all.push_back(std::move(item));
  return {static_cast<uint32_t>(all.size() - 1)};
}

}  // namespace

int SceneBuilder::segments(int atDetailOne, int least) const {
  return std::max(least, static_cast<int>(std::lround(static_cast<float>(atDetailOne) * detail_)));
}

MaterialHandle SceneBuilder::add(Material material, std::string name) {
  material.name = std::move(name);
  return append<MaterialHandle>(scene_.materials, std::move(material));
}
TextureHandle SceneBuilder::add(Texture texture) {
  return append<TextureHandle>(scene_.textures, std::move(texture));
}
TextureHandle SceneBuilder::add(Rgb constant) {
  Texture texture;
  texture.value = constant;
  return add(texture);
}
ImageHandle SceneBuilder::add(Image image) {
  return append<ImageHandle>(scene_.images, std::move(image));
}
TextureHandle SceneBuilder::addBitmap(Image image, Vec2f perUv, std::string name) {
  if (!name.empty()) image.name = std::move(name);
  Texture texture;
  texture.type = TextureType::bitmap;
  texture.image = add(std::move(image));
  texture.uvMatrix[0][0] = perUv.x, texture.uvMatrix[1][1] = perUv.y;
  return add(std::move(texture));
}
MaterialHandle SceneBuilder::addBumped(Material material, TextureHandle height, float metres,
                                       std::string name) {
  Material bump;
  bump.type = MaterialType::bump;
  bump.a = add(std::move(material), fmt::format("{}, even", name));
  bump.map = height;
  bump.scale = metres;
  return add(std::move(bump), std::move(name));
}
MeshHandle SceneBuilder::add(Mesh mesh, std::string name) {
  mesh.name = std::move(name);
  return append<MeshHandle>(scene_.meshes, std::move(mesh));
}
EmitterHandle SceneBuilder::add(Emitter emitter, std::string name) {
  emitter.name = std::move(name);
  return append<EmitterHandle>(scene_.emitters, std::move(emitter));
}

size_t SceneBuilder::place(MeshHandle mesh, const Mat4& toWorld, MaterialHandle material,
                           std::string name, EmitterHandle emitter) {
  Instance instance;
  instance.mesh = mesh;
  instance.toWorld = Transform(toWorld);
  instance.material = material;
  instance.emitter = emitter;
  instance.name = std::move(name);
  scene_.instances.push_back(std::move(instance));
  return scene_.instances.size() - 1;
}

void SceneBuilder::addCamera(std::string name, Vec3d eye, Vec3d target, double fovXDegrees,
                             int width, int height) {
  Camera camera;
  camera.name = std::move(name);
  camera.toWorld = Transform(*lookAt(eye, target, {0, 1, 0}));
  camera.fovX = static_cast<float>(fovXDegrees * kPi / 180);
  const double distance = length(target - eye);
  camera.nearClip = static_cast<float>(distance * 1e-3);
  camera.farClip = static_cast<float>(distance * 1e3);
  camera.focusDistance = static_cast<float>(distance);
  camera.width = width, camera.height = height;
  camera.spp = 64;
  scene_.cameras.push_back(std::move(camera));
}

void SceneBuilder::addPoint(Vec3d at, Rgb intensity, std::string name) {
  Emitter point;
  point.type = EmitterType::point;
  point.radiance = intensity;
  point.toWorld = Transform(translation(at));
  add(point, std::move(name));
}

void SceneBuilder::addSpot(Vec3d at, Vec3d target, Rgb intensity, double beamDegrees,
                           double cutoffDegrees, std::string name) {
  const Vec3d way = target - at;
  const bool isUpright = std::abs(way.x) + std::abs(way.z) < 1e-3 * std::abs(way.y);
  Emitter spot;
  spot.type = EmitterType::spot;
  spot.radiance = intensity;
  spot.toWorld = Transform(*lookAt(at, target, isUpright ? Vec3d(0, 0, 1) : Vec3d(0, 1, 0)));
  spot.beamWidth = static_cast<float>(beamDegrees * kPi / 180);
  spot.cutoff = static_cast<float>(cutoffDegrees * kPi / 180);
  add(spot, std::move(name));
}

Material SceneBuilder::diffuse(ColorParam color) {
  Material m;
  m.type = MaterialType::diffuse;
  m.diffuse = color;
  return m;
}

Material SceneBuilder::coated(ColorParam color, FloatParam alpha) {
  Material m;
  m.type = MaterialType::roughPlastic;
  m.diffuse = color;
  m.ior = 1.5f;
  m.distribution = Distribution::ggx;
  m.alphaU = m.alphaV = alpha;
  m.nonlinear = true;
  return m;
}

Material SceneBuilder::metal(const MetalConstants& constants, FloatParam alpha) {
  return metal(constants, alpha, alpha);
}

Material SceneBuilder::metal(const MetalConstants& constants, FloatParam alphaU,
                             FloatParam alphaV) {
  Material m;
  m.type = MaterialType::roughConductor;
  m.eta = constants.eta, m.k = constants.k;
  m.distribution = Distribution::ggx;
  m.alphaU = alphaU, m.alphaV = alphaV;
  return m;
}

Material SceneBuilder::phong(ColorParam diffuse, ColorParam specular, FloatParam exponent) {
  Material m;
  m.type = MaterialType::phong;
  m.diffuse = diffuse;
  m.specular = specular;
  m.alphaU = m.alphaV = exponent;
  return m;
}

Material SceneBuilder::glass(float ior) {
  Material m;
  m.type = MaterialType::dielectric;
  m.ior = ior;
  return m;
}

Mat4 standing(const Mesh& mesh, const Mat4& turn, Vec3d at) {
  Bounds3f bounds;
  for (const Vec3f p : mesh.positions) bounds.add(turn.point(p));
  return translation({at.x, at.y - static_cast<double>(bounds.lo.y), at.z}) * turn;
}

}  // namespace lobelia::builtin
