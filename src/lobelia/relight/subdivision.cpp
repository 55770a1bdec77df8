// Deviation from the paper, which takes meshes as they are and names their tessellation a limit of
// its method [P004 section 6].
//
// An edge is judged by what its middle sees: the share of samples at which that differs from the
// mean of the edge's ends, times the edge's length, is a measure of how much of a picture is wrong.
#include "lobelia/relight/subdivision.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/relight/edge_splitting.h"
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
    firstNew_ = mesh_.positions().size();
    const bool whole = closeWithin(&table_, mostVertices_ - std::min(mostVertices_, firstNew_));
    if (!whole)
      context_.warning(
          fmt::format("subdivision stops at {} vertices; the scene's meshes are too coarse to "
                      "interpolate visibility well, a finer tessellation would help",
                      mostVertices_));
    mesh_ = halved(mesh_, triangles_, table_);
    return whole && mesh_.positions().size() > firstNew_;
  }
  SampleMesh take() { return std::move(mesh_); }

 private:
  float lengthOf(const MeshEdge& e) const {
    return length(mesh_.positions()[e.a] - mesh_.positions()[e.b]) / diagonal_;
  }

  // What the middle of an edge sees, from inside of the triangles that share it.
  std::vector<FacePlace> placesOfMiddle(const MeshEdge& e) const {
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
        MeshEdge& e = table_.edges[i];
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
