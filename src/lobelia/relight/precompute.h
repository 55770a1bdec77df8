// Precomputation of visibility cuts, from light samples to the cuts of all vertices
// [P004 section 4.1].
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/relight/visibility_data.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::relight {

struct PrecomputeSettings {
  LightSamples::Kind light = LightSamples::Kind::environment;
  size_t sampleCount = 32768;  // a power of two, at most 2^15
  float sigma = 2;             // bound of each node's error [eq. 6]
  size_t mostNodes = 1000;     // of a cut
  float beta = 0.45f;          // weight of the geometric metric [eq. 13]; 1: no pilot visibility
  size_t clusterCount = 1024;  // of vertices for pilot visibility, a power of two
  int subdivision = 3;         // how often an edge may be halved; 0: the mesh stays as it is
  bool adaptive = true;        // trace few rays where vertices nearby agree
  bool ignoreBelowHorizon = true;  // off: what lies behind all faces counts as blocked and matters
  bool verifyAdaptive = false;     // trace all as well, and count what differs (values adaptive_*)
};

// The seed is the context's. Throws Cancelled when the context is. Seconds by stage: samples,
// pilot, trees, subdivision, visibility. Counts: shadow_rays, pilot_rays, subdivision_rays,
// vertices, vertices_added, cut_nodes, cuts_capped. Values: cut_rms, cut_size.
VisibilityData precomputeVisibility(const Tracer& tracer, const PrecomputeSettings& settings,
                                    Context& context);

}  // namespace lobelia::relight
