#include "lobelia/relight/fine_light.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lobelia::relight {
namespace {

constexpr int kChunkLevels = std::countr_zero(kChunk);

void addCone(const SampleTree& tree, size_t node, FineUnits* units) {
  const Vec3f mean = tree.meanP[node];
  const float size = length(mean), cosine = tree.spread[node];
  const Vec3f axis = size > 0 ? mean / size : Vec3f(0, 0, 1);
  units->x.push_back(axis.x), units->y.push_back(axis.y), units->z.push_back(axis.z);
  units->cosine.push_back(cosine);
  units->sine.push_back(std::sqrt(std::max(1 - cosine * cosine, 0.f)));
}

}  // namespace

FineUnits makeFineUnits(const SampleTree& tree, const LightSums& sums, const LightCut& cut,
                        int level) {
  FineUnits units;
  units.level = level;
  const int chunkLevel = level + kChunkLevels;
  for (size_t begin = 0, end; begin < cut.count; begin = end) {
    const int unitLevel = std::max<int>(cut.nodes[begin].level, chunkLevel);
    const uint32_t place = cut.begin[begin] >> unitLevel;
    end = cut.atLeaf[(place + 1) << unitLevel];
    const size_t node = tree.heapIndex(unitLevel, place);
    const bool coarse = std::any_of(cut.nodes.begin() + static_cast<std::ptrdiff_t>(begin),
                                    cut.nodes.begin() + static_cast<std::ptrdiff_t>(end),
                                    [&](CutNode n) { return n.level > level; });
    if (!coarse || sums.power(node) == Rgb{}) continue;
    addCone(tree, node, &units);
    units.firstNode.push_back(static_cast<uint32_t>(node << (unitLevel - level)));
    units.chunkCount.push_back(1u << (unitLevel - chunkLevel));
    units.cutBegin.push_back(static_cast<uint32_t>(begin));
    units.cutEnd.push_back(static_cast<uint32_t>(end));
    units.unitLevel.push_back(static_cast<uint8_t>(unitLevel));
    ++units.count;
  }
  const size_t padded = (units.count + kChunk - 1) / kChunk * kChunk;
  for (AlignedFloats* values : {&units.x, &units.y, &units.z, &units.cosine, &units.sine})
    values->resize(padded, 0.f);
  return units;
}

}  // namespace lobelia::relight
