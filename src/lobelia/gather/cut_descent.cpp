#include "lobelia/gather/cut_descent.h"

#include <algorithm>

namespace lobelia::gather {
namespace {

// A node's bound at its nearest and at its farthest distance; near < 0: the receiver may lie in it.
struct Weights {
  double near = 0, far = 0;
};

Weights weightsOf(const trees::BoundNode& node, const ReceiverNodes& receiver, float upper,
                  bool distant) {
  if (distant || !(upper > 0)) return {double{upper}, double{upper}};
  const Vec3f p = receiver.cosine.centre;
  const Vec3f outside = max(max(node.lo - p, p - node.hi), Vec3f(0.f));
  const Vec3f corner = max(node.hi - p, p - node.lo);  // the farther one of each side
  const float apart = length(node.centre - p);
  const double nearest =
      std::max(double{lengthSquared(outside)}, double{sqr(std::max(apart - node.radius, 0.f))});
  const double farthest = std::min(double{lengthSquared(corner)}, double{sqr(apart + node.radius)});
  if (upper < kBoundInfinity) {
    const double ratio = farthest > 0 ? std::min(nearest / farthest, 1.0) : 1.0;
    return {double{upper}, double{upper} * ratio};
  }
  // Angles say nothing where the receiver lies in the node.
  const double peaks =
      (double{node.cosine} + double{node.peak}) *
      (double{receiver.cosine.cosine} + (receiver.glossy ? double{receiver.gaussians.peak} : 0.0));
  return {-1, peaks / std::max(farthest, 1e-30)};
}

double share(double a, double b) { return a + b > 0 ? a / (a + b) : 0.5; }

}  // namespace

double firstChildProbability(const LightForest::Tree& tree, uint32_t first, uint32_t second,
                             const ReceiverNodes& receiver, const NodeBound& firstBound,
                             const NodeBound& secondBound) {
  const auto nodes = tree.tree.nodes();
  const bool distant = tree.lightClass == LightClass::directional;
  const double power =
      share(double{luminance(tree.power[first])}, double{luminance(tree.power[second])});
  const Weights a = weightsOf(nodes[first], receiver, firstBound.upper, distant);
  const Weights b = weightsOf(nodes[second], receiver, secondBound.upper, distant);
  if (!(a.far + b.far > 0)) return power;
  const double far = share(a.far, b.far);
  const double bounds = a.near < 0 || b.near < 0 ? far : 0.5 * (far + share(a.near, b.near));
  return kPowerShare * power + (1 - kPowerShare) * bounds;
}

void CutDescent::step(const LightForest::Tree& tree, const ReceiverNodes& receiver,
                      std::span<const NodeBound> bounds, Walker* walker) const {
  const uint32_t left = tree.tree.left(walker->node), right = tree.tree.right(walker->node);
  const double p = firstChildProbability(tree, left, right, receiver, bounds[0], bounds[1]);
  if (walker->u < p) {
    walker->u /= p;
    walker->probability *= p;
    walker->node = left;
  } else {
    walker->u = (walker->u - p) / (1 - p);
    walker->probability *= 1 - p;
    walker->node = right;
  }
  walker->u = std::min(walker->u, 0x1.fffffffffffffp-1);
}

void CutDescent::run(const ReceiverNodes& receiver, uint32_t t, NodeBounder* bounder,
                     std::span<Walker> walkers) {
  const LightForest::Tree& tree = forest_.trees[t];
  const auto leaf = [&](const Walker* w) { return tree.tree.nodes()[w->node].leaf(); };
  walking_.clear();
  for (Walker& walker : walkers) walking_.push_back(&walker);
  while (true) {
    walking_.erase(std::remove_if(walking_.begin(), walking_.end(), leaf), walking_.end());
    if (walking_.empty()) return;
    nodes_.clear();
    for (const Walker* walker : walking_) {
      nodes_.push_back(tree.tree.left(walker->node));
      nodes_.push_back(tree.tree.right(walker->node));
    }
    bounds_.resize(nodes_.size());
    bounder->bound(receiver, t, nodes_, bounds_.data());
    for (size_t i = 0; i < walking_.size(); ++i)
      step(tree, receiver, std::span(bounds_).subspan(2 * i, 2), walking_[i]);
  }
}

}  // namespace lobelia::gather
