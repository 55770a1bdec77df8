#include "lobelia/path/emitter_tree.h"

#include <array>
#include <bit>

#include "lobelia/base/parallel.h"

namespace lobelia {
namespace {

constexpr int kBins = 12;
constexpr int kMaxDepth = 62;          // a path has 63 bits below its leading one
constexpr size_t kSubtreeSize = 4096;  // ranges up to this size are built by one thread
// In large trees ranges this small are halved: looking for the best split of each would take most
// of the time of building.
constexpr size_t kHalved = 8, kLargeTree = 1024;

// Cone of normals with the widest emission around them.
struct Cone {
  Vec3f axis{0, 0, 1};
  float cosO = 1, cosE = 1;
  bool empty = true;
};

float safeAcos(float x) { return std::acos(std::clamp(x, -1.f, 1.f)); }

// [Conty18, algorithm 1]
Cone unite(const Cone& a, const Cone& b) {
  if (a.empty) return b;
  if (b.empty) return a;
  const float cosE = std::min(a.cosE, b.cosE);
  const float thetaA = safeAcos(a.cosO), thetaB = safeAcos(b.cosO);
  const Cone& wide = thetaA >= thetaB ? a : b;
  const Cone& narrow = thetaA >= thetaB ? b : a;
  const float thetaWide = std::max(thetaA, thetaB), thetaNarrow = std::min(thetaA, thetaB);
  const float between = safeAcos(dot(a.axis, b.axis));
  if (std::min(between + thetaNarrow, kPi) <= thetaWide) {
    return {wide.axis, wide.cosO, cosE, false};
  }
  const float theta = 0.5f * (thetaWide + between + thetaNarrow);
  const Vec3f turn = cross(wide.axis, narrow.axis);
  const float turnLength = length(turn);
  if (theta >= kPi || turnLength < 1e-9f) return {wide.axis, -1, cosE, false};
  // Turns the wide axis towards the narrow one.
  const float angle = theta - thetaWide;
  const Vec3f side = cross(turn / turnLength, wide.axis);
  return {normalize(wide.axis * std::cos(angle) + side * std::sin(angle)), std::cos(theta), cosE,
          false};
}

// Measure of the cone in the split cost [Conty18, eq. 1].
float orientationMeasure(const Cone& cone) {
  const float thetaO = safeAcos(cone.cosO);
  const float thetaW = std::min(thetaO + safeAcos(cone.cosE), kPi);
  const float sinO = std::sin(thetaO);
  return kTwoPi * (1 - cone.cosO) +
         0.5f * kPi *
             (2 * thetaW * sinO - std::cos(thetaO - 2 * thetaW) - 2 * thetaO * sinO + cone.cosO);
}

struct Cluster {
  Bounds3f bounds;
  Cone cone;
  float intensity = 0;
  size_t count = 0;
  void add(const TreeLight& light) {
    bounds.add(light.bounds);
    cone = unite(cone, {light.axis, light.cosThetaO, light.cosThetaE, false});
    intensity += light.intensity;
    ++count;
  }
  void add(const Cluster& other) {
    bounds.add(other.bounds);
    cone = unite(cone, other.cone);
    intensity += other.intensity;
    count += other.count;
  }
  // [Conty18, eq. 2]; the diagonal keeps flat and linear clusters from costing nothing.
  float cost() const {
    if (count == 0) return 0;
    const Vec3f e = bounds.extent();
    const float area = e.x * e.y + e.y * e.z + e.z * e.x + 1e-3f * dot(e, e);
    return intensity * area * orientationMeasure(cone);
  }
};

// A node of the binary tree that is built first.
struct Branch {
  Vec3f centre, axis;
  float radius, cosThetaO, cosThetaE, intensity;
  uint32_t next;  // inner: index of the left child, which the right one follows; leaf: light
  bool isLeaf() const { return (next & EmitterTreeNode::kLeafBit) != 0; }
};

int16_t quantiseAxis(float x) {
  return static_cast<int16_t>(std::lround(std::clamp(x, -1.f, 1.f) * 32767.f));
}
int8_t quantiseCosine(float x) {
  return static_cast<int8_t>(std::floor(std::clamp(x, -1.f, 1.f) * 127.f));
}
float axisOf(int16_t x) { return static_cast<float>(x) * (1 / 32767.f); }
float cosineOf(int8_t x) { return static_cast<float>(x) * (1 / 127.f); }

void setCluster(const Branch& from, int slot, EmitterTreeNode& to) {
  to.x[slot] = from.centre.x, to.y[slot] = from.centre.y, to.z[slot] = from.centre.z;
  to.radius[slot] = from.radius;
  to.intensity[slot] = from.intensity;
  to.axisX[slot] = quantiseAxis(from.axis.x), to.axisY[slot] = quantiseAxis(from.axis.y);
  to.axisZ[slot] = quantiseAxis(from.axis.z);
  to.cosThetaO[slot] = quantiseCosine(from.cosThetaO);
  to.cosThetaE[slot] = quantiseCosine(from.cosThetaE);
  to.next[slot] = from.next;
}

// Three levels at a time; a leaf above the third level takes the first of the places below it.
std::vector<EmitterTreeNode> widen(const std::vector<Branch>& branches) {
  std::vector<EmitterTreeNode> nodes;
  std::vector<uint32_t> roots{0};  // of the nodes, in their order
  for (size_t i = 0; i < roots.size() && !branches.empty(); ++i) {
    EmitterTreeNode node{};
    const auto place = [&](const auto& self, uint32_t branch, int level, int slot) -> void {
      const Branch& from = branches[branch];
      if (!from.isLeaf() && level < EmitterTreeNode::kBits) {
        self(self, from.next, level + 1, slot << 1);
        self(self, from.next + 1, level + 1, slot << 1 | 1);
        return;
      }
      slot <<= EmitterTreeNode::kBits - level;
      setCluster(from, slot, node);
      if (from.isLeaf()) return;
      node.next[slot] = static_cast<uint32_t>(roots.size());
      roots.push_back(branch);
    };
    place(place, roots[i], 0, 0);
    nodes.push_back(node);
  }
  return nodes;
}

// From a bit per level to kBits per node; kAbsent stays.
constexpr uint64_t kAbsent = ~0ull;
uint64_t slotsOf(uint64_t path) {
  if (path == kAbsent) return kAbsent;
  const int levels = static_cast<int>(std::bit_width(path)) - 1;
  const int steps = std::max(1, (levels + EmitterTreeNode::kBits - 1) / EmitterTreeNode::kBits);
  return path << (steps * EmitterTreeNode::kBits - levels);
}

// cos(max(0, a - b)) and sin(max(0, a - b)) for angles in [0, pi].
struct Angle {
  float cosine, sine;
};
Angle minus(Angle a, Angle b) {
  if (a.cosine >= b.cosine) return {1, 0};
  return {a.cosine * b.cosine + a.sine * b.sine, a.sine * b.cosine - a.cosine * b.sine};
}
Angle fromCosine(float c) { return {c, std::sqrt(std::max(0.f, 1 - c * c))}; }

int bitsFor(size_t count) { return static_cast<int>(std::bit_width(count == 0 ? 0 : count - 1)); }

}  // namespace

struct EmitterTree::Builder {
  std::span<const TreeLight> lights;
  std::vector<Branch>& nodes;
  std::vector<uint64_t>& paths;  // per light: below a leading one, a bit per level (1: right)
  std::vector<uint32_t> order;

