#include "lobelia/trees/light_tree.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::trees {
namespace {

// A difference of directions of 1 counts as much as this share of the scene's size.
constexpr float kDirectionShare = 0.05f;
constexpr int kExtents = 6;

float diffusePower(float intensity) { return kPi * intensity; }
float power(const LightNode& node) { return diffusePower(node.diffuse) + node.glossy; }

LightNode leafOf(const TreeLight& light, uint32_t place) {
  LightNode node;
  node.centre = light.p;
  node.variance = light.variance;
  node.radius = light.radius;
  node.n = light.n;
  node.diffuse = light.diffuse;
  node.axis = light.axis;
  node.sharpness = light.sharpness;
  node.glossy = light.glossy;
  node.link = place;
  node.count = 1;
  return node;
}

LightNode merged(const LightNode& a, const LightNode& b) {
  LightNode node;
  node.count = a.count + b.count;
  const float total = power(a) + power(b);
  // Without power all places count alike.
  const float share = total > 0 ? power(b) / total : 0.5f;
  const Vec3f apart = b.centre - a.centre;
  node.centre = a.centre + apart * share;
  node.variance =
      a.variance + share * (b.variance - a.variance) + share * (1 - share) * dot(apart, apart);
  node.radius = std::max(length(node.centre - a.centre) + a.radius,
                         length(node.centre - b.centre) + b.radius) *
                1.000001f;
  node.n = a.n + share * (b.n - a.n);
  node.diffuse = a.diffuse + b.diffuse;
  node.glossy = a.glossy + b.glossy;
  lobes::Moment moment = lobes::momentOf(a.axis, a.sharpness, a.glossy);
  moment.add(lobes::momentOf(b.axis, b.sharpness, b.glossy));
  if (moment.weight > 0) {
    const lobes::SphericalGaussian lobe = lobes::lobeOf(moment);
    node.axis = lobe.axis;
    node.sharpness = lobe.sharpness;
  }
  return node;
}

// Splits a run of lights in two.
class Splitter {
 public:
  // What a light is split by: its place over the size of the scene, its direction, and its share of
  // the power.
  struct Item {
    float x[kExtents];
    float weight;
    uint32_t light;
  };
  static Item itemOf(const TreeLight& light, uint32_t number, float inverseScale) {
    Item item;
    const Vec3f direction = light.mostlyGlossy() ? light.axis : light.n;
    for (int d = 0; d < 3; ++d) {
      item.x[d] = light.p[d] * inverseScale;
      item.x[d + 3] = kDirectionShare * direction[d];
    }
    item.weight = diffusePower(light.diffuse) + light.glossy;
    item.light = number;
    return item;
  }

  // Sorts the items, two at least, into a left and a right part and returns the size of the left.
  static size_t split(std::span<Item> items, bool halves) {
    const Extents extents = extentsOf(items);
    const int dim = extents.widest();
    const size_t half = items.size() / 2;
    const auto cutInHalves = [&] {
      std::nth_element(items.begin(), items.begin() + static_cast<ptrdiff_t>(half), items.end(),
                       [dim](const Item& a, const Item& b) { return a.x[dim] < b.x[dim]; });
      return half;
    };
    const float perUnit = Bins::kCount / (extents.hi[dim] - extents.lo[dim]);
    if (halves || !(perUnit < 3.4e38f)) return cutInHalves();
    const Bins bins(items, dim, extents.lo[dim], perUnit);
    const int border = bins.border();
    const auto middle = std::partition(items.begin(), items.end(),
                                       [&](const Item& item) { return bins.of(item) < border; });
    const size_t left = static_cast<size_t>(middle - items.begin());
    return left == 0 || left == items.size() ? cutInHalves() : left;
  }

 private:
  struct Extents {
    float lo[kExtents], hi[kExtents];
    double variance[kExtents];
    // The dimension of the largest variance; of those alike, of the largest extent.
    int widest() const {
      int best = 0;
      for (int d = 1; d < kExtents; ++d) {
        const bool more = variance[d] > variance[best] ||
                          (variance[d] == variance[best] && hi[d] - lo[d] > hi[best] - lo[best]);
        if (hi[d] > lo[d] && (more || !(hi[best] > lo[best]))) best = d;
      }
      return best;
    }
  };
  static Extents extentsOf(std::span<const Item> items) {
    Extents extents;
    double weight = 0, first[kExtents] = {}, second[kExtents] = {};
    std::fill_n(extents.lo, kExtents, 3.4e38f);
    std::fill_n(extents.hi, kExtents, -3.4e38f);
    const float* origin = items[0].x;
    for (const Item& item : items) {
      weight += double{item.weight};
      for (int d = 0; d < kExtents; ++d) {
        extents.lo[d] = std::min(extents.lo[d], item.x[d]);
        extents.hi[d] = std::max(extents.hi[d], item.x[d]);
        const float x = item.x[d] - origin[d], moment = item.weight * x;
        first[d] += double{moment}, second[d] += double{moment * x};
      }
    }
    for (int d = 0; d < kExtents; ++d)
      extents.variance[d] = weight > 0 ? second[d] - first[d] * first[d] / weight : 0;
    return extents;
  }

