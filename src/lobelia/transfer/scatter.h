// The baseline to gathering: lobes fitted to rays that are scattered through the scene until they
// leave it [Green06], as [P002 section 7.6] describes and compares it.
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/trace/tracer.h"
#include "lobelia/transfer/precompute.h"
#include "lobelia/transfer/seen_slices.h"

namespace lobelia::transfer {

// Transfer at the vertices of a mesh (that of precomputeTransfer(), to compare), in the same form.
// settings: directionLevel, bounces and classCount count. raysPerSlice (1 to 65,536): paths for
// each slice that is reflected at all, and for each octant of a vertex' diffuse lobes (of either
// side). only: of this mesh and these directions; slices that are made, the same as without it;
// null: all. Random by the context's seed. Throws UsageError for a number of rays out of range,
// Cancelled when the context is. Seconds: "scatter". Counts: "transfer_rays" (of all segments of
// paths), "slices", "slices_unoccluded", "records", "nonfinite".
TransferData scatterTransfer(const Tracer& tracer, TransferMesh mesh,
                             const TransferSettings& settings, int raysPerSlice, Context& context,
                             const SliceMask* only = nullptr);

}  // namespace lobelia::transfer