  // A range of `order` that becomes the subtree at nodes[node]; the nodes below it start at
  // `below`.
  struct Task {
    size_t begin, end, node, below;
    uint64_t path;
    int depth;
  };

  Vec3f centre(uint32_t light) const { return lights[light].bounds.centre(); }

  // Position in `order` that divides the range in two non-empty parts.
  size_t split(const Task& task) {
    const auto first = order.begin() + static_cast<ptrdiff_t>(task.begin);
    const auto last = order.begin() + static_cast<ptrdiff_t>(task.end);
    const size_t count = task.end - task.begin, half = task.begin + count / 2;
    Bounds3f centres;
    for (auto i = first; i != last; ++i) centres.add(centre(*i));
    const Vec3f extent = centres.extent();
    const float longest = maxComponent(extent);
    if (!(longest > 0)) return half;
    int bestAxis = -1, bestBin = 0;
    float bestCost = 0;
    const bool halved = count <= kHalved && order.size() > kLargeTree;
    for (int axis = 0; axis < 3 && !halved; ++axis) {
      if (!(extent[axis] > 0)) continue;
      std::array<Cluster, kBins> bins;
      for (auto i = first; i != last; ++i) {
        bins[static_cast<size_t>(binOf(*i, axis, centres))].add(lights[*i]);
      }
      std::array<Cluster, kBins> right;  // right[b]: bins b and above
      Cluster sum;
      for (size_t b = kBins; b-- > 0;) sum.add(bins[b]), right[b] = sum;
      Cluster left;
      for (size_t b = 0; b + 1 < kBins; ++b) {
        left.add(bins[b]);
        if (left.count == 0 || right[b + 1].count == 0) continue;
        const float cost = (left.cost() + right[b + 1].cost()) * longest / extent[axis];
        if (bestAxis < 0 || cost < bestCost) {
          bestAxis = axis, bestBin = static_cast<int>(b), bestCost = cost;
        }
      }
    }
    // Deep trees would not fit the path's bits: halve from there on.
    const bool deep = task.depth + 2 + bitsFor(count) >= kMaxDepth;
    if (bestAxis >= 0 && !deep) {
      const auto middle = std::partition(
          first, last, [&](uint32_t light) { return binOf(light, bestAxis, centres) <= bestBin; });
      const size_t at = task.begin + static_cast<size_t>(middle - first);
      if (at > task.begin && at < task.end) return at;
    }
    const int axis = extent.x == longest ? 0 : extent.y == longest ? 1 : 2;
    std::nth_element(first, order.begin() + static_cast<ptrdiff_t>(half), last,
                     [&](uint32_t a, uint32_t b) {
                       const float ca = centre(a)[axis], cb = centre(b)[axis];
                       return ca < cb || (ca == cb && a < b);
                     });
    return half;
  }

