// Receivers as the choice of a cut's lights sees them (cut_kernels.h).
#pragma once

#include "lobelia/gather/sphere.h"
#include "lobelia/gather/tile.h"

namespace lobelia::gather {

// One receiver per lane.
struct CutReceivers {
  StripV3 p, n;
  alignas(64) float above[kStrip];      // as PointStrip
  alignas(64) float below[kStrip];      //
  alignas(64) float diffuse[kStrip];    // as SamplingStrip
  alignas(64) float nearScale[kStrip];  // as PointStrip, of a run the largest
  alignas(64) float weight[kStrip];  // of the receiver in the picture; 0: the lane does not count
  size_t gaussianCount = 0;
  GaussianStrip gaussians[kSphereGaussians];
  // Where a lane stands for several receivers: the mean square distance of their places to its own,
  // and the most by which their places and normals differ from its own.
  alignas(64) float variance[kStrip];
  alignas(64) float placeSlack[kStrip];
  alignas(64) float normalSlack[kStrip];
};

// tile: a single strip of these receivers, with Gaussians (addSampling()).
CutReceivers cutReceivers(const Tile& tile, const Receivers& receivers);
// Every lane of a run of kStrip / count stands for all of these receivers of the run: where it can
// see nothing of a light, none of them can. count: a power of two, at most kStrip.
CutReceivers representatives(const CutReceivers& receivers, int count);
// The same, but as reflecting as the most reflecting receiver of a run, at its lobes' peaks.
CutReceivers peaks(const CutReceivers& receivers, int count);
// Makes lane `to` of *out a copy of a lane of these receivers. out: without Gaussians before the
// first lane is set; it may come to hold receivers with fewer and with more of them.
void setLane(const CutReceivers& receivers, int lane, int to, CutReceivers* out);

}  // namespace lobelia::gather
