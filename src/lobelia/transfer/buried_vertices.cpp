#include "lobelia/transfer/buried_vertices.h"

#include <algorithm>
#include <bit>

#include "lobelia/base/parallel.h"
#include "lobelia/transfer/vertex_rays.h"

namespace lobelia::transfer {
namespace {

constexpr int kLevel = 2;  // of the grid of rays

class BurialTest {
 public:
  BurialTest(const Tracer& tracer, const TransferMesh& mesh, const GeodesicGrid& grid,
             std::span<const uint8_t> bothSides)
      : scene_(tracer.scene()),
        firstTriangle_(mesh.mesh.firstTriangle()),
        grid_(grid),
        bothSides_(bothSides),
        tracer_(tracer, grid, firstTriangle_) {}

  bool isBuried(std::span<const relight::FacePlace> faces) {
    tracer_.trace(faces, &rays_);
    const auto isEmpty = [](uint64_t word) { return word == 0; };
    if (rays_.hits.empty() || !std::all_of(rays_.free.begin(), rays_.free.end(), isEmpty))
      return false;
    size_t behind = 0, hit = 0;
    for (size_t w = 0; w < rays_.blocked.size(); ++w)
      for (uint64_t bits = rays_.blocked[w]; bits != 0; bits &= bits - 1) {
        const size_t d = 64 * w + static_cast<size_t>(std::countr_zero(bits));
        behind += isBehind(rays_.hits[hit++], grid_.directions()[d]) ? 1 : 0;
      }
    return 2 * behind > hit;
  }
  uint64_t rays() const { return tracer_.rays(); }

 private:
  bool isBehind(const RayHit& hit, Vec3f d) const {
    const auto next = std::upper_bound(firstTriangle_.begin(), firstTriangle_.end(), hit.triangle);
    const auto instance = static_cast<uint32_t>(next - firstTriangle_.begin() - 1);
    if (bothSides_[instance] != 0) return false;
    const uint32_t triangle = hit.triangle - firstTriangle_[instance];
    return dot(surfacePoint(scene_, hit.at(instance, triangle)).ng, d) > 0;
  }

  const Scene& scene_;
  const std::span<const uint32_t> firstTriangle_;
  const GeodesicGrid& grid_;
  const std::span<const uint8_t> bothSides_;
  RayTracer tracer_;
  VertexRays rays_;
};

}  // namespace

std::vector<uint8_t> buriedVertices(const Tracer& tracer, const TransferMesh& mesh,
                                    const relight::VertexFaces& faces,
                                    std::span<const uint8_t> bothSides, Context& context) {
  const GeodesicGrid grid(kLevel);
  std::vector<uint8_t> out(mesh.vertices.size());
  parallelRanges(out.size(), 256, [&](size_t begin, size_t end) {
    if (context.cancelled()) return;
    BurialTest test(tracer, mesh, grid, bothSides);
    uint64_t buried = 0;
    for (size_t v = begin; v < end; ++v) buried += out[v] = test.isBuried(faces.at(v)) ? 1 : 0;
    context.statistics.addCount("transfer_rays", test.rays());
    context.statistics.addCount("vertices_buried", buried);
  });
  if (context.cancelled()) throw Cancelled{};
  return out;
}

}  // namespace lobelia::transfer
