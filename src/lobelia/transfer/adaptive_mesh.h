// The mesh at whose vertices transfer is precomputed: the scene's, subdivided where what its
// vertices see differs [P002 section 6.1].
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/trace/tracer.h"
#include "lobelia/transfer/precompute.h"

namespace lobelia::transfer {

// settings: maskLevel, maskTolerance, subdivision, mostVertices and memoryBytes count; masks have a
// quarter of the memory. Warns where mostVertices is below what the scene has. Counts and throws as
// subdividedByMasks().
relight::SampleMesh adaptiveMesh(const Tracer& tracer, const TransferSettings& settings,
                                 Context& context);

}  // namespace lobelia::transfer
