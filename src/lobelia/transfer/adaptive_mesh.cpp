#include "lobelia/transfer/adaptive_mesh.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/transfer/mask_subdivision.h"
#include "lobelia/transfer/memory_budget.h"

namespace lobelia::transfer {
namespace {

constexpr size_t kAllowed = 20000;  // vertices that may be added to any scene

size_t mostVertices(const TransferSettings& settings, size_t before, Context& context) {
  if (settings.mostVertices == 0) return before + std::max(before, kAllowed);
  if (settings.mostVertices < before)
    context.warning(
        fmt::format("--max-vertices {}: the scene itself has {} vertices, which are kept; none are "
                    "added",
                    settings.mostVertices, before));
  return std::max(settings.mostVertices, before);
}

}  // namespace

relight::SampleMesh adaptiveMesh(const Tracer& tracer, const TransferSettings& settings,
                                 Context& context) {
  relight::SampleMesh mesh = splitMesh(tracer.scene());
  const size_t before = mesh.positions().size();
  const MaskSettings masks{settings.maskLevel, settings.maskTolerance, settings.subdivision,
                           mostVertices(settings, before, context),
                           MemoryBudget(settings.memoryBytes).bytes() / 4};
  if (settings.subdivision > 0) mesh = subdividedByMasks(tracer, std::move(mesh), masks, context);
  context.debug(fmt::format("{} vertices, {} after subdivision", before, mesh.positions().size()));
  return mesh;
}

}  // namespace lobelia::transfer