  int binOf(uint32_t light, int axis, const Bounds3f& centres) const {
    const float x =
        (centre(light)[axis] - centres.lo[axis]) / (centres.hi[axis] - centres.lo[axis]);
    return std::clamp(static_cast<int>(x * kBins), 0, kBins - 1);
  }

  void store(const Cluster& cluster, uint32_t next, size_t node) {
    nodes[node] = {cluster.bounds.centre(),
                   cluster.cone.axis,
                   0.5f * length(cluster.bounds.extent()),
                   cluster.cone.cosO,
                   cluster.cone.cosE,
                   cluster.intensity,
                   next};
  }

  // Divides a range; m lights take 2m - 2 nodes below their root, so that places are known before.
  std::array<Task, 2> divide(const Task& t) {
    const size_t middle = split(t);
    const size_t left = t.below + 2, right = t.below + 2 * (middle - t.begin);
    return {Task{t.begin, middle, t.below, left, t.path << 1, t.depth + 1},
            Task{middle, t.end, t.below + 1, right, (t.path << 1) | 1, t.depth + 1}};
  }

  Cluster build(const Task& t) {
    Cluster cluster;
    if (t.end - t.begin == 1) {
      const uint32_t light = order[t.begin];
      cluster.add(lights[light]);
      paths[light] = t.path;
      store(cluster, light | EmitterTreeNode::kLeafBit, t.node);
      return cluster;
    }
    const auto [left, right] = divide(t);
    cluster = build(left);
    cluster.add(build(right));
    store(cluster, static_cast<uint32_t>(left.node), t.node);
    return cluster;
  }

  // Upper levels one after another, the subtrees below them in parallel, then the upper nodes.
  void buildAll() {
    if (order.empty()) return;
    std::vector<Task> tasks{{0, order.size(), 0, 1, 1, 0}};
    for (size_t i = 0; i < tasks.size(); ++i) {
      if (tasks[i].end - tasks[i].begin <= kSubtreeSize) continue;
      const auto children = divide(tasks[i]);
      tasks.push_back(children[0]);
      tasks.push_back(children[1]);
    }
    std::vector<Cluster> clusters(tasks.size());
    parallelFor(tasks.size(), 1, [&](size_t i) {
      if (tasks[i].end - tasks[i].begin <= kSubtreeSize) clusters[i] = build(tasks[i]);
    });
    // Children come after their parents, in pairs in the order of the parents.
    size_t child = tasks.size();
    for (size_t i = tasks.size(); i-- > 0;) {
      if (tasks[i].end - tasks[i].begin <= kSubtreeSize) continue;
      child -= 2;
      clusters[i] = clusters[child];
      clusters[i].add(clusters[child + 1]);
      store(clusters[i], static_cast<uint32_t>(tasks[child].node), tasks[i].node);
    }
  }
};

EmitterTree::EmitterTree(std::span<const TreeLight> lights) {
  slots_.assign(lights.size(), kAbsent);
  std::vector<Branch> branches;
  Builder builder{lights, branches, slots_, {}};
  for (size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].intensity > 0) builder.order.push_back(static_cast<uint32_t>(i));
  }
  if (!builder.order.empty()) branches.resize(2 * builder.order.size() - 1);
  builder.buildAll();
  nodes_ = widen(branches);
  for (uint64_t& path : slots_) path = slotsOf(path);
}

