// Pilot visibility: what clusters of vertices see of each light sample [P004 section 3.4].
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/relight/vertex_faces.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::relight {

// How many vertices of a cluster are traced.
inline constexpr uint8_t kPilotMembers = 2;

// The vertices' order by geometry, whose halves' halves (`levels` times) are clusters [eq. 11].
// diagonal: the scene's. Vertices without faces have normal 0.
std::vector<uint32_t> vertexOrder(const SampleMesh& mesh, const VertexFaces& faces, float diagonal,
                                  int levels);

// A row of clusterCount (a power of two) numbers for each sample: how many of the cluster's
// kPilotMembers vertices see it. Adds the count "pilot_rays". Throws Cancelled with the context.
std::vector<uint8_t> pilotVisibility(const Tracer& tracer, const LightSamples& samples,
                                     const VertexFaces& faces,
                                     std::span<const uint32_t> vertexOrder, size_t clusterCount,
                                     Context& context);

// The samples' order in the light tree, by the metric (1 - beta) d_v + beta d_g [eq. 13].
// rows: pilotVisibility(), or empty: d_g alone. diagonal: the scene's, of no meaning for
// directions.
std::vector<uint32_t> treeOrder(const LightSamples& samples, std::span<const uint8_t> rows,
                                size_t rowLength, float beta, float diagonal);

}  // namespace lobelia::relight
