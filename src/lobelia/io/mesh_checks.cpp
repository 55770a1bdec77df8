#include "lobelia/io/mesh_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

namespace lobelia::io {
namespace {

void checkIndices(const Mesh& mesh, const Location& where) {
  const size_t count = mesh.positions.size();
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c)
      if (const uint32_t i = mesh.triangles[t][c]; i >= count)
        throw InputError(where, fmt::format("triangle {} refers to vertex {}; the mesh has {} "
                                            "vertices (counted from 0)",
                                            t, i, count));
}

void checkFinite(const Mesh& mesh, const Location& where) {
  const auto fail = [&](size_t i, const char* what) {
    throw InputError(where, fmt::format("the {} of vertex {} is not finite (vertices counted "
                                        "from 0); all numbers of a mesh must be",
                                        what, i));
  };
  for (size_t i = 0; i < mesh.positions.size(); ++i)
    if (!isFinite(mesh.positions[i])) fail(i, "position");
  for (size_t i = 0; i < mesh.normals.size(); ++i)
    if (!isFinite(mesh.normals[i])) fail(i, "normal");
  for (size_t i = 0; i < mesh.uvs.size(); ++i)
    if (!std::isfinite(mesh.uvs[i].x) || !std::isfinite(mesh.uvs[i].y)) fail(i, "uv");
  for (const MeshAttribute& attribute : mesh.attributes)
    for (size_t i = 0; i < attribute.values.size(); ++i)
      if (!std::isfinite(attribute.values[i]))
        throw InputError(where, fmt::format("attribute '{}' is not finite at {} {}", attribute.name,
                                            attribute.perFace ? "face" : "vertex",
                                            i / static_cast<size_t>(attribute.size)));
}

// Unit normals; returns how many were zero and had to be computed.
size_t normalizeNormals(Mesh& mesh) {
  std::vector<size_t> missing;
  for (size_t i = 0; i < mesh.normals.size(); ++i) {
    Vec3f& n = mesh.normals[i];
    // In double: squares of tiny and of huge normals leave the range of float.
    const Vec3d d(n.x, n.y, n.z);
    const double len2 = lengthSquared(d);
    if (!(len2 > 0)) {
      missing.push_back(i);
    } else if (std::abs(len2 - 1) > 1e-6) {
      const Vec3d u = d / std::sqrt(len2);
      n = {static_cast<float>(u.x), static_cast<float>(u.y), static_cast<float>(u.z)};
    }
  }
  if (!missing.empty()) {
    Mesh computed;
    computed.positions = mesh.positions;
    computed.triangles = mesh.triangles;
    computeNormals(computed, -1);
    for (const size_t i : missing) mesh.normals[i] = computed.normals[i];
  }
  return missing.size();
}

}  // namespace

void addWarning(std::vector<Finding>& findings, const Location& where, const std::string& message) {
  findings.push_back({Severity::warning, where, message});
}

void finishMesh(Mesh& mesh, const std::string& file, const MeshOptions& options,
                std::vector<Finding>& findings) {
  const Location where{file, 0, 0};
  if (mesh.name.empty()) mesh.name = std::filesystem::path(file).stem().string();
  if (mesh.triangles.empty()) throw InputError(where, "the mesh has no triangles; it needs one");
  checkIndices(mesh, where);
  checkFinite(mesh, where);
  if (options.faceNormals) {
    mesh.normals.clear();
  } else if (mesh.normals.empty() && !options.smooth && options.maxSmoothAngle < 0) {
    return;
  } else if (options.maxSmoothAngle >= 0 || mesh.normals.empty()) {
    mesh.normals.clear();
    computeNormals(mesh, options.maxSmoothAngle);
  } else if (const size_t n = normalizeNormals(mesh); n > 0) {
    addWarning(findings, where,
               fmt::format("{} of {} vertex normals are missing or zero; computed from the faces",
                           n, mesh.normals.size()));
  }
}

}  // namespace lobelia::io
