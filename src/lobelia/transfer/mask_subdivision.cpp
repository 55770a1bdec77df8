// [P002 section 6.1], after [Krivanek04]: an edge is halved where the visibility masks of its ends
// differ in more than a tolerance of all directions.
//
// Deviations:
//  - Directions behind one of the ends are not compared. The paper's masks have them, and a convex
//    surface is then split wherever it turns by .9 degrees along an edge, because two hemispheres
//    so tilted differ in 0.5 % of the sphere: a ball alone in space comes from 1,986 to 33,282
//    vertices in three rounds, where the paper says that convex surfaces stay coarse. So it keeps
//    its 1,986, and the floor under it is divided alike.
//  - Long edges are halved first, whatever their ends see, because something may stand between.
//  - Short edges stay whole, as for visibility cuts: where surfaces touch, masks differ at any
//    distance.
//  - Triangles become two, three or four (relight/edge_splitting.h) instead of four.
#include "lobelia/transfer/mask_subdivision.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <utility>

#include "lobelia/base/parallel.h"
#include "lobelia/relight/edge_splitting.h"
#include "lobelia/relight/visibility_data.h"
#include "lobelia/transfer/visibility_mask.h"

namespace lobelia::transfer {
namespace {

using relight::LeafBits;
using relight::LeafTriangle;
using relight::MeshEdge;
using relight::SampleMesh;
using relight::VertexFaces;

// In parts of the scene's diagonal.
constexpr float kShortest = 1.f / 100, kLongest = 1.f / 8;
constexpr int kLongRounds = 8;   // at most so many to halve long edges
constexpr size_t kBatch = 4096;  // edges whose masks are there at a time

class Subdivider {
 public:
  Subdivider(const Tracer& tracer, SampleMesh mesh, const MaskSettings& settings, Context& context)
      : tracer_(tracer),
        mesh_(std::move(mesh)),
        settings_(settings),
        context_(context),
        directions_(settings.level),
        diagonal_(length(tracer.bounds().extent())),
        bothSides_(relight::bothSidesOf(tracer.scene())) {}

  SampleMesh run() {
    for (int i = 0; i < kLongRounds; ++i) {
      look();
      findLong();
      if (!halve(room()) || mesh_.positions().size() == firstNew_) break;
    }
    firstNew_ = 0;
    bool whole = true;
    for (int i = 0; i < settings_.rounds; ++i) {
      look();
      findUnlike();
      // What room there is serves all rounds: the worst edges are halved again before the last ones
      // of a round are.
      whole = halve(room() / static_cast<size_t>(settings_.rounds - i));
      if (whole && mesh_.positions().size() == firstNew_) break;
      if (!whole) firstNew_ = 0;  // those for which there was no room may have it later
    }
    if (!whole)
      context_.warning(fmt::format(
          "subdivision by visibility stops at {} vertices, for it may leave {}: shadows and "
          "reflections where surfaces come close will be less sharp",
          mesh_.positions().size(), settings_.mostVertices));
    return std::move(mesh_);
  }

 private:
  void look() {
    triangles_ = relight::leafTriangles(mesh_);
    table_ = relight::edgesOf(triangles_);
  }

  size_t room() const {
    const size_t most = settings_.mostVertices, count = mesh_.positions().size();
    return most == 0 ? ~size_t{0} : most - std::min(most, count);
  }

  // The edges that ask for it. False: there was not room for all.
  bool halve(size_t room) {
    const bool whole = relight::closeWithin(&table_, room);
    firstNew_ = mesh_.positions().size();
    mesh_ = relight::halved(mesh_, triangles_, table_);
    return whole;
  }

  float lengthOf(const MeshEdge& e) const {
    return length(mesh_.positions()[e.a] - mesh_.positions()[e.b]) / diagonal_;
  }

  void findLong() {
    for (MeshEdge& e : table_.edges)
      if (const float size = lengthOf(e); size > kLongest) e.error = size;
  }

