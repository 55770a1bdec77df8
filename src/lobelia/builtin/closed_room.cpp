#include "lobelia/builtin/closed_room.h"

#include <cmath>

#include "lobelia/base/random.h"

namespace lobelia::builtin {
namespace {

constexpr size_t kWalls = 6;

uint32_t scaled(uint32_t atDetailOne, uint32_t least, float detail) {
  return std::max(least, static_cast<uint32_t>(
                             std::lround(static_cast<float>(atDetailOne) * std::sqrt(detail))));
}

Mesh facetedSphere(Vec3f centre, float radius, uint32_t slices, uint32_t stacks) {
  Mesh mesh;
  mesh.name = "sphere";
  for (uint32_t j = 0; j <= stacks; ++j) {
    for (uint32_t i = 0; i < slices; ++i) {
      const float theta = kPi * static_cast<float>(j) / static_cast<float>(stacks);
      const float phi = kTwoPi * static_cast<float>(i) / static_cast<float>(slices);
      mesh.positions.push_back(centre + Vec3f{std::sin(theta) * std::cos(phi),
                                              std::sin(theta) * std::sin(phi), std::cos(theta)} *
                                            radius);
    }
  }
  for (uint32_t j = 0; j < stacks; ++j) {
    for (uint32_t i = 0; i < slices; ++i) {
      const uint32_t k = (i + 1) % slices, a = j * slices, b = a + slices;
      if (j > 0) mesh.triangles.emplace_back(a + i, b + i, a + k);
      if (j + 1 < stacks) mesh.triangles.emplace_back(a + k, b + i, b + k);
    }
  }
  return mesh;
}

void add(Scene& scene, Mesh mesh) {
  Instance instance;
  instance.name = mesh.name;
  instance.mesh = {static_cast<uint32_t>(scene.meshes.size())};
  instance.material = {0};
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back(std::move(instance));
}

void addGeometry(Scene& scene, float detail) {
  const Vec3f x{6, 0, 0}, y{0, 4, 0}, z{0, 0, 3};
  const uint32_t cells = scaled(64, 8, detail);
  add(scene, wavyWall({}, x, y, {0, 0, 1}, cells, 0.05f));
  add(scene, wavyWall(z, y, x, {0, 0, -1}, cells, 0.05f));
  add(scene, wavyWall({}, z, x, {0, 1, 0}, cells, 0.05f));
  add(scene, wavyWall(y, x, z, {0, -1, 0}, cells, 0.05f));
  add(scene, wavyWall({}, y, z, {1, 0, 0}, cells, 0.05f));
  add(scene, wavyWall(x, z, y, {-1, 0, 0}, cells, 0.05f));
  Rng rng(11);
  for (int i = 0; i < 16; ++i) {
    const float radius = 0.1f + 0.35f * rng.next1D();
    const Vec2f at = rng.next2D();
    add(scene, facetedSphere({radius + at.x * (6 - 2 * radius), radius + at.y * (4 - 2 * radius),
                              radius + rng.next1D() * 1.2f},
                             radius, scaled(64, 8, detail), scaled(26, 4, detail)));
  }
}

void addLight(Scene& scene, RoomKind kind) {
  Emitter lamp;
  lamp.type = EmitterType::area;
  lamp.name = "lamp";
  lamp.radiance = Rgb(10);
  scene.emitters.push_back(lamp);
  if (kind == RoomKind::manyLights) {
    for (size_t i = kWalls; i < scene.instances.size(); ++i) scene.instances[i].emitter = {0};
    return;
  }
  Mesh mesh;
  mesh.name = "lamp";
  mesh.positions = {{2, 1, 2.9f}, {2, 3, 2.9f}, {4, 3, 2.9f}, {4, 1, 2.9f}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  add(scene, std::move(mesh));
  scene.instances.back().emitter = {0};
}

void addMaterials(Scene& scene, RoomKind kind) {
  Material lambert, metal, coat;
  lambert.name = "lambert";
  lambert.diffuse = Rgb(0.7f);
  metal.name = "metal";
  metal.type = MaterialType::roughConductor;
  metal.distribution = Distribution::ggx;
  metal.alphaU = metal.alphaV = 0.2f;
  metal.specular = Rgb(0.8f);
  coat.name = "coat";
  coat.type = MaterialType::roughPlastic;
  coat.distribution = Distribution::ggx;
  coat.alphaU = coat.alphaV = 0.2f;
  scene.materials = {lambert, metal, coat};
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    uint32_t& material = scene.instances[i].material.index;
    if (kind == RoomKind::ggx) material = 1;
    if (kind == RoomKind::plastic) material = 2;
    if (kind == RoomKind::mixed) material = static_cast<uint32_t>(i) % 3;
  }
}

}  // namespace

Mesh wavyWall(Vec3f corner, Vec3f u, Vec3f v, Vec3f n, uint32_t cells, float height) {
  Mesh mesh;
  mesh.name = "wall";
  for (uint32_t j = 0; j <= cells; ++j) {
    for (uint32_t i = 0; i <= cells; ++i) {
      const float s = static_cast<float>(i) / static_cast<float>(cells);
      const float t = static_cast<float>(j) / static_cast<float>(cells);
      const bool border = i == 0 || j == 0 || i == cells || j == cells;
      const float wave =
          border ? 0.f : height * std::abs(std::sin(kPi * s * 8) * std::sin(kPi * t * 8));
      mesh.positions.push_back(corner + u * s + v * t + n * wave);
    }
  }
  for (uint32_t j = 0; j < cells; ++j) {
    for (uint32_t i = 0; i < cells; ++i) {
      const uint32_t a = j * (cells + 1) + i, b = a + cells + 1;
      mesh.triangles.emplace_back(a, a + 1, b + 1);
      mesh.triangles.emplace_back(a, b + 1, b);
    }
  }
  return mesh;
}

Scene closedRoom(RoomKind kind, float detail) {
  Scene scene;
  scene.name = "closed room";
  addGeometry(scene, detail);
  addMaterials(scene, kind);
  addLight(scene, kind);
  Camera camera;
  camera.name = "wall";
  camera.toWorld = Transform(*lookAt({0.3, 2, 1.6}, {3, 2, 1.2}, {0, 0, 1}));
  camera.fovX = 1.2f;
  camera.width = 1024, camera.height = 768;
  camera.filter = PixelFilter::box;
  camera.focusDistance = camera.farClip;
  scene.cameras.push_back(camera);
  return scene;
}

}  // namespace lobelia::builtin
