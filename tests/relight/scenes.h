// Small scenes for visibility cuts: an open ground with a ball above it, and what goes with them.
#pragma once

#include "lobelia/trace/tracer.h"
#include "support/box_scene.h"
#include "support/shapes.h"

namespace lobelia::test {

// The square [-1, 1]^2 in z = 0 as cells x cells quads, facing +z.
inline Mesh groundMesh(uint32_t cells) {
  Mesh mesh;
  mesh.name = "ground";
  const auto at = [&](uint32_t i) {
    return 2 * static_cast<float>(i) / static_cast<float>(cells) - 1;
  };
  for (uint32_t y = 0; y <= cells; ++y)
    for (uint32_t x = 0; x <= cells; ++x) mesh.positions.emplace_back(at(x), at(y), 0.f);
  for (uint32_t y = 0; y < cells; ++y)
    for (uint32_t x = 0; x < cells; ++x) {
      const uint32_t a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
      mesh.triangles.emplace_back(a, b, d);
      mesh.triangles.emplace_back(a, d, c);
    }
  return mesh;
}

// A ball of radius 0.3 half a unit above the ground. Instances: ground, ball.
inline Scene ballScene(uint32_t cells = 12) {
  Scene scene;
  scene.name = "ball";
  place(scene, groundMesh(cells));
  place(scene, sphereMesh(24, 12, true), translation({0, 0, 0.5}) * scaling({0.3, 0.3, 0.3}));
  return scene;
}

inline MaterialHandle addTwoSided(Scene& scene) {
  Material material;
  material.type = MaterialType::twoSided;
  material.a = addMaterial(scene, diffuseMaterial(Rgb(0.5f)));
  return addMaterial(scene, material);
}

}  // namespace lobelia::test
