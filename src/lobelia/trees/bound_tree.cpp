#include "lobelia/trees/bound_tree.h"

#include <cmath>
#include <numeric>

#include "lobelia/trees/median_split.h"

namespace lobelia::trees {
namespace {

constexpr int kExtents = 7;
// A difference of normals or of axes of 1, or a factor e of sharpness, counts as much as this share
// of the scene's size.
constexpr float kNormalShare = 0.1f, kAxisShare = 0.05f, kSharpnessShare = 0.02f;

struct Coordinates {
  float x[kExtents];
};

Coordinates coordinatesOf(const BoundItem& item, float inverseScale) {
  Coordinates c{};
  for (int d = 0; d < 3; ++d) c.x[d] = item.p[d] * inverseScale;
  if (item.gaussianCount == 0) {
    for (int d = 0; d < 3; ++d) c.x[3 + d] = kNormalShare * item.n[d];
    return c;
  }
  const BoundItem::Gaussian& g = item.gaussians[0];
  for (int d = 0; d < 3; ++d) c.x[3 + d] = kAxisShare * g.axis[d];
  c.x[6] = kSharpnessShare * std::log(std::max(g.sharpness, 1e-3f));
  return c;
}

}  // namespace

BoundTree::BoundTree(uint32_t count, const std::function<BoundItem(uint32_t)>& item, Side side,
                     float scale, uint32_t strip)
    : strip_(strip) {
  if (count == 0) return;
  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.resize(2 * size_t{count} - 1);
  std::vector<std::vector<SplitRange>> levels;
  {
    const float inverseScale = 1 / std::max(scale, 1e-30f);
    std::vector<Coordinates> coordinates(count);
    parallelFor(count, 1024, [&](size_t i) {
      coordinates[i] = coordinatesOf(item(static_cast<uint32_t>(i)), inverseScale);
    });
    const auto at = [&](uint32_t i, int d) { return coordinates[i].x[d]; };
    levels = MedianSplit<kExtents, decltype(at)>(at, strip, &order_).run(0, 0, count);
  }
  const auto merge = side == Side::lights ? mergedLights : mergedReceivers;
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    parallelFor(level->size(), 256, [&](size_t i) {
      const SplitRange& range = (*level)[i];
      nodes_[range.node] =
          range.count == 1
              ? leafOf(item(order_[range.first]), range.first)
              : merge(nodes_[range.node + 1], nodes_[rightChild(range.node, range.count, strip)]);
    });
  }
}

uint32_t BoundTree::right(uint32_t i) const { return rightChild(i, nodes_[i].count, strip_); }

}  // namespace lobelia::trees
