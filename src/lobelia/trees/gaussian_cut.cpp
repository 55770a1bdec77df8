#include "lobelia/trees/gaussian_cut.h"

#include <algorithm>
#include <queue>

#include "lobelia/base/parallel.h"
#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/trees/light_tree.h"

namespace lobelia::trees {
namespace {

// Squared, what directions that differ by 1 count against the size of the scene.
constexpr float kDirectionWeight = 0.0025f;
// A cluster is a part of what its parent spreads over; an even split leaves about half.
constexpr float kShareOfParent = 0.25f;

TreeLight treeLightOf(const LightPoint& point) {
  TreeLight light;
  light.p = point.p;
  light.n = point.n;
  light.diffuse = luminance(point.diffuse) * kInvPi;
  light.axis = point.axis;
  light.sharpness = point.sharpness;
  light.glossy = luminance(point.glossy);
  return light;
}

class Cut {
 public:
  Cut(const LightTree& tree, float scale) : tree_(tree), inverseScale2_(1 / sqr(scale)) {}

  // Nodes of the cut with the variances of their parents, in the order of the leaves.
  struct Node {
    uint32_t index;
    float parentVariance;
  };
  std::vector<Node> grow(size_t count) const {
    struct Entry {
      float spread;
      Node node;
      bool operator<(const Entry& o) const {
        return spread != o.spread ? spread < o.spread : node.index > o.node.index;
      }
    };
    std::priority_queue<Entry> open;
    std::vector<Node> done;
    const auto add = [&](uint32_t index, float parentVariance) {
      if (tree_.nodes()[index].leaf()) {
        done.push_back({index, parentVariance});
      } else {
        open.push({spread(tree_.nodes()[index]), {index, parentVariance}});
      }
    };
    add(0, 0);
    while (!open.empty() && open.size() + done.size() < count) {
      const uint32_t i = open.top().node.index;
      open.pop();
      add(tree_.left(i), tree_.nodes()[i].variance);
      add(tree_.right(i), tree_.nodes()[i].variance);
    }
    for (; !open.empty(); open.pop()) done.push_back(open.top().node);
    std::sort(done.begin(), done.end(),
              [](const Node& a, const Node& b) { return a.index < b.index; });
    return done;
  }

 private:
  float spread(const LightNode& node) const {
    const float diffuse = kPi * node.diffuse;
    const float mean = lobes::meanResultant(node.sharpness);
    const float directions =
        diffuse * (1 - std::min(1.f, lengthSquared(node.n))) + node.glossy * (1 - mean * mean);
    return (diffuse + node.glossy) * node.variance * inverseScale2_ + kDirectionWeight * directions;
  }

  const LightTree& tree_;
  const float inverseScale2_;
};

// Leaves below a node are neighbours in preorder.
void takeLeaves(const LightTree& tree, uint32_t node, std::vector<uint32_t>* out) {
  uint32_t left = tree.nodes()[node].count;
  for (uint32_t i = node; left > 0; ++i) {
    if (!tree.nodes()[i].leaf()) continue;
    out->push_back(tree.light(tree.nodes()[i].link));
    --left;
  }
}

}  // namespace

CutClusters cutClusters(std::span<const LightPoint> points, size_t count, float scale) {
  CutClusters out;
  std::vector<TreeLight> lights;
  std::vector<uint32_t> numbers;
  for (uint32_t i = 0; i < points.size(); ++i) {
    if (!(points[i].power() > 0)) continue;
    lights.push_back(treeLightOf(points[i]));
    numbers.push_back(i);
  }
  if (lights.empty() || count == 0) return out;
  const LightTree tree(lights, numbers, scale);
  for (const Cut::Node& node : Cut(tree, scale).grow(count)) {
    takeLeaves(tree, node.index, &out.clusters.order);
    out.clusters.ends.push_back(static_cast<uint32_t>(out.clusters.order.size()));
    out.leastVariance.push_back(kShareOfParent * node.parentVariance);
  }
  return out;
}

std::vector<GaussianLight> cutLights(std::span<const LightPoint> points, size_t count, float scale,
                                     bool toksvig, uint64_t seed) {
  const CutClusters cut = cutClusters(points, count, scale);
  std::vector<GaussianLight> lights = clusterLights(points, cut.clusters, toksvig, seed);
  parallelFor(lights.size(), 256, [&](size_t i) { widen(cut.leastVariance[i], &lights[i]); });
  return lights;
}

}  // namespace lobelia::trees
