// The light cut of a tile: the nodes of the light tree by which its pixels sum light.
//
// The paper selects one cut for a frame, by error and then by intensity [P004 section 3.2]. From
// infinity that is right: a node is as bright and as large for every pixel. Light from surfaces is
// not: the wall next to a pixel wants fine nodes and the one across the room coarse ones. So each
// tile of the frame selects its own cut, with the same number of nodes, by what a node's extent
// may cost the pixels that want it finest:
//   power x geometry x (extent over distance + spread of normals)
// and more of it where a glossy lobe reflects the node. Intensity is part of the error.
#pragma once

#include <span>

#include "lobelia/relight/light_cut.h"
#include "lobelia/relight/surface_light.h"

namespace lobelia::relight {

// Some pixels that lie close together.
struct PixelGroup {
  Bounds3f box;
  Vec3f normal;       // unit mean of geometric normals on the side of the eye
  bool flat = false;  // do all normals agree with it?
  // The narrowest of the glossy lobes, around mirror directions: chord (2 sin of half the angle)
  // about the axis that holds its reach at all pixels. 0: there is none.
  Vec3f axis;
  float chord = 0;
  float width = 1;  // of the lobe, radians
  float peak = 0;   // over that of a diffuse lobe
};

struct TileCut {
  LightCut cut;              // x, y, z: places
  AlignedFloats nx, ny, nz;  // mean normals, filled up to whole chunks
};

// Keeps its memory from tile to tile. For one thread.
class TileCutSelector {
 public:
  // nodeCount: at most, at least 1. The whole tree is the cut where it has no more leaves.
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
  float errorOf(const SurfaceLight& light, uint32_t node) const;

  std::span<const PixelGroup> groups_;
  std::vector<Candidate> heap_;
  std::vector<size_t> nodes_;
};

}  // namespace lobelia::relight
