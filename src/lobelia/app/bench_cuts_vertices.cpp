#include "lobelia/app/bench_cuts_vertices.h"

#include <algorithm>
#include <bit>

#include "lobelia/base/parallel.h"

namespace lobelia::app {
namespace {

// Of vertices, whose pilot visibility tells directions apart: the paper's number, or one for each
// 32 directions where there are fewer of these than it has.
constexpr int kClusterLevels = 10;
size_t clusterCount(size_t samples) {
  return std::clamp<size_t>(std::bit_floor(samples / 32), 16, size_t{1} << kClusterLevels);
}

float diagonalOf(const Tracer& tracer) {
  return std::max(length(tracer.bounds().extent()), 1e-20f);
}

relight::VertexFaces facesOf(const Scene& scene, const relight::SampleMesh& mesh) {
  return {scene, mesh, relight::leafTriangles(mesh), relight::bothSidesOf(scene)};
}

}  // namespace

StudyVertices::StudyVertices(const Tracer& tracer, size_t count, Context& context)
    : tracer_(tracer),
      context_(context),
      mesh_(relight::weldedMesh(tracer.scene())),
      faces_(facesOf(tracer.scene(), mesh_)),
      order_(relight::vertexOrder(mesh_, faces_, diagonalOf(tracer), kClusterLevels)) {
  const size_t chosen = std::min(count, order_.size());
  for (size_t i = 0; i < chosen; ++i)
    chosen_.push_back(order_[(2 * i + 1) * order_.size() / (2 * chosen)]);
}

std::vector<std::vector<uint32_t>> StudyVertices::treeOrders(const relight::LightSamples& samples,
                                                             std::span<const float> betas) const {
  const size_t clusters = clusterCount(samples.count());
  std::vector<uint8_t> rows;
  if (std::any_of(betas.begin(), betas.end(), [](float beta) { return beta < 1; }))
    rows = relight::pilotVisibility(tracer_, samples, faces_, order_, clusters, context_);
  std::vector<std::vector<uint32_t>> orders;
  for (const float beta : betas) {
    if (context_.cancelled()) throw Cancelled{};
    const std::span<const uint8_t> seen =
        beta < 1 ? std::span<const uint8_t>(rows) : std::span<const uint8_t>();
    orders.push_back(relight::treeOrder(samples, seen, clusters, beta, diagonalOf(tracer_)));
  }
  return orders;
}

void StudyVertices::trace(const relight::LightSamples& samples, const MakeUse& makeUse) const {
  parallelRanges(chosen_.size(), 8, [&](size_t begin, size_t end) {
    if (context_.cancelled()) return;
    relight::VertexTracer rays(tracer_, samples);
    relight::LeafBits bits = relight::leafBits(samples);
    const Use use = makeUse();
    for (size_t v = begin; v < end; ++v) {
      rays.prepare(faces_.at(chosen_[v]), &bits);
      rays.traceAll(&bits);
      use(v, bits);
    }
    context_.statistics.addCount("shadow_rays", rays.rays());
  });
  if (context_.cancelled()) throw Cancelled{};
}

}  // namespace lobelia::app
