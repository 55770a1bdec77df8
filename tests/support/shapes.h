// Small scenes for the tests of rays.
#pragma once

#include <cmath>

#include "lobelia/scene/scene.h"

namespace lobelia::test {

// A unit sphere of 2 * stacks * slices triangles about, wound outwards, with vertex normals.
inline Mesh sphereMesh(uint32_t slices, uint32_t stacks, bool smooth = false) {
  Mesh mesh;
  mesh.name = "sphere";
  for (uint32_t j = 0; j <= stacks; ++j) {
    for (uint32_t i = 0; i < slices; ++i) {
      const double theta = 3.14159265358979 * j / stacks, phi = 2 * 3.14159265358979 * i / slices;
      mesh.positions.emplace_back(static_cast<float>(std::sin(theta) * std::cos(phi)),
                                  static_cast<float>(std::sin(theta) * std::sin(phi)),
                                  static_cast<float>(std::cos(theta)));
    }
  }
  for (uint32_t j = 0; j < stacks; ++j) {
    for (uint32_t i = 0; i < slices; ++i) {
      const uint32_t k = (i + 1) % slices, a = j * slices, b = a + slices;
      if (j > 0) mesh.triangles.emplace_back(a + i, b + i, a + k);
      if (j + 1 < stacks) mesh.triangles.emplace_back(a + k, b + i, b + k);
    }
  }
  if (smooth) mesh.normals = mesh.positions;
  return mesh;
}

// The box between two corners; outward normals.
inline Mesh boxMesh(Vec3f lo, Vec3f hi) {
  Mesh mesh;
  mesh.name = "box";
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

// The unit square [0,1]^2 in z = 0, facing +z, with uvs equal to x and y.
inline Mesh squareMesh() {
  Mesh mesh;
  mesh.name = "square";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// Adds a mesh with one instance of the scene's material 0 (made when missing).
inline Instance& place(Scene& scene, Mesh mesh, const Mat4& toWorld = {}) {
  if (scene.materials.empty()) scene.materials.emplace_back();
  scene.meshes.push_back(std::move(mesh));
  Instance instance;
  instance.name = scene.meshes.back().name;
  instance.mesh = {static_cast<uint32_t>(scene.meshes.size() - 1)};
  instance.material = {0};
  instance.toWorld = Transform(toWorld);
  scene.instances.push_back(instance);
  return scene.instances.back();
}

}  // namespace lobelia::test
