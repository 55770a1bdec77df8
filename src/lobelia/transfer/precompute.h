// Precomputation of transfer, from the adaptive mesh to all passes [P002 sections 5, 6].
#pragma once

#include <functional>
#include <string>

#include "lobelia/base/context.h"
#include "lobelia/trace/tracer.h"
#include "lobelia/transfer/transfer_data.h"

namespace lobelia::transfer {

struct TransferSettings {
  int directionLevel = 3;  // 642 directions to the eye
  int rayLevel = 0;        // grid of rays from each vertex; 0: 5, or 6 where its lobes need it
  int maskLevel = 7;       // grid of visibility masks for subdivision: 163,842
  float maskTolerance = 0.005f;  // share of a mask by which the ends of an edge may differ
  int subdivision = 3;           // how often an edge may be halved; 0: the mesh stays as it is
  // Vertices that subdivision may leave; 0: as many as it adds to the scene's, or 20,000 if that is
  // more.
  size_t mostVertices = 0;
  int bounces = 2;     // reflections at other surfaces: passes - 1
  int classCount = 1;  // TransferData::classCount
  // Budget for all that is made, the scene itself and its tree of rays not counted; 0: three
  // quarters of the machine's.
  uint64_t memoryBytes = 0;
  // Folder for what is done so far, from which a run that was stopped goes on; made if it is not
  // there, emptied and removed at the end. "": none.
  std::string workFolder;
  // Called with the data when they are whole, before the work folder is removed: what it throws
  // leaves the folder as it is, so that a disk that was full when saving costs nothing. May be
  // null.
  std::function<void(const TransferData&)> keep;
};

// No randomness. Throws Cancelled when the context is (what is done stays in the work folder),
// RuntimeError where the budget is too small, with about what is needed, after few blocks of a
// pass if the whole of it cannot fit. Seconds by stage: "masks"
// (masks and subdivision), "trace", "direct", "bounce". Counts: "vertices", "vertices_added",
// "mask_rays", "transfer_rays", "hits", "slices", "slices_unoccluded", "records", "blocks" (of all
// passes), "blocks_resumed", "nonfinite"; rays, hits and slices are those of blocks that were not
// resumed.
TransferData precomputeTransfer(const Tracer& tracer, const TransferSettings& settings,
                                Context& context);

}  // namespace lobelia::transfer
