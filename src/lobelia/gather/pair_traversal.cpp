#include "lobelia/gather/pair_traversal.h"

#include <algorithm>

#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::gather {
namespace {

using trees::BoundNode;

constexpr int kFirstLevel = 4;
constexpr size_t kBatch = 2048;     // the paper: 10,000, for a GPU
constexpr size_t kAccepted = 8192;  // given out at once, at least
constexpr float kBeyondBounds = 3.4e38f;

void addLevel(const trees::BoundTree& tree, uint32_t node, int level, std::vector<uint32_t>* out) {
  if (level == 0 || tree.nodes()[node].leaf()) return out->push_back(node);
  addLevel(tree, tree.left(node), level - 1, out);
  addLevel(tree, tree.right(node), level - 1, out);
}

// Chord of the angle over which a node sends or scatters; nodes without normals have none.
float spreadOf(const BoundNode& node, bool gaussian, bool normals) {
  const float halfSine = static_cast<float>(gaussian ? node.lobeAngle : node.normalAngle);
  return gaussian || normals ? halfSine * (2 / trees::kAngleCodes) : 0.f;
}

}  // namespace

bool lightsExtendFurther(const BoundNode& p, bool glossy, const BoundNode& q,
                         LightClass lightClass) {
  const bool gaussian = lightClass != LightClass::omni && lightClass != LightClass::diffuse;
  const float spreadP = spreadOf(p, glossy, true);
  const float spreadQ = spreadOf(q, gaussian && q.energy > 0, lightClass == LightClass::diffuse);
  // Directional lights: places of receivers do not matter to them.
  if (lightClass == LightClass::directional) return spreadQ >= spreadP;
  const float d = length(q.centre - p.centre);
  return q.radius + d * spreadQ >= p.radius + d * spreadP;
}

std::vector<uint32_t> nodesOfLevel(const trees::BoundTree& tree, int level) {
  std::vector<uint32_t> nodes;
  addLevel(tree, 0, level, &nodes);
  return nodes;
}

size_t PairTraversal::run(uint32_t receiverNode, const std::vector<float>& thresholds,
                          const Accept& accept) {
  bounded_ = 0;
  active_.clear();
  std::vector<TreePair> accepted, refined;
  for (const uint32_t q : nodesOfLevel(lights_.tree, kFirstLevel))
    active_.push_back({receiverNode, q});
  while (!active_.empty()) {
    const size_t count = std::min(active_.size(), kBatch);
    batch_.assign(active_.end() - static_cast<ptrdiff_t>(count), active_.end());
    active_.resize(active_.size() - count);
    bound(batch_);
    refined.clear();
    for (size_t i = 0; i < count; ++i) {
      const TreePair& pair = batch_[i];
      const bool leaves =
          receivers_.nodes()[pair.receivers].leaf() && lights_.tree.nodes()[pair.lights].leaf();
      const float error = lights_.apart ? kBeyondBounds : errorOf(bounds_[i]);
      const bool good = leaves || error < thresholds[pair.receivers - receiverNode];
      (good ? accepted : refined).push_back(pair);
    }
    refine(refined);
    if (accepted.size() < kAccepted) continue;
    if (!accept(&accepted)) return bounded_;
    accepted.clear();
  }
  if (!accepted.empty()) accept(&accepted);
  return bounded_;
}

void PairTraversal::bound(const std::vector<TreePair>& pairs) {
  nodes_.clear();
  for (const TreePair& pair : pairs)
    nodes_.push_back({&receivers_.nodes()[pair.receivers], &lights_.tree.nodes()[pair.lights]});
  bounds_.resize(pairs.size());
  boundPairs(nodes_, lights_.lightClass, glossy_, settings_.bounds, bounds_.data());
  bounded_ += pairs.size();
  if (clamp_.clamp > 0 && clampBounds(lights_.lightClass)) clampBounded(pairs);
}

void PairTraversal::clampBounded(const std::vector<TreePair>& pairs) {
  for (size_t i = 0; i < pairs.size(); ++i) {
    const ClampedLight& at = clamp_.receivers[pairs[i].receivers];
    const BoundNode& q = lights_.tree.nodes()[pairs[i].lights];
    const float all = clamp_.clamp * (q.cosine + q.peak);  // one of them is 0
    // What stands for Gaussians has their energy.
    const float one = q.energy > 0 ? clamp_.clamp * q.energy / lobes::integral(q.sharpness) : all;
    PairBounds& b = bounds_[i];
    b.value = std::min(b.value, at.mean * one);
    b.upper = std::min(b.upper, at.most * all);
    b.lower = std::min(b.lower, at.least * all);
  }
}

float PairTraversal::errorOf(const PairBounds& b) const {
  if (settings_.error == TraversalSettings::Error::conservative) return std::max(b.value, b.upper);
  return std::max(b.value - b.lower, b.upper - b.value);
}

bool refinesLights(const trees::BoundTree& receivers, bool glossy, const LightForest::Tree& lights,
                   const TreePair& pair) {
  const BoundNode& p = receivers.nodes()[pair.receivers];
  const BoundNode& q = lights.tree.nodes()[pair.lights];
  if (p.leaf() || q.leaf()) return p.leaf();
  return lightsExtendFurther(p, glossy, q, lights.lightClass);
}

void splitPair(const trees::BoundTree& receivers, const LightForest::Tree& lights,
               const TreePair& pair, bool splitsLights, std::vector<TreePair>* out) {
  if (splitsLights) {
    out->push_back({pair.receivers, lights.tree.left(pair.lights)});
    out->push_back({pair.receivers, lights.tree.right(pair.lights)});
  } else {
    out->push_back({receivers.left(pair.receivers), pair.lights});
    out->push_back({receivers.right(pair.receivers), pair.lights});
  }
}

void PairTraversal::refine(const std::vector<TreePair>& pairs) {
  if (settings_.children == TraversalSettings::ChildRule::paper) return refineByPaper(pairs);
  for (const TreePair& pair : pairs) push(pair, refinesLights(receivers_, glossy_, lights_, pair));
}

// Both ways are tried: the children of either side with the parent on the other.
void PairTraversal::refineByPaper(const std::vector<TreePair>& pairs) {
  children_.clear();
  kept_.clear();
  for (const TreePair& pair : pairs) {
    const bool last = receivers_.nodes()[pair.receivers].leaf();
    if (last || lights_.tree.nodes()[pair.lights].leaf()) {
      push(pair, last);
      continue;
    }
    kept_.push_back(pair);
    children_.push_back({pair.receivers, lights_.tree.left(pair.lights)});
    children_.push_back({pair.receivers, lights_.tree.right(pair.lights)});
    children_.push_back({receivers_.left(pair.receivers), pair.lights});
    children_.push_back({receivers_.right(pair.receivers), pair.lights});
  }
  bound(children_);
  for (size_t i = 0; i < kept_.size(); ++i) {
    const float lights = errorOf(bounds_[4 * i]) + errorOf(bounds_[4 * i + 1]);
    const float receivers = std::max(errorOf(bounds_[4 * i + 2]), errorOf(bounds_[4 * i + 3]));
    push(kept_[i], lights <= receivers);
  }
}

}  // namespace lobelia::gather
