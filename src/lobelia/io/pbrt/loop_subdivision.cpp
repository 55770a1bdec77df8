// Loop's subdivision [Loop 1987] with Warren's weights, the rules for boundaries of Hoppe et al.
// 1994, and the limit positions of both (Pharr, Jakob, Humphreys: Physically Based Rendering, 3rd
// edition, section 3.8). Deviation: normals are those of the refined mesh, not of the limit's
// tangents.
#include <map>
#include <utility>

#include "lobelia/io/mesh_io.h"
#include "lobelia/io/pbrt/tessellation.h"

namespace lobelia::io::pbrt {
namespace {

using Edge = std::pair<uint32_t, uint32_t>;
Edge edgeOf(uint32_t a, uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

struct EdgeInfo {
  int faces = 0;
  uint32_t opposite[2] = {0, 0};
  uint32_t middle = 0;  // the new vertex on it
};

struct Topology {
  std::map<Edge, EdgeInfo> edges;
  std::vector<Vec3f> ringSum;  // of all neighbours
  std::vector<int> valence;
  std::vector<Vec3f> boundarySum;  // of the neighbours along the boundary
  std::vector<int> boundary;       // how many those are

  explicit Topology(const Mesh& mesh)
      : ringSum(mesh.positions.size()),
        valence(mesh.positions.size()),
        boundarySum(mesh.positions.size()),
        boundary(mesh.positions.size()) {
    for (const Vec3u t : mesh.triangles) {
      for (int i = 0; i < 3; ++i) {
        EdgeInfo& edge = edges[edgeOf(t[i], t[(i + 1) % 3])];
        if (edge.faces < 2) edge.opposite[edge.faces] = t[(i + 2) % 3];
        ++edge.faces;
      }
    }
    const std::vector<Vec3f>& p = mesh.positions;
    for (const auto& [e, info] : edges) {
      ringSum[e.first] += p[e.second], ringSum[e.second] += p[e.first];
      ++valence[e.first], ++valence[e.second];
      if (info.faces == 2) continue;
      boundarySum[e.first] += p[e.second], boundarySum[e.second] += p[e.first];
      ++boundary[e.first], ++boundary[e.second];
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
  Topology t(mesh);
  Mesh out;
  out.positions.resize(mesh.positions.size());
  for (size_t v = 0; v < mesh.positions.size(); ++v)
    out.positions[v] = smoothed(t, mesh.positions[v], v, beta(t.valence[v]), 1.f / 8);
  for (auto& [e, info] : t.edges) {
    const Vec3f ends = mesh.positions[e.first] + mesh.positions[e.second];
    Vec3f p = ends * 0.5f;
    if (info.faces == 2) {
      p = ends * (3.f / 8) +
          (mesh.positions[info.opposite[0]] + mesh.positions[info.opposite[1]]) * (1.f / 8);
    }
    info.middle = static_cast<uint32_t>(out.positions.size());
    out.positions.push_back(p);
  }
  out.triangles.reserve(4 * mesh.triangles.size());
  for (const Vec3u f : mesh.triangles) {
    const auto middle = [&](int i) { return t.edges[edgeOf(f[i], f[(i + 1) % 3])].middle; };
    const uint32_t m0 = middle(0), m1 = middle(1), m2 = middle(2);
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