  // Along one dimension.
  class Bins {
   public:
    static constexpr int kCount = 32;
    Bins(std::span<const Item> items, int dim, float lo, float perUnit)
        : dim_(dim), lo_(lo), perUnit_(perUnit) {
      for (const Item& item : items) {
        Bin& bin = bins_[of(item)];
        const double x = double{item.x[dim]} - double{lo}, w = double{item.weight};
        ++bin.count, bin.weight += w, bin.first += w * x;
      }
    }
    int of(const Item& item) const {
      return std::clamp(static_cast<int>((item.x[dim_] - lo_) * perUnit_), 0, kCount - 1);
    }
    // The first bin of the right part: where the means of both parts, by weight, differ most.
    int border() const {
      Bin all;
      for (const Bin& bin : bins_) all.add(bin);
      Bin left;
      int best = kCount / 2;
      double most = -1;
      for (int i = 1; i < kCount; ++i) {
        left.add(bins_[i - 1]);
        if (left.count == 0 || left.count == all.count) continue;
        const double right = all.weight - left.weight;
        double apart = 0;
        if (left.weight > 0 && right > 0) {
          const double difference = left.first / left.weight - (all.first - left.first) / right;
          apart = left.weight * right * difference * difference;
        }
        if (apart > most) best = i, most = apart;
      }
      return best;
    }

   private:
    struct Bin {
      size_t count = 0;
      double weight = 0, first = 0;
      void add(const Bin& bin) { count += bin.count, weight += bin.weight, first += bin.first; }
    };
    const int dim_;
    const float lo_, perUnit_;
    Bin bins_[kCount];
  };
};

class Builder {
 public:
  using Item = Splitter::Item;

  Builder(const std::vector<TreeLight>& lights, float scale, LargePageVector<LightNode>* nodes)
      : lights_(lights), nodes_(*nodes), items_(lights.size()) {
    const float inverseScale = 1 / std::max(scale, 1e-30f);
    parallelFor(items_.size(), 4096, [&](size_t i) {
      items_[i] = Splitter::itemOf(lights[i], static_cast<uint32_t>(i), inverseScale);
    });
  }

  // Level by level down, then up again.
  void run() {
    nodes_.resize(2 * lights_.size() - 1);
    std::vector<std::vector<Range>> levels{{{0, 0, static_cast<uint32_t>(lights_.size()), 0}}};
    while (!levels.back().empty()) {
      std::vector<Range>& level = levels.back();
      const bool halves = levels.size() > kLevelsByVariance;
      parallelFor(level.size(), level.size() > 64 ? 16 : 1, [&](size_t i) {
        Range& range = level[i];
        if (range.count == 1) return;
        const std::span<Item> items(items_.data() + range.first, range.count);
        range.left = static_cast<uint32_t>(Splitter::split(items, halves));
      });
      std::vector<Range> next;
      for (const Range& range : level) {
        if (range.count == 1) continue;
        next.push_back({range.node + 1, range.first, range.left, 0});
        next.push_back({range.right(), range.first + range.left, range.count - range.left, 0});
      }
      levels.push_back(std::move(next));
    }
    for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
      parallelFor(level->size(), 256, [&](size_t i) {
        const Range& range = (*level)[i];
        LightNode& node = nodes_[range.node];
        if (range.count == 1) {
          node = leafOf(lights_[lightAt(range.first)], range.first);
        } else {
          node = merged(nodes_[range.node + 1], nodes_[range.right()]);
          node.link = range.right();
        }
      });
    }
  }
  // After run().
  uint32_t lightAt(size_t place) const { return items_[place].light; }

 private:
  // Below, nodes are cut in halves: trees are never deep.
  static constexpr size_t kLevelsByVariance = 48;
  struct Range {
    uint32_t node, first, count, left;
    uint32_t right() const { return node + 2 * left; }
  };

  const std::vector<TreeLight>& lights_;
  LargePageVector<LightNode>& nodes_;
  std::vector<Item> items_;
};

}  // namespace

LightTree::LightTree(const std::vector<TreeLight>& lights, const std::vector<uint32_t>& numbers,
                     float scale) {
  if (lights.empty()) return;
  Builder builder(lights, scale, &nodes_);
  builder.run();
  lights_.resize(lights.size());
  for (size_t i = 0; i < lights.size(); ++i) lights_[i] = numbers[builder.lightAt(i)];
}

}  // namespace lobelia::trees
