#include "lobelia/transfer/gather_block.h"

namespace lobelia::transfer {

size_t BlockRays::byteCount() const {
  return blocked.size() * sizeof(uint64_t) + hits.size() * sizeof(RayHit) +
         slices.size() * sizeof(SeeingSlice) + diffuseWeight.size() * sizeof(float) +
         (hitStart.size() + sliceStart.size()) * sizeof(uint32_t);
}

size_t BlockPass::byteCount() const {
  size_t bytes = diffuse.size() * sizeof(DiffuseLobes) + reflection.byteCount();
  for (const SliceRows& rows : glossy) bytes += rows.byteCount();
  return bytes;
}

void BlockCounts::add(const BlockCounts& o) {
  rays += o.rays, hits += o.hits, slices += o.slices, unoccluded += o.unoccluded;
  nonFinite += o.nonFinite, traceNs += o.traceNs, gatherNs += o.gatherNs;
}

}  // namespace lobelia::transfer