  void findUnlike() {
    const VertexFaces faces(tracer_.scene(), mesh_, triangles_, bothSides_);
    masks_.resize(mesh_.positions().size());
    // Edges whose ends are there for longer have stayed whole already.
    std::vector<size_t> open;
    for (size_t i = 0; i < table_.edges.size(); ++i)
      if (table_.edges[i].b >= firstNew_ && lengthOf(table_.edges[i]) > kShortest)
        open.push_back(i);
    for (size_t begin = 0; begin < open.size(); begin += kBatch) {
      const std::span batch = std::span(open).subspan(begin, std::min(kBatch, open.size() - begin));
      trace(batch, faces);
      compare(batch);
      context_.progress("masks", static_cast<double>(begin) / static_cast<double>(open.size()));
    }
  }

  // Traces the masks at the ends of edges that are not there.
  void trace(std::span<const size_t> edges, const VertexFaces& faces) {
    std::vector<uint32_t> missing;
    const auto find = [&] {
      missing.clear();
      for (const size_t i : edges)
        for (const uint32_t v : {table_.edges[i].a, table_.edges[i].b})
          if (masks_[v].empty()) missing.push_back(v);
      std::sort(missing.begin(), missing.end());
      missing.erase(std::unique(missing.begin(), missing.end()), missing.end());
    };
    find();
    if (bytes_ > settings_.memoryBytes && !missing.empty()) {
      for (PackedMask& mask : masks_) mask = {};
      bytes_ = 0;
      find();
    }
    std::atomic<uint64_t> bytes{0};
    parallelRanges(missing.size(), 64, [&](size_t begin, size_t end) {
      if (context_.cancelled()) return;
      MaskTracer rays(tracer_, directions_);
      for (size_t i = begin; i < end; ++i) {
        masks_[missing[i]] = PackedMask(rays.trace(faces.at(missing[i])));
        bytes += masks_[missing[i]].byteCount();
      }
      context_.statistics.addCount("mask_rays", rays.rays());
    });
    if (context_.cancelled()) throw Cancelled{};
    bytes_ += bytes;
  }

  void compare(std::span<const size_t> edges) {
    parallelRanges(edges.size(), 256, [&](size_t begin, size_t end) {
      LeafBits a, b;
      for (LeafBits* bits : {&a, &b})
        for (auto* words : {&bits->visible, &bits->matters})
          words->assign((directions_.count() + 63) / 64, 0);
      for (size_t i = begin; i < end; ++i) {
        MeshEdge& e = table_.edges[edges[i]];
        masks_[e.a].unpack(&a), masks_[e.b].unpack(&b);
        const float share =
            static_cast<float>(differing(a, b)) / static_cast<float>(directions_.count());
        if (share > settings_.tolerance) e.error = share;
      }
    });
  }

  static size_t differing(const LeafBits& a, const LeafBits& b) {
    size_t count = 0;
    for (size_t w = 0; w < a.wordCount(); ++w)
      count += static_cast<size_t>(
          std::popcount(a.matters[w] & b.matters[w] & (a.visible[w] ^ b.visible[w])));
    return count;
  }

  const Tracer& tracer_;
  SampleMesh mesh_;
  const MaskSettings& settings_;
  Context& context_;
  const MaskDirections directions_;
  const float diagonal_;
  const std::vector<uint8_t> bothSides_;  // by instance
  size_t firstNew_ = 0;                   // vertices from here on were added by the last round
  std::vector<LeafTriangle> triangles_;
  relight::EdgeTable table_;
  std::vector<PackedMask> masks_;  // by vertex; empty: not there
  uint64_t bytes_ = 0;             // of masks
};

}  // namespace

SampleMesh subdividedByMasks(const Tracer& tracer, SampleMesh mesh, const MaskSettings& settings,
                             Context& context) {
  if (settings.rounds <= 0) return mesh;
  const size_t before = mesh.positions().size();
  SampleMesh out = Subdivider(tracer, std::move(mesh), settings, context).run();
  context.statistics.addCount("vertices_added", out.positions().size() - before);
  return out;
}

}  // namespace lobelia::transfer
