// Deviation from the paper, which takes meshes as they are and names their tessellation a limit of
// its method [P004 section 6].
//
// An edge is judged by what its middle sees: the share of samples at which that differs from the
// mean of the edge's ends, times the edge's length, is a measure of how much of a picture is wrong.
// Edges are known by their two vertices, so that all triangles around one agree on it and no cracks
// come to be. A triangle with two edges to halve halves the third, too, until there are none such
// (red); with one it is cut in two (green). Greens may be cut again, which makes them thin, by one
// step a round; the number of rounds is small.
#include "lobelia/relight/subdivision.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/relight/vertex_visibility.h"

namespace lobelia::relight {
namespace {

constexpr size_t kMostSamples = 512;
// In parts of the scene's diagonal: shorter edges stay; longer ones are halved whatever they see,
// because nothing may stand just at their ends and middles; and the judge's limit.
constexpr float kShortest = 1.f / 100, kLongest = 1.f / 8, kTolerance = 1.f / 500;

// One sample of each run of leaves.
LightSamples thinned(const LightSamples& samples, uint64_t seed) {
  const size_t run = std::max<size_t>(samples.count() / kMostSamples, 1);
  std::vector<uint32_t> chosen;
  for (size_t i = 0; i < samples.count(); i += run)
    chosen.push_back(static_cast<uint32_t>(i + hashCombine(seed, i) % run));
  return reordered(samples, chosen);
}

struct Edge {
  uint32_t a = 0, b = 0;              // a < b
  size_t firstUse = 0, useCount = 0;  // in EdgeTable::uses
  float error = 0;                    // how much it asks to be halved; 0: not
};

// The edges of all triangles, and who uses them.
struct EdgeTable {
  std::vector<Edge> edges;
  std::vector<uint32_t> uses;   // 3 * triangle + its edge
  std::vector<uint32_t> ofUse;  // the edge, by 3 * triangle + its edge
};

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

class Subdivider {
 public:
  Subdivider(const Tracer& tracer, SampleMesh mesh, const LightSamples& samples,
             std::span<const uint8_t> bothSides, size_t allowed, Context& context)
      : tracer_(tracer),
        scene_(tracer.scene()),
        mesh_(std::move(mesh)),
        samples_(thinned(samples, context.seed)),
        levels_(std::countr_zero(samples_.count())),
        bothSides_(bothSides),
        context_(context),
        diagonal_(length(tracer.bounds().extent())),
        mostVertices_(mesh_.positions().size() + std::max(mesh_.positions().size(), allowed)) {}

  // False: there was nothing to halve, or no room for it.
  bool round() {
    triangles_ = leafTriangles(mesh_);
    table_ = edgesOf(triangles_);
    judge();
    if (context_.cancelled()) throw Cancelled{};
    const bool whole = limit();
    firstNew_ = mesh_.positions().size();
    split();
    return whole && mesh_.positions().size() > firstNew_;
  }
  SampleMesh take() { return std::move(mesh_); }

 private:
  float lengthOf(const Edge& e) const {
    return length(mesh_.positions()[e.a] - mesh_.positions()[e.b]) / diagonal_;
  }

  // What the middle of an edge sees, from inside of the triangles that share it.
  std::vector<FacePlace> placesOfMiddle(const Edge& e) const {
    std::vector<FacePlace> places;
    for (size_t i = 0; i < e.useCount; ++i) {
      const uint32_t use = table_.uses[e.firstUse + i];
      const LeafTriangle& t = triangles_[use / 3];
      Vec3f weights(0.5f);
      weights[static_cast<int>((use % 3 + 2) % 3)] = 0;
      places.push_back(facePlace(scene_, t, weights, bothSides_[t.instance] != 0));
    }
    return places;
  }

  void judge() {
    const VertexFaces faces(scene_, mesh_, triangles_, bothSides_);
    parallelRanges(table_.edges.size(), 512, [&](size_t begin, size_t end) {
      if (context_.cancelled()) return;
      VertexTracer rays(tracer_, samples_);
      for (size_t i = begin; i < end; ++i) {
        Edge& e = table_.edges[i];
        const float size = lengthOf(e);
        const bool judged =
            e.b < firstNew_;  // of vertices that are there for longer: it stayed whole
        if (!(size > kShortest) || e.a == e.b || judged) continue;
        const LeafBits a = look(&rays, faces.at(e.a)), b = look(&rays, faces.at(e.b)),
                       middle = look(&rays, placesOfMiddle(e));
        const float wrong = difference(a, b, middle) * size;
        if (size > kLongest || wrong > kTolerance) e.error = std::max(wrong, 1e-6f);
      }
      context_.statistics.addCount("subdivision_rays", rays.rays());
    });
  }

  LeafBits look(VertexTracer* rays, std::span<const FacePlace> places) const {
    LeafBits bits(levels_);
    rays->prepare(places, &bits);
    rays->traceAll(&bits);
    return bits;
  }

  // The share of samples that matter to all three at which the middle differs from the ends' mean.
  static float difference(const LeafBits& a, const LeafBits& b, const LeafBits& middle) {
    int count = 0, wrong = 0;
    for (size_t w = 0; w < a.wordCount(); ++w) {
      const uint64_t all = a.matters[w] & b.matters[w] & middle.matters[w];
      count += std::popcount(all);
      wrong += std::popcount(all & (a.visible[w] ^ middle.visible[w])) +
               std::popcount(all & (b.visible[w] ^ middle.visible[w]));
    }
    return count > 0 ? 0.5f * static_cast<float>(wrong) / static_cast<float>(count) : 0.f;
  }

