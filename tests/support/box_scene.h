// Small scenes for light-transport tests: a closed box of side 2 around the origin, white-grey
// diffuse walls, a square light under the ceiling that shines down, a camera at the front wall.
#pragma once

#include "lobelia/scene/scene.h"

namespace lobelia::test {

inline MaterialHandle addMaterial(Scene& scene, Material material) {
  scene.materials.push_back(std::move(material));
  return {static_cast<uint32_t>(scene.materials.size() - 1)};
}

inline Material diffuseMaterial(Rgb albedo) {
  Material m;
  m.type = MaterialType::diffuse;
  m.diffuse = albedo;
  return m;
}

// A parallelogram from `corner` along u and v; its normal is u x v.
inline size_t addQuad(Scene& scene, Vec3f corner, Vec3f u, Vec3f v, MaterialHandle material,
                      EmitterHandle emitter = {}) {
  Mesh mesh;
  mesh.positions = {corner, corner + u, corner + u + v, corner + v};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(std::move(mesh));
  Instance instance;
  instance.mesh = {static_cast<uint32_t>(scene.meshes.size() - 1)};
  instance.material = material;
  instance.emitter = emitter;
  scene.instances.push_back(std::move(instance));
  return scene.instances.size() - 1;
}

enum BoxWall : size_t { floorWall, ceilingWall, leftWall, rightWall, backWall, frontWall, lamp };

// Instances are numbered as BoxWall says; replace materials there.
inline Scene boxScene(bool withLamp = true) {
  Scene scene;
  scene.name = "box";
  const MaterialHandle grey = addMaterial(scene, diffuseMaterial({0.6f, 0.5f, 0.4f}));
  addQuad(scene, {-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, grey);
  addQuad(scene, {-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, grey);
  addQuad(scene, {-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, grey);
  addQuad(scene, {1, -1, -1}, {0, 0, 2}, {0, 2, 0}, grey);
  addQuad(scene, {-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, grey);
  addQuad(scene, {-1, -1, -1}, {2, 0, 0}, {0, 2, 0}, grey);
  if (withLamp) {
    Emitter light;
    light.type = EmitterType::area;
    light.radiance = Rgb(3, 4, 5);
    scene.emitters.push_back(light);
    addQuad(scene, {-0.6f, 0.98f, -0.6f}, {1.2f, 0, 0}, {0, 0, 1.2f},
            addMaterial(scene, diffuseMaterial(Rgb(0.f))), {0});
  }
  Camera camera;
  camera.toWorld = Transform(*lookAt({0, 0, -0.95}, {0, 0.3, 1}, {0, 1, 0}));
  camera.fovX = 1.4f;
  camera.width = 20;
  camera.height = 16;
  camera.filter = PixelFilter::box;
  scene.cameras.push_back(camera);
  return scene;
}

// Glass between two planes under the lamp: all light of the room comes through it.
inline void addPane(Scene& scene) {
  Material glass;
  glass.type = MaterialType::dielectric;
  glass.ior = 1.5f;
  const MaterialHandle handle = addMaterial(scene, glass);
  addQuad(scene, {-1, 0.85f, -1}, {2, 0, 0}, {0, 0, 2}, handle);  // faces down
  addQuad(scene, {-1, 0.9f, -1}, {0, 0, 2}, {2, 0, 0}, handle);   // faces up
}

}  // namespace lobelia::test
