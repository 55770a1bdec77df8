#include "lobelia/transfer/diffuse_sides.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "lobelia/base/parallel.h"
#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/relight/visibility_data.h"

namespace lobelia::transfer {
namespace {

bool isDiffuseTowards(const Scene& scene, const SurfacePoint& at, Vec3f wo) {
  const Bsdf bsdf = makeBsdf(scene, at, wo, 0);
  return std::any_of(bsdf.lobes, bsdf.lobes + bsdf.lobeCount, [&](const Lobe& lobe) {
    return isDiffuse(lobe.type) && isActive(lobe, dot(wo, bsdf.frameOf(lobe).n));
  });
}

}  // namespace

DiffuseSides::DiffuseSides(size_t vertexCount, std::span<const uint32_t> backs) {
  if (backs.empty()) return;
  const bool ascend =
      std::adjacent_find(backs.begin(), backs.end(), std::greater_equal{}) == backs.end();
  if (!ascend || backs.back() >= vertexCount)
    throw std::invalid_argument(fmt::format(
        "vertices with diffuse light behind do not ascend, or are more than the {} there are",
        vertexCount));
  before_.assign(vertexCount + 1, 0);
  for (const uint32_t vertex : backs) before_[vertex + 1] = 1;
  for (size_t v = 0; v < vertexCount; ++v) before_[v + 1] += before_[v];
}

std::vector<uint32_t> DiffuseSides::backs() const {
  std::vector<uint32_t> out;
  for (size_t v = 0; v + 1 < before_.size(); ++v)
    if (hasBack(v)) out.push_back(static_cast<uint32_t>(v));
  return out;
}

DiffuseVertices findDiffuse(const Scene& scene, std::span<const TransferVertex> vertices) {
  const std::vector<uint8_t> bothSides = relight::bothSidesOf(scene);
  std::vector<uint8_t> front(vertices.size()), back(vertices.size());
  parallelFor(vertices.size(), 256, [&](size_t v) {
    const TransferVertex& vertex = vertices[v];
    const SurfacePoint at = surfacePoint(scene, vertex.hit());
    front[v] = isDiffuseTowards(scene, at, vertex.n) ? 1 : 0;
    back[v] = bothSides[vertex.instance] != 0 && isDiffuseTowards(scene, at, -vertex.n) ? 1 : 0;
  });
  DiffuseVertices out;
  for (uint32_t v = 0; v < vertices.size(); ++v) {
    out.any = out.any || front[v] != 0 || back[v] != 0;
    if (back[v] != 0) out.backs.push_back(v);
  }
  return out;
}

}  // namespace lobelia::transfer
