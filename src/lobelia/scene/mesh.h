// Triangle meshes and instances. All shapes are triangles by the time they are in a Scene (spheres
// and cylinders are tessellated finely and instanced).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lobelia/base/transform.h"
#include "lobelia/scene/handle.h"

namespace lobelia {

// Named attribute of vertices or faces, `size` floats each.
struct MeshAttribute {
  std::string name;  // with its prefix, "vertex_" or "face_"
  bool perFace = false;
  int size = 3;
  std::vector<float> values;
};

struct Mesh {
  std::string name;
  std::vector<Vec3f> positions;
  std::vector<Vec3f> normals;    // per vertex; empty: flat
  std::vector<Vec2f> uvs;        // per vertex; empty: barycentric (u, v), as Mitsuba
  std::vector<Vec3u> triangles;
  std::vector<MeshAttribute> attributes;
  bool isUnitSphere = false;     // tessellates the unit sphere: emitters may sample the true sphere
};

// A mesh placed in the world.
struct Instance {
  MeshHandle mesh;
  Transform toWorld;
  MaterialHandle material;
  EmitterHandle emitter;         // area emitter; radiance leaves on the side of the normal
  bool flipNormals = false;
  std::string name;
};

}  // namespace lobelia