std::optional<EmitterTree::Choice> EmitterTree::sample(Vec3f p, Vec3f n, double u) const {
  if (nodes_.empty()) return std::nullopt;
  const EmitterTreeChoice choice = sampleEmitterTree(nodes_.data(), p, n, u);
  if (!(choice.probability > 0)) return std::nullopt;
  return Choice{choice.light, choice.probability};
}

float EmitterTree::probability(Vec3f p, Vec3f n, uint32_t light) const {
  if (slots_[light] == kAbsent) return 0;
  return emitterTreeProbability(nodes_.data(), p, n, slots_[light]);
}

namespace {

// [Conty18, section 5]: intensity times the largest cosines that the box allows, over the squared
// distance, which is not let below the box's radius: inside a cluster nothing is known of where
// its emitters are. What the kernels compute for eight clusters at once, step by step.
float importance(const EmitterTreeNode& node, int slot, Vec3f p, Vec3f n) {
  const Vec3f toCentre = Vec3f{node.x[slot], node.y[slot], node.z[slot]} - p;
  const float d2 = lengthSquared(toCentre), radius = node.radius[slot], radius2 = radius * radius;
  const float inverse2 = 1 / std::max({d2, radius2, 1e-30f}), inverse = std::sqrt(inverse2);
  if (d2 <= radius2) return node.intensity[slot] * inverse2;
  const float sinBox = std::min(radius * inverse, 1.f);
  const Angle box{fromCosine(sinBox).sine, sinBox};
  float result = 1;
  if (node.cosThetaO[slot] > -127) {
    const Vec3f axis{axisOf(node.axisX[slot]), axisOf(node.axisY[slot]), axisOf(node.axisZ[slot])};
    const Angle cone = fromCosine(cosineOf(node.cosThetaO[slot]));
    const Angle leaving = minus(minus(fromCosine(-(dot(axis, toCentre) * inverse)), cone), box);
    if (leaving.cosine <= cosineOf(node.cosThetaE[slot]) - kLeastCosine) return 0;
    result = std::max(leaving.cosine, kLeastCosine);
  }
  if (n != Vec3f{})
    result *= std::max(0.f, minus(fromCosine(dot(n, toCentre) * inverse), box).cosine);
  return node.intensity[slot] * inverse2 * result;
}

}  // namespace

std::vector<float> EmitterTree::probabilities(Vec3f p, Vec3f n) const {
  std::vector<float> result(slots_.size(), 0.f);
  struct Entry {
    uint32_t node;
    double probability;
  };
  std::vector<Entry> stack;
  if (!nodes_.empty()) stack.push_back({0, 1});
  while (!stack.empty()) {
    const Entry entry = stack.back();
    stack.pop_back();
    const EmitterTreeNode& node = nodes_[entry.node];
    double weights[EmitterTreeNode::kWidth], sum = 0;
    for (int i = 0; i < EmitterTreeNode::kWidth; ++i)
      sum += weights[i] = static_cast<double>(importance(node, i, p, n));
    for (int i = 0; i < EmitterTreeNode::kWidth; ++i) {
      if (!(weights[i] > 0)) continue;
      const double probability = entry.probability * (weights[i] / sum);
      if (node.next[i] & EmitterTreeNode::kLeafBit)
        result[node.next[i] & ~EmitterTreeNode::kLeafBit] = static_cast<float>(probability);
      else
        stack.push_back({node.next[i], probability});
    }
  }
  return result;
}

size_t EmitterTree::bytes() const {
  return nodes_.size() * sizeof(EmitterTreeNode) + slots_.size() * sizeof(uint64_t);
}

}  // namespace lobelia
