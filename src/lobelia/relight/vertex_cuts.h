// Visibility and cuts of all vertices, block by block.
//
// A block has some hundred vertices that lie close together. One thread does it: it can then use
// what it knows of a vertex's neighbours in the block (vertex_visibility.h), whatever other threads
// do, and keeps the bits of a block's vertices only.
#pragma once

#include "lobelia/relight/precompute.h"
#include "lobelia/relight/vertex_faces.h"

namespace lobelia::relight {

// How often an order of vertices has to be halved to make blocks.
int vertexBlockLevels(size_t vertexCount);

// Cuts of the vertices of data.mesh over data.tree, in the order of vertices. order: the vertices
// in clusters, vertexBlockLevels() halvings at least (vertexOrder(), pilot_visibility.h). Counts
// and values: precompute.h. Throws Cancelled with the context.
CutSet vertexCuts(const Tracer& tracer, const VisibilityData& data, const VertexFaces& faces,
                  const VertexNeighbours& neighbours, std::span<const uint32_t> order,
                  const PrecomputeSettings& settings, Context& context);

}  // namespace lobelia::relight
