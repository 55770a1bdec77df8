// Receivers in clusters of up to 16 that are alike: of the same kinds of lobes, near each other and
// turned alike. A cluster fits one strip (tile.h). Where few pixels of a picture are rendered, far
// apart, receivers stay alone.
#pragma once

#include "lobelia/gather/tile.h"

namespace lobelia::gather {

struct ReceiverClusters {
  Receivers receivers;          // points[i] is points[order[i]] of what was given
  std::vector<uint32_t> order;  // points without lobes are left out
  struct Cluster {
    uint32_t begin = 0, end = 0;  // of the points
    bool compact = false;         // near neighbours in the picture and in the scene, turned alike
    // The least power of two, such that the runs of kStrip / representatives points are near each
    // other in the scene and turned alike, or 4.
    int representatives = 1;
  };
  std::vector<Cluster> clusters;
};

// scale: size of the scene; width: pixels in a row of the data window, at least 1.
ReceiverClusters clusterReceivers(const Receivers& receivers, float scale, int width);

}  // namespace lobelia::gather
