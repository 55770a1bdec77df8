// Deviations from the paper, both of sections 3.4 and 5.5 of the project's notes on it:
//  - d_v is printed with the factor A^2 of a sample's solid angle, which would make it about ten
//    million times smaller than d_g for the binary visibility that is meant here; without it the
//    two are of one size, as the paper says they are.
//  - Directions of an environment have places on the unit sphere (diameter 2 for d) and no normals.
// A cluster's row has the mean of two of its vertices, not of all: clusters are small, and there
// are a thousand of them.
#include "lobelia/relight/pilot_visibility.h"

#include <algorithm>
#include <bit>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/relight/median_clusters.h"
#include "lobelia/relight/vertex_visibility.h"

namespace lobelia::relight {
namespace {

constexpr float kK = 30;  // [eq. 11]
constexpr uint64_t kStream = 0x70696c6f;

}  // namespace

std::vector<uint32_t> vertexOrder(const SampleMesh& mesh, const VertexFaces& faces, float diagonal,
                                  int levels) {
  std::vector<Vec3f> normals(mesh.positions().size());
  for (size_t v = 0; v < normals.size(); ++v)
    if (!faces.at(v).empty()) normals[v] = faces.at(v).front().n;
  Features features;
  features.p = mesh.positions(), features.n = normals;
  features.placeWeight = sqr(kK / diagonal), features.normalWeight = 1;
  return clusterOrder(features, levels);
}

std::vector<uint8_t> pilotVisibility(const Tracer& tracer, const LightSamples& samples,
                                     const VertexFaces& faces, std::span<const uint32_t> order,
                                     size_t clusterCount, Context& context) {
  const size_t count = samples.count();
  const std::vector<size_t> begin = clusterBegins(order.size(), std::countr_zero(clusterCount));
  std::vector<uint8_t> columns(clusterCount * count, 0);
  parallelRanges(clusterCount, 8, [&](size_t first, size_t last) {
    if (context.cancelled()) return;
    VertexTracer rays(tracer, samples);
    LeafBits bits = leafBits(samples);
    for (size_t c = first; c < last; ++c) {
      const size_t size = begin[c + 1] - begin[c];
      for (uint8_t m = 0; m < kPilotMembers && size > 0; ++m) {
        const uint64_t random = hashCombine(hashCombine(context.seed, kStream), 2 * c + m);
        rays.prepare(faces.at(order[begin[c] + random % size]), &bits);
        rays.traceAll(&bits);
        for (size_t i = 0; i < count; ++i)
          columns[c * count + i] += static_cast<uint8_t>(bits.visible[i / 64] >> (i % 64) & 1);
      }
    }
    context.statistics.addCount("pilot_rays", rays.rays());
  });
  if (context.cancelled()) throw Cancelled{};
  std::vector<uint8_t> rows(columns.size());
  parallelFor(count, 256, [&](size_t i) {
    for (size_t c = 0; c < clusterCount; ++c) rows[i * clusterCount + c] = columns[c * count + i];
  });
  return rows;
}

std::vector<uint32_t> treeOrder(const LightSamples& samples, std::span<const uint8_t> rows,
                                size_t rowLength, float beta, float diagonal) {
  if (rows.empty()) beta = 1, rowLength = 0;
  const bool directions = samples.kind == LightSamples::Kind::environment;
  Features features;
  features.p = samples.p, features.n = samples.n, features.rows = rows;
  features.rowLength = rowLength;
  features.placeWeight = beta * sqr(kK / (directions ? 2 : diagonal));
  features.normalWeight = beta;
  if (rowLength > 0) {
    features.rowWeight = (1 - beta) * sqr((kK + 1) / kPilotMembers) / static_cast<float>(rowLength);
  }
  return clusterOrder(features, std::countr_zero(samples.count()));
}

}  // namespace lobelia::relight
