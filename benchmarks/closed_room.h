// A procedural closed room of about 100,000 triangles for benchmarks of rays: wavy walls, floor and
// ceiling, and spheres of several sizes that stand about.
#pragma once

#include <cmath>

#include "lobelia/base/random.h"
#include "lobelia/scene/scene.h"

namespace lobelia::benchmark_support {

// A grid of cells x cells quads spanned by u and v from a corner, displaced along n by waves that
// vanish at the border, so that the walls of a room stay closed.
inline Mesh wavyWall(Vec3f corner, Vec3f u, Vec3f v, Vec3f n, uint32_t cells, float height) {
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

inline Mesh sphere(Vec3f centre, float radius, uint32_t slices, uint32_t stacks) {
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

// 6 x 4 x 3 metres; z is up.
inline Scene closedRoom() {
  Scene scene;
  scene.name = "closed room";
  scene.materials.emplace_back();
  const auto add = [&](Mesh mesh) {
    Instance instance;
    instance.name = mesh.name;
    instance.mesh = {static_cast<uint32_t>(scene.meshes.size())};
    instance.material = {0};
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back(instance);
  };
  const Vec3f x{6, 0, 0}, y{0, 4, 0}, z{0, 0, 3};
  constexpr uint32_t kCells = 64;
  add(wavyWall({}, x, y, {0, 0, 1}, kCells, 0.05f));
  add(wavyWall(z, y, x, {0, 0, -1}, kCells, 0.05f));
  add(wavyWall({}, z, x, {0, 1, 0}, kCells, 0.05f));
  add(wavyWall(y, x, z, {0, -1, 0}, kCells, 0.05f));
  add(wavyWall({}, y, z, {1, 0, 0}, kCells, 0.05f));
  add(wavyWall(x, z, y, {-1, 0, 0}, kCells, 0.05f));
  Rng rng(11);
  for (int i = 0; i < 16; ++i) {
    const float radius = 0.1f + 0.35f * rng.next1D();
    const Vec2f at = rng.next2D();
    add(sphere({radius + at.x * (6 - 2 * radius), radius + at.y * (4 - 2 * radius),
                radius + rng.next1D() * 1.2f},
               radius, 64, 26));
  }
  return scene;
}

}  // namespace lobelia::benchmark_support
