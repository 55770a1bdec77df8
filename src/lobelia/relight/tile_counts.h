// What the tiles of any frame count, said in the statistics: relight's frames and transfer's.
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/path/receivers.h"

namespace lobelia::relight {

// Counts: with bufferNs, mergeNs, shadeNs, objectPixels, vertices, nonFinite and firstBad
// (frame_tile.h). seconds: of the frame, shared out as threads spent theirs.
template <class Counts>
void addTileCounts(const Counts& counts, uint64_t pixels, double seconds, Context& context) {
  Statistics& s = context.statistics;
  const auto spent = static_cast<double>(counts.bufferNs + counts.mergeNs + counts.shadeNs);
  const auto share = [&](int64_t ns) {
    return spent > 0 ? seconds * static_cast<double>(ns) / spent : 0;
  };
  s.addSeconds("buffer", share(counts.bufferNs));
  s.addSeconds("merge", share(counts.mergeNs));
  s.addSeconds("shade", share(counts.shadeNs));
  s.addCount("frames", 1);
  s.addCount("pixels", pixels);
  s.addCount("object_pixels", counts.objectPixels);
  s.addCount("vertices_merged", counts.vertices);
  s.addCount("nonfinite", counts.nonFinite);
  if (counts.firstBad) noteNonFinitePixel(*counts.firstBad, context);
}

}  // namespace lobelia::relight
