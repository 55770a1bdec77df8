// Vertices inside of other objects, where bodies go through one another: a handle's in the pot that
// it is stuck to. Nothing that can be seen is as dark as what they receive, and between them and
// the first vertex outside their darkness would show. [P002] does not speak of them.
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/relight/vertex_faces.h"
#include "lobelia/trace/tracer.h"
#include "lobelia/transfer/transfer_mesh.h"

namespace lobelia::transfer {

// 1 by vertex of the mesh that is buried: none of 162 rays from it escapes, and most of them meet a
// surface from behind that scatters nothing there. bothSides: by instance
// (relight::bothSidesOf()). Counts "transfer_rays" and "vertices_buried". Throws Cancelled.
std::vector<uint8_t> buriedVertices(const Tracer& tracer, const TransferMesh& mesh,
                                    const relight::VertexFaces& faces,
                                    std::span<const uint8_t> bothSides, Context& context);

}  // namespace lobelia::transfer