  // Of too many edges those are halved that need it most, the earlier ones of equals. True: there
  // were not too many. What close() adds counts, so that there is no more than `mostVertices_`.
  bool limit() {
    const size_t room = mostVertices_ - std::min(mostVertices_, mesh_.positions().size());
    std::vector<std::pair<float, size_t>> wanted;  // -error, edge: the worst first
    for (size_t i = 0; i < table_.edges.size(); ++i)
      if (table_.edges[i].error > 0) wanted.emplace_back(-table_.edges[i].error, i);
    std::sort(wanted.begin(), wanted.end());
    // Vertices that the first `kept` add with those that follow from them.
    const auto keep = [&](size_t kept) {
      for (Edge& e : table_.edges) e.error = 0;
      for (size_t i = 0; i < kept; ++i) table_.edges[wanted[i].second].error = -wanted[i].first;
      return kept + close();
    };
    if (keep(wanted.size()) <= room) return true;
    size_t fits = 0, tooMany = wanted.size();  // more edges never add less
    while (tooMany - fits > 1) {
      const size_t kept = fits + (tooMany - fits) / 2;
      (keep(kept) <= room ? fits : tooMany) = kept;
    }
    keep(fits);
    context_.warning(
        fmt::format("subdivision stops at {} vertices; the scene's meshes are too coarse to "
                    "interpolate visibility well, a finer tessellation would help",
                    mostVertices_));
    return false;
  }

  // No triangle keeps just two edges to halve. Returns how many edges that adds.
  size_t close() {
    size_t added = 0;
    std::vector<uint32_t> open;
    for (uint32_t t = 0; t < triangles_.size(); ++t) open.push_back(t);
    while (!open.empty()) {
      const uint32_t t = open.back();
      open.pop_back();
      int halved = 0;
      for (uint32_t k = 0; k < 3; ++k)
        halved += table_.edges[table_.ofUse[3 * t + k]].error > 0 ? 1 : 0;
      if (halved != 2) continue;
      for (uint32_t k = 0; k < 3; ++k) {
        Edge& e = table_.edges[table_.ofUse[3 * t + k]];
        if (e.error > 0) continue;
        e.error = 1e-6f;
        ++added;
        for (size_t i = 0; i < e.useCount; ++i) open.push_back(table_.uses[e.firstUse + i] / 3);
      }
    }
    return added;
  }

  void split() {
    std::vector<Vec3f> positions(mesh_.positions().begin(), mesh_.positions().end());
    std::vector<SampleTriangle> all(mesh_.triangles().begin(), mesh_.triangles().end());
    std::vector<uint32_t> middle(table_.edges.size(), 0);
    for (size_t i = 0; i < table_.edges.size(); ++i) {
      const Edge& e = table_.edges[i];
      if (!(e.error > 0)) continue;
      middle[i] = static_cast<uint32_t>(positions.size());
      positions.push_back((positions[e.a] + positions[e.b]) * 0.5f);
    }
    for (uint32_t t = 0; t < triangles_.size(); ++t) {
      uint32_t points[6] = {
          triangles_[t].vertex[0], triangles_[t].vertex[1], triangles_[t].vertex[2], 0, 0, 0};
      uint32_t mask = 0;
      for (uint32_t k = 0; k < 3; ++k) {
        const uint32_t edge = table_.ofUse[3 * t + k];
        points[3 + k] = middle[edge];
        if (table_.edges[edge].error > 0) mask |= 1u << k;
      }
      if (mask == 0) continue;
      all[triangles_[t].index].firstChild = static_cast<uint32_t>(all.size());
      all[triangles_[t].index].splitEdges = mask;
      for (const auto& corners : childCorners(mask)) {
        SampleTriangle child;
        for (size_t k = 0; k < 3; ++k) child.vertex[k] = points[corners[k]];
        all.push_back(child);
      }
    }
    mesh_ = SampleMesh(std::move(positions), std::move(all),
                       {mesh_.firstTriangle().begin(), mesh_.firstTriangle().end()});
  }

  const Tracer& tracer_;
  const Scene& scene_;
  SampleMesh mesh_;
  const LightSamples samples_;
  const int levels_;
  const std::span<const uint8_t> bothSides_;
  Context& context_;
  const float diagonal_;
  const size_t mostVertices_;
  size_t firstNew_ = 0;  // vertices from here on were added by the last round
  std::vector<LeafTriangle> triangles_;
  EdgeTable table_;
};

}  // namespace

SampleMesh subdivided(const Tracer& tracer, SampleMesh mesh, const LightSamples& samples,
                      std::span<const uint8_t> bothSides, int rounds, Context& context,
                      size_t allowed) {
  const size_t before = mesh.positions().size();
  Subdivider subdivider(tracer, std::move(mesh), samples, bothSides, allowed, context);
  for (int i = 0; i < rounds && subdivider.round(); ++i) {
  }
  SampleMesh out = subdivider.take();
  context.statistics.addCount("vertices_added", out.positions().size() - before);
  return out;
}

}  // namespace lobelia::relight
