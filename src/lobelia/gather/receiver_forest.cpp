#include "lobelia/gather/receiver_forest.h"

#include <map>

#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/gather/sphere.h"

namespace lobelia::gather {
namespace {

using trees::BoundItem;
using trees::BoundTree;

bool isGlossy(const Lobe& lobe) {
  return !isDiffuse(lobe.type) && lobe.type != LobeType::diffuseTransmission;
}

// The side from which light is scattered to wo.
Vec3f litSide(const ReceiverPoint& point, const Lobe& lobe) {
  const bool behind = (dot(point.frame.n, point.wo) < 0) != isTransmission(lobe.type);
  return behind ? -point.frame.n : point.frame.n;
}

// receivers: with one lobe each.
BoundItem itemOf(const Receivers& receivers, size_t i) {
  const ReceiverPoint& point = receivers.points[i];
  const float weight = luminance(point.weight);
  const SamplingLobes lobes = samplingLobes(receiverBsdf(receivers, point), point.wo);
  BoundItem item;
  item.p = point.p;
  item.n = litSide(point, receivers.lobes[point.firstLobe]);
  item.cosine = weight * lobes.diffuse;
  item.gaussianCount = lobes.gaussianCount;
  for (int g = 0; g < lobes.gaussianCount; ++g) {
    const PreparedSphere::Gaussian& from = lobes.gaussians[g];
    item.gaussians[g] = {from.axis, from.sharpness, weight * from.amplitude};
  }
  return item;
}

void addTiles(const BoundTree& tree, uint32_t node, std::vector<uint32_t>* tiles) {
  if (tree.nodes()[node].count <= kMaxTilePoints) return tiles->push_back(node);
  addTiles(tree, tree.left(node), tiles);
  addTiles(tree, tree.right(node), tiles);
}

// One lobe of a point given.
struct PointLobe {
  uint32_t point, lobe;
};

void plant(const Receivers& receivers, const std::vector<PointLobe>& chosen, float scale,
           ReceiverForest::Tree* out) {
  const auto single = [&](const PointLobe& at, Receivers* to) {
    ReceiverPoint point = receivers.points[at.point];
    point.firstLobe = static_cast<uint32_t>(to->lobes.size());
    point.lobeCount = 1;
    to->points.push_back(point);
    to->lobes.push_back(receivers.lobes[at.lobe]);
  };
  Receivers given;
  for (const PointLobe& at : chosen) single(at, &given);
  out->glossy = isGlossy(given.lobes[0]);
  out->depth = given.points[0].depth;
  out->tree = BoundTree(
      static_cast<uint32_t>(chosen.size()), [&](uint32_t i) { return itemOf(given, i); },
      BoundTree::Side::receivers, scale, kStrip);
  for (const uint32_t i : out->tree.order()) {
    single(chosen[i], &out->receivers);
    out->points.push_back(chosen[i].point);
  }
  addTiles(out->tree, 0, &out->tiles);
}

}  // namespace

ReceiverForest plantReceivers(const Receivers& receivers, float scale, bool byDepth) {
  std::map<std::pair<int, LobeKinds>, std::vector<PointLobe>> kinds;
  for (uint32_t i = 0; i < receivers.points.size(); ++i) {
    ReceiverPoint point = receivers.points[i];
    const uint32_t end = point.firstLobe + point.lobeCount;
    point.lobeCount = 1;
    for (; point.firstLobe < end; ++point.firstLobe)
      kinds[{byDepth ? point.depth : 0, kindsOf(receivers, point)}].push_back({i, point.firstLobe});
  }
  ReceiverForest forest;
  for (const auto& [kind, chosen] : kinds)
    plant(receivers, chosen, scale, &forest.trees.emplace_back());
  return forest;
}

}  // namespace lobelia::gather
