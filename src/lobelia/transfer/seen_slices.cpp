#include "lobelia/transfer/seen_slices.h"

#include "lobelia/transfer/frame_vertices.h"

namespace lobelia::transfer {

SliceMask seenSlices(const SliceLookup& lookup, const TransferData& data,
                     std::span<const Camera> cameras) {
  const size_t directions = lookup.directions().count();
  SliceMask seen(data.mesh.vertices.size() * directions, false);
  for (const Camera& camera : cameras) {
    const EyeDirection eye(camera);
    for (uint32_t v = 0; v < data.mesh.vertices.size(); ++v) {
      const TransferVertex& at = data.mesh.vertices[v];
      for (const Side side : {Side::front, Side::back})
        for (const uint32_t k : lookup.view(v, eye.from(at.p, at.n), side).place.index)
          seen[v * directions + k] = true;
    }
  }
  return seen;
}

}  // namespace lobelia::transfer
