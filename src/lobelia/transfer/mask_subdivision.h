// Subdividing triangles where what their vertices see differs [P002 section 6.1].
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/trace/tracer.h"
#include "lobelia/transfer/geodesic_grid.h"
#include "lobelia/transfer/transfer_mesh.h"

namespace lobelia::transfer {

struct MaskSettings {
  int level = 7;             // grid of the masks' directions
  float tolerance = 0.005f;  // share of the mask's directions that may differ along an edge
  // How often an edge may be halved; of such as are longer than an eighth of the scene, from there
  // on. 0: the mesh stays as it is.
  int rounds = 3;
  // 0: any number. What needs it most is halved first, round by round, with a warning.
  size_t mostVertices = 0;
  uint64_t memoryBytes = uint64_t{1} << 30;  // for masks; those of more vertices are traced again
};

// Counts: "mask_rays", "vertices_added". Throws Cancelled with the context. No cracks: triangles
// that share an edge agree on its middle.
relight::SampleMesh subdividedByMasks(const Tracer& tracer, relight::SampleMesh mesh,
                                      const MaskSettings& settings, Context& context);

}  // namespace lobelia::transfer
