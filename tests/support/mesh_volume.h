#pragma once

#include "lobelia/scene/mesh.h"

namespace lobelia::test {

// By the divergence theorem; right only for closed meshes that are oriented outwards.
inline double volume(const Mesh& mesh) {
  double sum = 0;
  for (const Vec3u& t : mesh.triangles)
    sum += static_cast<double>(
               dot(mesh.positions[t.x], cross(mesh.positions[t.y], mesh.positions[t.z]))) /
           6;
  return sum;
}

}  // namespace lobelia::test
