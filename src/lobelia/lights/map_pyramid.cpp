#include "lobelia/lights/map_pyramid.h"

#include <cmath>

#include "lobelia/base/parallel.h"

namespace lobelia {
namespace {

// Sums of 2 x 2 neighbours among size^2 texels.
template <class SumOf>
std::vector<ClusterSums> halved(size_t size, const SumOf& sumOf) {
  const size_t half = size / 2;
  std::vector<ClusterSums> sums(half * half);
  parallelFor(half, 1, [&](size_t y) {
    for (size_t x = 0; x < half; ++x) {
      ClusterSums& sum = sums[y * half + x];
      const size_t corner = 2 * y * size + 2 * x;
      for (const size_t texel : {corner, corner + 1, corner + size, corner + size + 1})
        sum += sumOf(texel);
    }
  });
  return sums;
}

}  // namespace

MapPyramid::MapPyramid(const ReflectiveShadowMap& map, bool toksvig)
    : map_(map), toksvig_(toksvig) {
  size_t size = map.size;
  if (size > 1)
    levels_.push_back(
        halved(size, [&](size_t i) { return ClusterSums::of(map.texels[i], toksvig); }));
  while ((size /= 2) > 1)
    levels_.push_back(halved(
        size, [&](size_t i) -> auto& { return levels_.back()[i]; }));
  total_ = levels_.empty() ? double{map.texels[0].power()} : levels_.back()[0].weight;
}

ClusterSums MapPyramid::kernel(Vec2f at, float level) const {
  Tap all[kTaps];
  const int count = taps(at, level, all);
  ClusterSums sum;
  for (int i = 0; i < count; ++i) {
    ClusterSums one = all[i].level == 0
                          ? ClusterSums::of(map_.texels[all[i].texel], toksvig_)
                          : levels_[static_cast<size_t>(all[i].level) - 1][all[i].texel];
    one *= all[i].factor;
    sum += one;
  }
  return sum;
}

double MapPyramid::kernelWeight(Vec2f at, float level) const {
  Tap all[kTaps];
  const int count = taps(at, level, all);
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += all[i].factor * weightOf(all[i]);
  return sum;
}

double MapPyramid::weightOf(const Tap& tap) const {
  return tap.level == 0 ? double{map_.texels[tap.texel].power()}
                        : levels_[static_cast<size_t>(tap.level) - 1][tap.texel].weight;
}

// Averages of level l are sums over 4^l: the kernel, which is 4^level averages, takes 4^(level - l)
// of the sums.
int MapPyramid::taps(Vec2f at, float level, Tap* taps) const {
  const int below = std::min(static_cast<int>(level), top());
  const double part = std::clamp(double{level} - below, 0.0, 1.0);
  int count = 0;
  addBilinear(at, below, (1 - part) * std::exp2(2 * part), taps, &count);
  if (part > 0 && below < top())
    addBilinear(at, below + 1, part * std::exp2(2 * (part - 1)), taps, &count);
  return count;
}

void MapPyramid::addBilinear(Vec2f at, int level, double factor, Tap* taps, int* count) const {
  const int size = static_cast<int>(map_.size >> level);
  const double x = double{at.x} * size - 0.5, y = double{at.y} * size - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  for (int corner = 0; corner < 4; ++corner) {
    const int right = corner & 1, down = corner >> 1;
    const double share = std::abs(1 - right - (x - x0)) * std::abs(1 - down - (y - y0));
    if (!(share > 0)) continue;
    const size_t column = static_cast<size_t>(std::clamp(x0 + right, 0, size - 1));
    const size_t row = static_cast<size_t>(std::clamp(y0 + down, 0, size - 1));
    taps[(*count)++] = {level, row * static_cast<size_t>(size) + column, factor * share};
  }
}

}  // namespace lobelia
