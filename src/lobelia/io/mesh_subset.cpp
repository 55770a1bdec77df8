#include "lobelia/io/mesh_subset.h"

namespace lobelia::io {
namespace {

void appendValues(const MeshAttribute& from, size_t index, MeshAttribute& to) {
  const auto size = static_cast<long>(from.size);
  const auto begin = from.values.begin() + static_cast<long>(index) * size;
  to.values.insert(to.values.end(), begin, begin + size);
}

}  // namespace

Mesh subset(const Mesh& mesh, const std::vector<uint32_t>& triangles) {
  constexpr uint32_t kNone = 0xffffffffu;
  Mesh out;
  out.name = mesh.name;
  for (const MeshAttribute& a : mesh.attributes)
    out.attributes.push_back({a.name, a.perFace, a.size, {}});
  std::vector<uint32_t> moved(mesh.positions.size(), kNone);
  for (const uint32_t index : triangles) {
    Vec3u t = mesh.triangles[index];
    for (int c = 0; c < 3; ++c) {
      const uint32_t from = t[c];
      if (moved[from] == kNone) {
        moved[from] = static_cast<uint32_t>(out.positions.size());
        out.positions.push_back(mesh.positions[from]);
        if (!mesh.normals.empty()) out.normals.push_back(mesh.normals[from]);
        if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[from]);
        for (size_t a = 0; a < mesh.attributes.size(); ++a)
          if (!mesh.attributes[a].perFace)
            appendValues(mesh.attributes[a], from, out.attributes[a]);
      }
      t[c] = moved[from];
    }
    out.triangles.push_back(t);
    for (size_t a = 0; a < mesh.attributes.size(); ++a)
      if (mesh.attributes[a].perFace) appendValues(mesh.attributes[a], index, out.attributes[a]);
  }
  return out;
}

}  // namespace lobelia::io
