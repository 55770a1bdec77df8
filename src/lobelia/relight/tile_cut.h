// The light cut of a tile: the nodes of the light tree by which its pixels sum light.
//
// The paper selects one cut for a frame, by error and then by intensity [P004 section 3.2]. From
// infinity that is right: a node is as bright and as large for every pixel. Light from surfaces is
// not: the wall next to a pixel wants fine nodes and the one across the room coarse ones. So each
// tile of the frame selects its own cut, with the same number of nodes, by what a node's extent
// may cost the pixels that want it finest (group_error.h). Intensity is part of the error.
#pragma once

#include <span>

#include "lobelia/relight/group_error.h"
#include "lobelia/relight/light_cut.h"
#include "lobelia/relight/surface_light.h"

namespace lobelia::relight {

struct TileCut {
  LightCut cut;  // x, y, z: places
  // Of the nodes, filled up to whole chunks; see NearLights (local_kernels.h).
  AlignedFloats nx, ny, nz, variance, extent2;
  std::vector<uint32_t> chunks;  // those with a node that may send light to the tile
};

// Keeps its memory from tile to tile. For one thread.
class TileCutSelector {
 public:
  // groups: at least one, at most GroupLanes::kMost. nodeCount: at most, at least 1. The whole tree
  // is the cut where it has no more leaves.
  void select(const SurfaceLight& light, std::span<const PixelGroup> groups, size_t nodeCount,
              TileCut* out);

 private:
  struct Candidate {
    float error;
    uint32_t node;
    bool operator<(const Candidate& o) const {  // of equal ones the first in the tree
      return error != o.error ? error < o.error : node > o.node;
    }
  };
  std::vector<Candidate> heap_;
  std::vector<size_t> nodes_;
};

}  // namespace lobelia::relight
