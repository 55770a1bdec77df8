// Loop's subdivision [Loop 1987] with Warren's weights, the rules for boundaries of Hoppe et al.
// 1994, and the limit positions of both (Pharr, Jakob, Humphreys: Physically Based Rendering, 3rd
// edition, section 3.8). Deviation: normals are those of the refined mesh, not of the limit's
// tangents.
#include <algorithm>
#include <utility>
#include <vector>

#include "lobelia/io/mesh_io.h"
#include "lobelia/io/pbrt/tessellation.h"

namespace lobelia::io::pbrt {
namespace {

struct Edge {
  uint32_t ends[2];  // the smaller first
  int faces = 0;
  uint32_t opposite[2] = {0, 0};
};

struct Topology {
  std::vector<Edge> edges;     // by their ends
  std::vector<Vec3u> edgesOf;  // of a triangle: from corner i to corner i + 1
  std::vector<Vec3f> ringSum;  // of all neighbours
  std::vector<int> valence;
  std::vector<Vec3f> boundarySum;  // of the neighbours along the boundary
  std::vector<int> boundary;       // how many those are

  explicit Topology(const Mesh& mesh)
      : edgesOf(mesh.triangles.size()),
        ringSum(mesh.positions.size()),
        valence(mesh.positions.size()),
        boundarySum(mesh.positions.size()),
        boundary(mesh.positions.size()) {
    findEdges(mesh);
    const std::vector<Vec3f>& p = mesh.positions;
    for (const Edge& edge : edges) {
      const uint32_t a = edge.ends[0], b = edge.ends[1];
      ringSum[a] += p[b], ringSum[b] += p[a];
      ++valence[a], ++valence[b];
      if (edge.faces == 2) continue;
      boundarySum[a] += p[b], boundarySum[b] += p[a];
      ++boundary[a], ++boundary[b];
    }
  }

 private:
  void findEdges(const Mesh& mesh) {
    std::vector<std::pair<uint64_t, uint32_t>> sides;  // both ends; 3 triangle + corner
    sides.reserve(3 * mesh.triangles.size());
    for (const Vec3u t : mesh.triangles) {
      for (int i = 0; i < 3; ++i) {
        const uint32_t a = t[i], b = t[(i + 1) % 3];
        sides.emplace_back(uint64_t{std::min(a, b)} << 32 | std::max(a, b), sides.size());
      }
    }
    std::sort(sides.begin(), sides.end());
    for (size_t k = 0; k < sides.size(); ++k) {
      const auto [ends, side] = sides[k];
      if (k == 0 || ends != sides[k - 1].first)
        edges.push_back({{static_cast<uint32_t>(ends >> 32), static_cast<uint32_t>(ends)}});
      Edge& edge = edges.back();
      const int corner = static_cast<int>(side % 3);
      if (edge.faces < 2) edge.opposite[edge.faces] = mesh.triangles[side / 3][(corner + 2) % 3];
      ++edge.faces;
      edgesOf[side / 3][corner] = static_cast<uint32_t>(edges.size() - 1);
    }
  }
};

float beta(int valence) {
  return valence == 3 ? 3.f / 16 : 3.f / (8 * static_cast<float>(std::max(valence, 1)));
}

// Moves a vertex: inside, each neighbour has the weight `inner`; on a boundary the two along it
// have `outer`.
Vec3f smoothed(const Topology& t, Vec3f p, size_t v, float inner, float outer) {
  if (t.boundary[v] == 2) return p * (1 - 2 * outer) + t.boundarySum[v] * outer;
  if (t.boundary[v] != 0 || t.valence[v] == 0) return p;  // corners of several sheets stay
  return p * (1 - static_cast<float>(t.valence[v]) * inner) + t.ringSum[v] * inner;
}

Mesh refine(const Mesh& mesh) {
  const Topology t(mesh);
  const auto count = static_cast<uint32_t>(mesh.positions.size());
  Mesh out;
  out.positions.reserve(count + t.edges.size());
  for (size_t v = 0; v < count; ++v)
    out.positions.push_back(smoothed(t, mesh.positions[v], v, beta(t.valence[v]), 1.f / 8));
  for (const Edge& edge : t.edges) {  // edge e gets vertex count + e
    const Vec3f ends = mesh.positions[edge.ends[0]] + mesh.positions[edge.ends[1]];
    Vec3f p = ends * 0.5f;
    if (edge.faces == 2) {
      p = ends * (3.f / 8) +
          (mesh.positions[edge.opposite[0]] + mesh.positions[edge.opposite[1]]) * (1.f / 8);
    }
    out.positions.push_back(p);
  }
  out.triangles.reserve(4 * mesh.triangles.size());
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Vec3u f = mesh.triangles[i];
    const uint32_t m0 = count + t.edgesOf[i].x, m1 = count + t.edgesOf[i].y,
                   m2 = count + t.edgesOf[i].z;
    out.triangles.push_back({f.x, m0, m2});
    out.triangles.push_back({m0, f.y, m1});
    out.triangles.push_back({m2, m1, f.z});
    out.triangles.push_back({m0, m1, m2});
  }
  return out;
}

}  // namespace

Mesh subdivideLoop(const Mesh& control, int levels) {
  Mesh mesh = control;
  for (int i = 0; i < levels; ++i) mesh = refine(mesh);
  const Topology t(mesh);
  std::vector<Vec3f> limit(mesh.positions.size());
  for (size_t v = 0; v < limit.size(); ++v) {
    const float b = beta(t.valence[v]);
    const float inner = 1 / (static_cast<float>(t.valence[v]) + 3 / (8 * b));
    limit[v] = smoothed(t, mesh.positions[v], v, inner, 1.f / 5);
  }
  mesh.positions = std::move(limit);
  mesh.name = "loopsubdiv";
  mesh.normals.clear(), mesh.uvs.clear();
  computeNormals(mesh, -1);
  return mesh;
}

}  // namespace lobelia::io::pbrt
