// Vertex normals of a mesh without: the mean of the adjacent faces' normals, weighted by the angle
// that each face has at the vertex (G. Thuermer and C. A. Wuethrich, "Computing Vertex Normals from
// Polygonal Facets", Journal of Graphics Tools 3(1), 1998), as Mitsuba does.
//
// With a largest smooth angle, vertices are first told apart by groups of faces: two faces belong
// to one group at a vertex when they share an edge there (by position, so that seams of the
// texture coordinates do not show) and the angle between their normals is small enough.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

#include "lobelia/base/random.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia::io {
namespace {

Vec3d toDouble(Vec3f v) { return {v.x, v.y, v.z}; }

// Unit normal of a triangle, zero when degenerate.
Vec3d faceNormal(const Mesh& mesh, Vec3u t) {
  const Vec3d a = toDouble(mesh.positions[t.x]);
  const Vec3d n = cross(toDouble(mesh.positions[t.y]) - a, toDouble(mesh.positions[t.z]) - a);
  const double len = length(n);
  return len > 0 ? n / len : Vec3d();
}

// Interior angle at a corner, by the half-angle form, which is exact for small angles too.
double cornerAngle(const Mesh& mesh, Vec3u t, int corner) {
  const Vec3d p = toDouble(mesh.positions[t[corner]]);
  const Vec3d a = toDouble(mesh.positions[t[(corner + 1) % 3]]) - p;
  const Vec3d b = toDouble(mesh.positions[t[(corner + 2) % 3]]) - p;
  const double la = length(a), lb = length(b);
  if (!(la > 0) || !(lb > 0)) return 0;
  return 2 * std::atan2(length(a / la - b / lb), length(a / la + b / lb));
}

Vec3f unitOr(Vec3d n, Vec3f fallback) {
  const double len = length(n);
  if (!(len > 0)) return fallback;
  n = n / len;
  return {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
}

// Sum of angle-weighted normals per group of corners; group[3 t + c] names a corner's group.
std::vector<Vec3f> groupNormals(const Mesh& mesh, const std::vector<uint32_t>& group,
                                size_t groupCount) {
  std::vector<Vec3d> sum(groupCount);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d n = faceNormal(mesh, mesh.triangles[t]);
    for (int c = 0; c < 3; ++c)
      sum[group[3 * t + static_cast<size_t>(c)]] += n * cornerAngle(mesh, mesh.triangles[t], c);
  }
  std::vector<Vec3f> normals(groupCount);
  for (size_t i = 0; i < groupCount; ++i) normals[i] = unitOr(sum[i], {0, 0, 1});
  return normals;
}

// Index of the first vertex at the same position, for every vertex.
std::vector<uint32_t> weldPositions(const Mesh& mesh) {
  struct Hash {
    size_t operator()(Vec3f p) const {
      const auto bits = [](float f) { return std::hash<float>()(f); };  // +0 and -0 alike
      return hashCombine(hashCombine(bits(p.x), bits(p.y)), bits(p.z));
    }
  };
  std::unordered_map<Vec3f, uint32_t, Hash> first;
  first.reserve(mesh.positions.size());
  std::vector<uint32_t> weld(mesh.positions.size());
  for (uint32_t i = 0; i < weld.size(); ++i)
    weld[i] = first.try_emplace(mesh.positions[i], i).first->second;
  return weld;
}

// Union-find over corners with path halving.
class Groups {
 public:
  explicit Groups(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
  uint32_t find(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(uint32_t a, uint32_t b) {
    a = find(a), b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> parent_;
};

// Smoothing group of every corner, numbered in order of appearance.
std::vector<uint32_t> smoothGroups(const Mesh& mesh, double maxAngle, size_t* groupCount) {
  struct Edge {
    uint32_t a, b;              // welded vertices, a < b
    uint32_t cornerA, cornerB;  // corners of one triangle at a and b
    auto key() const { return std::tie(a, b, cornerA); }
  };
  const std::vector<uint32_t> weld = weldPositions(mesh);
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (uint32_t c = 0; c < 3; ++c) {
      const uint32_t d = (c + 1) % 3;
      const Vec3u tri = mesh.triangles[t];
      Edge e{weld[tri[static_cast<int>(c)]], weld[tri[static_cast<int>(d)]], 3 * t + c, 3 * t + d};
      if (e.a > e.b) std::swap(e.a, e.b), std::swap(e.cornerA, e.cornerB);
      edges.push_back(e);
    }
  std::sort(edges.begin(), edges.end(),
            [](const Edge& x, const Edge& y) { return x.key() < y.key(); });
  Groups groups(3 * mesh.triangles.size());
  const double cosMax = std::cos(maxAngle);
  for (size_t i = 1; i < edges.size(); ++i) {
    const Edge &x = edges[i - 1], &y = edges[i];
    if (x.a != y.a || x.b != y.b) continue;
    const Vec3d nx = faceNormal(mesh, mesh.triangles[x.cornerA / 3]);
    const Vec3d ny = faceNormal(mesh, mesh.triangles[y.cornerA / 3]);
    if (dot(nx, ny) < cosMax) continue;
    groups.unite(x.cornerA, y.cornerA);
    groups.unite(x.cornerB, y.cornerB);
  }
  std::vector<uint32_t> group(3 * mesh.triangles.size());
  uint32_t count = 0;
  for (uint32_t i = 0; i < group.size(); ++i) {
    const uint32_t root = groups.find(i);  // the smallest of its group: already numbered
    group[i] = root == i ? count++ : group[root];
  }
  *groupCount = count;
  return group;
}

// One vertex per (old vertex, group) pair, with the group's normal.
void splitVertices(Mesh& mesh, const std::vector<uint32_t>& group,
                   const std::vector<Vec3f>& normals) {
  Mesh out = mesh;
  out.positions.clear(), out.uvs.clear(), out.normals.clear();
  for (MeshAttribute& a : out.attributes)
    if (!a.perFace) a.values.clear();
  std::unordered_map<uint64_t, uint32_t> known;
  known.reserve(2 * mesh.positions.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int c = 0; c < 3; ++c) {
      const uint32_t v = mesh.triangles[t][c], g = group[3 * t + static_cast<size_t>(c)];
      const auto [it, isNew] =
          known.try_emplace((uint64_t{v} << 32) | g, static_cast<uint32_t>(out.positions.size()));
      if (isNew) {
        out.positions.push_back(mesh.positions[v]);
        out.normals.push_back(normals[g]);
        if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[v]);
        for (size_t k = 0; k < mesh.attributes.size(); ++k) {
          const MeshAttribute& from = mesh.attributes[k];
          if (from.perFace) continue;
          const auto size = static_cast<size_t>(from.size);
          for (size_t j = 0; j < size; ++j)
            out.attributes[k].values.push_back(from.values[v * size + j]);
        }
      }
      out.triangles[t][c] = it->second;
    }
  mesh = std::move(out);
}

}  // namespace

void computeNormals(Mesh& mesh, float maxSmoothAngle) {
  if (maxSmoothAngle < 0) {
    std::vector<uint32_t> group(3 * mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t)
      for (int c = 0; c < 3; ++c) group[3 * t + static_cast<size_t>(c)] = mesh.triangles[t][c];
    mesh.normals = groupNormals(mesh, group, mesh.positions.size());
    return;
  }
  size_t groupCount = 0;
  const auto group =
      smoothGroups(mesh, static_cast<double>(maxSmoothAngle) * (M_PI / 180), &groupCount);
  splitVertices(mesh, group, groupNormals(mesh, group, groupCount));
}

}  // namespace lobelia::io
