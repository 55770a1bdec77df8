#include "lobelia/relight/edge_splitting.h"

#include <algorithm>
#include <utility>

namespace lobelia::relight {
namespace {

// No triangle keeps just two edges to halve. Returns how many edges that adds.
size_t close(EdgeTable* table) {
  size_t added = 0;
  std::vector<uint32_t> open;
  for (uint32_t t = 0; t < table->ofUse.size() / 3; ++t) open.push_back(t);
  while (!open.empty()) {
    const uint32_t t = open.back();
    open.pop_back();
    int halved = 0;
    for (uint32_t k = 0; k < 3; ++k)
      halved += table->edges[table->ofUse[3 * t + k]].error > 0 ? 1 : 0;
    if (halved != 2) continue;
    for (uint32_t k = 0; k < 3; ++k) {
      MeshEdge& e = table->edges[table->ofUse[3 * t + k]];
      if (e.error > 0) continue;
      e.error = 1e-6f;
      ++added;
      for (size_t i = 0; i < e.useCount; ++i) open.push_back(table->uses[e.firstUse + i] / 3);
    }
  }
  return added;
}

}  // namespace

EdgeTable edgesOf(std::span<const LeafTriangle> triangles) {
  struct Use {
    uint64_t key;
    uint32_t use;
    bool operator<(const Use& o) const { return std::pair(key, use) < std::pair(o.key, o.use); }
  };
  std::vector<Use> sorted;
  for (size_t t = 0; t < triangles.size(); ++t)
    for (size_t k = 0; k < 3; ++k) {
      const auto [a, b] = std::minmax(triangles[t].vertex[k], triangles[t].vertex[(k + 1) % 3]);
      sorted.push_back({uint64_t{a} << 32 | b, static_cast<uint32_t>(3 * t + k)});
    }
  std::sort(sorted.begin(), sorted.end());
  EdgeTable table;
  table.ofUse.resize(sorted.size());
  for (size_t i = 0; i < sorted.size(); ++i) {
    if (i == 0 || sorted[i].key != sorted[i - 1].key)
      table.edges.push_back({static_cast<uint32_t>(sorted[i].key >> 32),
                             static_cast<uint32_t>(sorted[i].key), i, 0, 0});
    ++table.edges.back().useCount;
    table.uses.push_back(sorted[i].use);
    table.ofUse[sorted[i].use] = static_cast<uint32_t>(table.edges.size() - 1);
  }
  return table;
}

bool closeWithin(EdgeTable* table, size_t room) {
  std::vector<std::pair<float, size_t>> wanted;  // -error, edge: the worst first
  for (size_t i = 0; i < table->edges.size(); ++i)
    if (table->edges[i].error > 0) wanted.emplace_back(-table->edges[i].error, i);
  std::sort(wanted.begin(), wanted.end());
  // Vertices that the first `kept` add with those that follow from them.
  const auto keep = [&](size_t kept) {
    for (MeshEdge& e : table->edges) e.error = 0;
    for (size_t i = 0; i < kept; ++i) table->edges[wanted[i].second].error = -wanted[i].first;
    return kept + close(table);
  };
  if (keep(wanted.size()) <= room) return true;
  size_t fits = 0, tooMany = wanted.size();  // more edges never add less
  while (tooMany - fits > 1) {
    const size_t kept = fits + (tooMany - fits) / 2;
    (keep(kept) <= room ? fits : tooMany) = kept;
  }
  keep(fits);
  return false;
}

SampleMesh halved(const SampleMesh& mesh, std::span<const LeafTriangle> triangles,
                  const EdgeTable& table) {
  std::vector<Vec3f> positions(mesh.positions().begin(), mesh.positions().end());
  std::vector<SampleTriangle> all(mesh.triangles().begin(), mesh.triangles().end());
  std::vector<uint32_t> middle(table.edges.size(), 0);
  for (size_t i = 0; i < table.edges.size(); ++i) {
    const MeshEdge& e = table.edges[i];
    if (!(e.error > 0)) continue;
    middle[i] = static_cast<uint32_t>(positions.size());
    positions.push_back((positions[e.a] + positions[e.b]) * 0.5f);
  }
  for (size_t t = 0; t < triangles.size(); ++t) {
    const LeafTriangle& triangle = triangles[t];
    uint32_t points[6] = {triangle.vertex[0], triangle.vertex[1], triangle.vertex[2], 0, 0, 0};
    uint32_t mask = 0;
    for (uint32_t k = 0; k < 3; ++k) {
      const uint32_t edge = table.ofUse[3 * t + k];
      points[3 + k] = middle[edge];
      if (table.edges[edge].error > 0) mask |= 1u << k;
    }
    if (mask == 0) continue;
    all[triangle.index].firstChild = static_cast<uint32_t>(all.size());
    all[triangle.index].splitEdges = mask;
    for (const auto& corners : childCorners(mask)) {
      SampleTriangle child;
      for (size_t k = 0; k < 3; ++k) child.vertex[k] = points[corners[k]];
      all.push_back(child);
    }
  }
  return {std::move(positions),
          std::move(all),
          {mesh.firstTriangle().begin(), mesh.firstTriangle().end()}};
}

}  // namespace lobelia::relight
