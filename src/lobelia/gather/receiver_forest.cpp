#include "lobelia/gather/receiver_forest.h"

#include <map>

#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/gather/sphere.h"
#include "lobelia/gather/whole_receivers.h"

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

// receivers: with one lobe each, whose Gaussians are of one colour.
BoundItem itemOf(const Receivers& receivers, size_t i) {
  const ReceiverPoint& point = receivers.points[i];
  const SamplingLobes lobes = samplingLobes(receiverBsdf(receivers, point), point.wo);
  const Rgb weight = sizeOf(point.weight);
  const Rgb color =
      weight * (lobes.gaussianCount > 0 ? lobes.gaussians[0].color : lobes.diffuseColor);
  const float most = maxComponent(color);
  BoundItem item;
  item.p = point.p;
  item.n = litSide(point, receivers.lobes[point.firstLobe]);
  if (most > 0) item.mean = luminance(color) / most, item.least = minComponent(color) / most;
  item.cosine = maxComponent(weight * lobes.diffuseColor);
  item.gaussianCount = lobes.gaussianCount;
  for (int g = 0; g < lobes.gaussianCount; ++g) {
    const PreparedSphere::Gaussian& from = lobes.gaussians[g];
    item.gaussians[g] = {from.axis, from.sharpness, maxComponent(weight * from.color)};
  }
  return item;
}

ClampedLight clampedOf(const Receivers& receivers, size_t i) {
  const ReceiverPoint& point = receivers.points[i];
  const SamplingLobes lobes = samplingLobes(receiverBsdf(receivers, point), point.wo);
  const Rgb weight = sizeOf(point.weight);
  const Rgb lobe = lobes.gaussianCount > 0 ? lobes.gaussians[0].color : lobes.diffuseColor;
  const Rgb light = maxComponent(lobe) > 0 ? weight * lobe / maxComponent(lobe) : Rgb{};
  return {maxComponent(weight), luminance(light), minComponent(light)};
}

// Children come after their parent in preorder.
void addClamped(const Receivers& receivers, ReceiverForest::Tree* out) {
  const auto nodes = out->tree.nodes();
  out->clamped.resize(nodes.size());
  for (uint32_t i = static_cast<uint32_t>(nodes.size()); i-- > 0;) {
    if (nodes[i].leaf()) {
      out->clamped[i] = clampedOf(receivers, nodes[i].first);
      continue;
    }
    const uint32_t right = out->tree.right(i);
    const ClampedLight &a = out->clamped[out->tree.left(i)], &b = out->clamped[right];
    const float share = static_cast<float>(nodes[right].count) / static_cast<float>(nodes[i].count);
    out->clamped[i] = {std::max(a.most, b.most), a.mean + share * (b.mean - a.mean),
                       std::min(a.least, b.least)};
  }
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

// Appends a point with `count` of its lobes.
void append(const Receivers& from, uint32_t point, uint32_t firstLobe, uint8_t count,
            Receivers* to) {
  ReceiverPoint copy = from.points[point];
  copy.firstLobe = static_cast<uint32_t>(to->lobes.size());
  copy.lobeCount = count;
  to->points.push_back(copy);
  const auto first = from.lobes.begin() + static_cast<ptrdiff_t>(firstLobe);
  to->lobes.insert(to->lobes.end(), first, first + count);
}

void plant(const Receivers& receivers, const std::vector<PointLobe>& chosen, float scale,
           bool whole, ReceiverForest::Tree* out) {
  Receivers given;
  for (const PointLobe& at : chosen) append(receivers, at.point, at.lobe, 1, &given);
  out->glossy = isGlossy(given.lobes[0]);
  out->depth = given.points[0].depth;
  out->tree = BoundTree(
      static_cast<uint32_t>(chosen.size()), [&](uint32_t i) { return itemOf(given, i); },
      BoundTree::Side::receivers, scale, kStrip);
  for (const uint32_t i : out->tree.order()) {
    const PointLobe& at = chosen[i];
    append(receivers, at.point, at.lobe, 1, &out->receivers);
    out->points.push_back(at.point);
    const ReceiverPoint& point = receivers.points[at.point];
    if (whole && point.lobeCount > 1)
      append(receivers, at.point, point.firstLobe, point.lobeCount, &out->whole);
  }
  if (whole) addClamped(out->receivers, out);
  addTiles(out->tree, 0, &out->tiles);
}

}  // namespace

ReceiverForest plantReceivers(const Receivers& receivers, float scale, bool byDepth, bool wholes) {
  struct Kind {
    int depth;
    LobeKinds lobe, whole;
    uint32_t place;  // of the lobe in the whole
    auto operator<=>(const Kind&) const = default;
  };
  std::map<Kind, std::vector<PointLobe>> kinds;
  for (uint32_t i = 0; i < receivers.points.size(); ++i) {
    const ReceiverPoint& point = receivers.points[i];
    for (uint32_t l = 0; l < point.lobeCount; ++l) {
      ReceiverPoint one = point;
      one.firstLobe += l, one.lobeCount = 1;
      Kind kind{byDepth ? point.depth : 0, kindsOf(receivers, one), {}, 0};
      if (wholes) kind.whole = kindsOf(receivers, point), kind.place = l;
      kinds[kind].push_back({i, one.firstLobe});
    }
  }
  ReceiverForest forest;
  for (const auto& [kind, chosen] : kinds)
    plant(receivers, chosen, scale, wholes, &forest.trees.emplace_back());
  return forest;
}

}  // namespace lobelia::gather
