#include "lobelia/relight/frame_light.h"

#include <bit>

#include "lobelia/base/parallel.h"

namespace lobelia::relight {

FrameLight makeFrameLight(const DistantLight& light, const Mat4& turned,
                          const LightSamples& samples, const SampleTree& tree,
                          const DirectionLookup& lookup, const LightCutSettings& settings) {
  FrameLight out;
  out.sums = lightSums(light, turned, samples, lookup);
  out.cut = selectLightCut(out.sums, settings);
  out.toScene = transpose(turned);
  const int levels = tree.levels - std::countr_zero(kChunk) + 1;
  if (levels <= 0) return out;  // too small a tree to fill a chunk
  out.fine.resize(static_cast<size_t>(levels));
  parallelFor(out.fine.size(), 1, [&](size_t level) {
    out.fine[level] = makeFineUnits(tree, out.sums, out.cut, static_cast<int>(level));
  });
  return out;
}

}  // namespace lobelia::relight
