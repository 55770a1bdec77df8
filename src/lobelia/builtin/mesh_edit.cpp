#include "lobelia/builtin/mesh_edit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lobelia/io/mesh_io.h"

namespace lobelia::builtin {
namespace {

void reverseTriangles(Mesh& mesh) {
  for (Vec3u& t : mesh.triangles) t = {t.x, t.z, t.y};
}

}  // namespace

Vec2f circle(int i, int n) {
  const float phi = kTwoPi * fraction(i % n, n);
  return {std::cos(phi), std::sin(phi)};
}

void addVertex(Mesh& mesh, Vec3f p, Vec3f n, Vec2f uv) {
  mesh.positions.push_back(p);
  mesh.normals.push_back(n);
  mesh.uvs.push_back(uv);
}

void addGrid(Mesh& mesh, size_t base, int rows, int columns) {
  const auto vertex = [&](int i, int j) {
    return static_cast<uint32_t>(base) + static_cast<uint32_t>(i * (columns + 1) + j);
  };
  const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
    const auto same = [&](uint32_t i, uint32_t j) {
      return mesh.positions[i] == mesh.positions[j];
    };
    if (!same(a, b) && !same(b, c) && !same(c, a)) mesh.triangles.push_back({a, b, c});
  };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      add(vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1));
      add(vertex(i, j), vertex(i + 1, j + 1), vertex(i + 1, j));
    }
}

Mesh transformed(Mesh mesh, const Mat4& matrix) {
  const Transform transform(matrix);
  for (Vec3f& p : mesh.positions) p = transform.point(p);
  for (Vec3f& n : mesh.normals) n = normalize(transform.normal(n));
  if (matrix.determinant3() < 0) reverseTriangles(mesh);
  return mesh;
}

Mesh translated(Mesh mesh, Vec3f by) {
  for (Vec3f& p : mesh.positions) p += by;
  return mesh;
}

Mat4 moving(Vec3f by) {
  return translation(
      {static_cast<double>(by.x), static_cast<double>(by.y), static_cast<double>(by.z)});
}

Mesh turnedInsideOut(Mesh mesh) {
  for (Vec3f& n : mesh.normals) n = -n;
  reverseTriangles(mesh);
  return mesh;
}

Mesh merged(const std::vector<Mesh>& meshes) {
  Mesh all;
  bool normals = true, uvs = true;
  for (const Mesh& mesh : meshes) {
    const auto base = static_cast<uint32_t>(all.positions.size());
    const auto append = [](auto& to, const auto& from) {
      to.insert(to.end(), from.begin(), from.end());
    };
    append(all.positions, mesh.positions);
    append(all.normals, mesh.normals);
    append(all.uvs, mesh.uvs);
    normals = normals && mesh.normals.size() == mesh.positions.size();
    uvs = uvs && mesh.uvs.size() == mesh.positions.size();
    for (const Vec3u t : mesh.triangles)
      all.triangles.push_back({t.x + base, t.y + base, t.z + base});
  }
  if (!normals) all.normals.clear();
  if (!uvs) all.uvs.clear();
  return all;
}

Mesh largestPart(const Mesh& mesh) {
  std::vector<uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Vec3u t : mesh.triangles)
    for (int c = 1; c < 3; ++c) parent[root(t[c])] = root(t[0]);
  std::vector<size_t> sizes(parent.size());
  for (const Vec3u t : mesh.triangles) ++sizes[root(t[0])];
  const auto largest =
      static_cast<uint32_t>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
  Mesh part;
  std::vector<uint32_t> place(parent.size());
  for (uint32_t v = 0; v < parent.size(); ++v) {
    if (root(v) != largest) continue;
    place[v] = static_cast<uint32_t>(part.positions.size());
    part.positions.push_back(mesh.positions[v]);
    if (!mesh.normals.empty()) part.normals.push_back(mesh.normals[v]);
    if (!mesh.uvs.empty()) part.uvs.push_back(mesh.uvs[v]);
  }
  for (const Vec3u t : mesh.triangles)
    if (root(t[0]) == largest) part.triangles.push_back({place[t.x], place[t.y], place[t.z]});
  return part;
}

void projectUvs(Mesh& mesh, float metres) {
  mesh.uvs.resize(mesh.positions.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3f p = mesh.positions[i] * (1 / metres), n = mesh.normals[i];
    const float x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    mesh.uvs[i] = y >= x && y >= z ? Vec2f(p.x, p.z) : x >= z ? Vec2f(p.z, p.y) : Vec2f(p.x, p.y);
  }
}

Mesh withProjectedUvs(Mesh mesh, float metres) {
  projectUvs(mesh, metres);
  return mesh;
}

Mesh creased(Mesh mesh, float degrees) {
  io::computeNormals(mesh, degrees);
  return mesh;
}

}  // namespace lobelia::builtin
