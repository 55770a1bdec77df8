#include "lobelia/gather/illumination_tile.h"

#include <algorithm>

#include "lobelia/base/random.h"
#include "lobelia/gather/light_range.h"

namespace lobelia::gather {
namespace {

constexpr size_t kBatch = 2048;     // pairs bounded side by side
constexpr size_t kAccepted = 8192;  // shaded at once, at least
constexpr float kApart = 0.5f;      // largest diameter over distance in the coarse picture

Tile tileOf(const IlluminationScene& scene, const WholeReceivers::Tree& tree, uint32_t node) {
  const trees::BoundNode& n = tree.tree.nodes()[node];
  const size_t begin = tree.first + n.first;
  Tile tile = makeTile(scene.receivers, begin, begin + n.count);
  if (!scene.lights.spherical.empty()) addSampling(scene.receivers, &tile);
  return tile;
}

}  // namespace

IlluminationTile::IlluminationTile(const IlluminationScene& scene, const WholeReceivers::Tree& tree,
                                   uint32_t node, GatherParts* parts, GatherTally* tally,
                                   const Context& context)
    : scene_(scene),
      tree_(tree),
      node_(node),
      parts_(parts),
      tally_(*tally),
      context_(context),
      tile_(tileOf(scene, tree, node)) {
  sums_.strips.resize(tile_.strips.size());
}

// The published rule, by radii of places; directional lights have none.
bool IlluminationTile::refinesLights(const TreePair& pair, const LightForest::Tree& lights) const {
  const trees::BoundNode& p = node(pair.receivers);
  const trees::BoundNode& q = lights.tree.nodes()[pair.lights];
  if (p.leaf() || q.leaf()) return p.leaf();
  if (lights.lightClass == LightClass::directional)
    return lightsExtendFurther(p, p.energy > 0, q, lights.lightClass);
  return q.radius > p.radius;
}

void IlluminationTile::refine(const TreePair& pair, const LightForest::Tree& lights) {
  splitPair(tree_.tree, lights, pair, refinesLights(pair, lights), &active_);
}

// Upper bounds of the batch.
void IlluminationTile::bound(const LightForest::Tree& lights) {
  bounded_.clear();
  for (const TreePair& pair : batch_)
    bounded_.push_back({&node(pair.receivers), &lights.tree.nodes()[pair.lights]});
  uppers_.resize(batch_.size());
  bounder_.bound(bounded_, lights.lightClass, tree_.glossy, uppers_.data());
  tally_.evaluations += batch_.size();
  if (!(scene_.settings.clamp > 0) || !clampBounds(lights.lightClass)) return;
  const float clamp = scene_.settings.clamp * tree_.mostWeight;
  for (size_t i = 0; i < batch_.size(); ++i) {
    const trees::BoundNode& q = *bounded_[i].lights;
    // Of glossy lights, whose cosine lobe is 0, the sum of intensities.
    uppers_[i] = std::min(uppers_[i], clamp * (q.cosine + q.peak));
  }
}

// Pairs of the tile with a light tree: judge() puts those of the batch that are good into
// accepted_ and refines others; accept() takes the good ones, some thousands at once.
template <class Judge, class Accept>
void IlluminationTile::traverse(uint32_t t, const Judge& judge, const Accept& accept) {
  active_.assign(1, {node_, 0});
  accepted_.clear();
  while (!active_.empty() && !context_.cancelled()) {
    const size_t count = std::min(active_.size(), kBatch);
    batch_.assign(active_.end() - static_cast<ptrdiff_t>(count), active_.end());
    active_.resize(active_.size() - count);
    judge(scene_.forest.trees[t]);
    if (accepted_.size() < kAccepted && !active_.empty()) continue;
    forBlocks(t, &accepted_, accept);
    accepted_.clear();
  }
}

// Sorts the pairs; f(block): of up to kBlockLights nodes of lights with all of their pairs, their
// lights prepared.
template <class F>
void IlluminationTile::forBlocks(uint32_t t, std::vector<Accepted>* pairs, const F& f) {
  std::sort(pairs->begin(), pairs->end(), [](const Accepted& a, const Accepted& b) {
    return a.lights != b.lights ? a.lights < b.lights : a.receivers < b.receivers;
  });
  Block block;
  for (size_t begin = 0, end = 0; begin < pairs->size(); begin = end) {
    block.nodes.clear();
    for (; end < pairs->size(); ++end) {
      const uint32_t lights = (*pairs)[end].lights;
      if (!block.nodes.empty() && block.nodes.back() == lights) continue;
      if (block.nodes.size() == kBlockLights) break;
      block.nodes.push_back(lights);
    }
    block.pairs = std::span(*pairs).subspan(begin, end - begin);
    uint32_t indices[kBlockLights];
    for (size_t i = 0; i < block.nodes.size(); ++i)
      indices[i] = scene_.representatives.light(t, block.nodes[i]);
    prepareChosen(scene_.lights, scene_.tracer.scene(), scene_.forest.trees[t].lightClass,
                  {indices, block.nodes.size()}, &block_, scene_.prepared);
    for (size_t i = 0; i < block.nodes.size(); ++i)
      block_.lights[i].intensity *= scene_.representatives.scale(t, block.nodes[i]);
    allowPairs(tile_, block_, scene_.lights, scene_.settings, &allowed_);
    f(block);
  }
}

bool IlluminationTile::goodForEstimate(const TreePair& pair,
                                       const LightForest::Tree& lights) const {
  const trees::BoundNode& p = node(pair.receivers);
  const trees::BoundNode& q = lights.tree.nodes()[pair.lights];
  if (p.leaf() && q.leaf()) return true;
  if (lights.lightClass == LightClass::directional) {
    const float chord = 2 * static_cast<float>(q.lobeAngle) / trees::kAngleCodes;
    return p.count <= kStrip && 2 * chord < kApart;
  }
  const float apart = length(q.centre - p.centre) - p.radius - q.radius;
  return 2 * std::max(p.radius, q.radius) < kApart * apart;
}

void IlluminationTile::estimate(std::span<double> light, std::span<uint32_t> rays) {
  const int64_t start = nanosecondsNow(), before = tally_.visibilityNs + tally_.shadeNs;
  const trees::BoundNode& tile = node(node_);
  std::vector<double> nodes(2 * size_t{tile.count} - 1);
  for (uint32_t t = 0; t < scene_.forest.trees.size(); ++t) {
    traverse(
        t,
        [&](const LightForest::Tree& lights) {
          for (const TreePair& pair : batch_) {
            if (goodForEstimate(pair, lights)) {
              accepted_.push_back({pair});
            } else {
              refine(pair, lights);
            }
          }
        },
        [&](const Block& block) { addEstimate(block, nodes, rays); });
  }
  // What a node has, all below it have.
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    const trees::BoundNode& n = node(node_ + i);
    if (n.leaf()) {
      light[placeOf(n)] += nodes[i];
      continue;
    }
    nodes[tree_.tree.left(node_ + i) - node_] += nodes[i];
    nodes[tree_.tree.right(node_ + i) - node_] += nodes[i];
  }
  tally_.traverseNs += nanosecondsNow() - start - (tally_.visibilityNs + tally_.shadeNs - before);
}

// One receiver of each pair.
void IlluminationTile::addEstimate(const Block& block, std::span<double> nodes,
                                   std::span<uint32_t> rays) {
  const size_t count = block.nodes.size(), strips = tile_.strips.size();
  pairs_.reset(count, strips);
  std::fill(pairs_.bits.begin(), pairs_.bits.end(), uint16_t{0});
  std::vector<uint16_t> traced(pairs_.bits.size());
  std::vector<uint32_t> places;  // of the pairs' receivers in the tile
  size_t l = 0;
  for (const Accepted& pair : block.pairs) {
    while (block.nodes[l] != pair.lights) ++l;
    const trees::BoundNode& p = node(pair.receivers);
    const uint64_t key = hashCombine(hashCombine(scene_.seed, placeOf(p)),
                                     uint64_t{p.count} << 32 | block_.index[l]);
    places.push_back(inTile(p) + static_cast<uint32_t>((key >> 32) * p.count >> 32));
    pairs_.at(l, places.back() / kStrip) |= static_cast<uint16_t>(1u << places.back() % kStrip);
  }
  for (size_t i = 0; i < pairs_.bits.size(); ++i) pairs_.bits[i] &= allowed_.bits[i];
  pairs_.traced = &traced;
  const int64_t start = nanosecondsNow();
  tally_.rays += keepVisible(tile_, block_, scene_.tracer, &pairs_);
  pairs_.traced = nullptr;
  const int64_t seen = nanosecondsNow();
  values_.reset(count, strips);
  shadePairs(tile_, block_, scene_.settings.clamp, pairs_, &values_);
  const size_t first = tree_.first + node(node_).first;
  l = 0;
  for (size_t i = 0; i < block.pairs.size(); ++i) {
    while (block.nodes[l] != block.pairs[i].lights) ++l;
    const size_t mask = l * strips + places[i] / kStrip, lane = places[i] % kStrip;
    rays[first + places[i]] += traced[mask] >> lane & 1;
    if ((pairs_.bits[mask] >> lane & 1) == 0) continue;
    const size_t at = mask * kStrip + lane;
    const Rgb value = scene_.receivers.points[first + places[i]].weight *
                      Rgb(values_.x[at], values_.y[at], values_.z[at]);
    nodes[block.pairs[i].receivers - node_] += double{luminance(value)};
  }
  tally_.visibilityNs += seen - start;
  tally_.shadeNs += nanosecondsNow() - seen;
}

// Of the tile's nodes, in preorder: the least of their receivers.
std::vector<float> IlluminationTile::leastOf(std::span<const float> thresholds) const {
  std::vector<float> least(2 * size_t{node(node_).count} - 1);
  for (uint32_t i = static_cast<uint32_t>(least.size()); i-- > 0;) {
    const trees::BoundNode& n = node(node_ + i);
    least[i] = n.leaf() ? thresholds[placeOf(n)]
                        : std::min(least[tree_.tree.left(node_ + i) - node_],
                                   least[tree_.tree.right(node_ + i) - node_]);
  }
  return least;
}

void IlluminationTile::gather(std::span<const float> thresholds, std::span<Rgb> radiance) {
  const int64_t start = nanosecondsNow(), before = tally_.visibilityNs + tally_.shadeNs;
  const std::vector<float> least = leastOf(thresholds);
  std::optional<TileParts> parts;
  if (parts_ != nullptr) parts.emplace(scene_.receivers, scene_.lights, tile_, parts_);
  const auto judge = [&](const LightForest::Tree& lights) {
    bound(lights);
    for (size_t i = 0; i < batch_.size(); ++i) {
      const TreePair& pair = batch_[i];
      const trees::BoundNode& q = lights.tree.nodes()[pair.lights];
      const float most = least[pair.receivers - node_];
      // Bounds of spherical lights underflow where their lobes have tails.
      const bool whole = lights.apart || (lights.lightClass == LightClass::spherical && most <= 0);
      if (uppers_[i] <= 0 && !whole) continue;
      const bool strong = uppers_[i] > most || whole;
      if (q.leaf() || !strong) {
        accepted_.push_back({pair, strong});
        const uint64_t receivers = node(pair.receivers).count;
        ++tally_.clusters;
        tally_.clusteredReceivers += receivers, tally_.lights += receivers;
        tally_.clusteredLights += receivers * q.count;
      } else {
        refine(pair, lights);
      }
    }
  };
  for (const LightClass lightClass : kLightClasses) {
    if (parts) parts->beginClass(sums_);
    for (uint32_t t = 0; t < scene_.forest.trees.size(); ++t)
      if (scene_.forest.trees[t].lightClass == lightClass)
        traverse(t, judge, [&](const Block& b) { shadeBlock(b, parts ? &*parts : nullptr); });
    if (parts) parts->endClass(lightClass, sums_);
  }
  if (parts) parts->write();
  write(radiance);
  tally_.traverseNs += nanosecondsNow() - start - (tally_.visibilityNs + tally_.shadeNs - before);
}

// All receivers of the pairs.
void IlluminationTile::shadeBlock(const Block& block, TileParts* parts) {
  const size_t strips = tile_.strips.size();
  pairs_.reset(block.nodes.size(), strips);
  std::fill(pairs_.bits.begin(), pairs_.bits.end(), uint16_t{0});
  lit_.clear();
  uint32_t l = 0;
  for (const Accepted& pair : block.pairs) {
    while (block.nodes[l] != pair.lights) ++l;
    const trees::BoundNode& p = node(pair.receivers);
    for (uint32_t i = inTile(p); i < inTile(p) + p.count; ++i)
      pairs_.at(l, i / kStrip) |= static_cast<uint16_t>(1u << i % kStrip);
    lit_.push_back({l, pair.receivers, pair.strong});
  }
  for (size_t i = 0; i < pairs_.bits.size(); ++i) pairs_.bits[i] &= allowed_.bits[i];
  if (parts != nullptr) parts->watchRays(&pairs_);
  const int64_t start = nanosecondsNow();
  tally_.rays += scene_.sampled
                     ? visibility_.keep(tile_, block_, scene_.tracer, tree_.tree, node(node_).first,
                                        lit_, hashCombine(scene_.seed, block_.index[0]), &pairs_)
                     : keepVisible(tile_, block_, scene_.tracer, &pairs_);
  pairs_.traced = nullptr;
  const int64_t seen = nanosecondsNow();
  shade(tile_, block_, scene_.settings.clamp, pairs_, &sums_);
  if (parts != nullptr) parts->add(block_, scene_.settings.clamp, pairs_);
  tally_.visibilityNs += seen - start;
  tally_.shadeNs += nanosecondsNow() - seen;
}

void IlluminationTile::write(std::span<Rgb> radiance) {
  tally_.pairs += sums_.pairs;
  tally_.nonfinite += sums_.nonfinite;
  for (size_t s = 0; s < tile_.strips.size(); ++s) {
    const TileSums::Strip& sum = sums_.strips[s];
    for (size_t lane = 0; lane < kStrip; ++lane) {
      if (!(tile_.strips[s].active >> lane & 1)) continue;
      const size_t i = tile_.strips[s].point[lane];
      radiance[i] = scene_.receivers.points[i].weight * Rgb(static_cast<float>(sum.x[lane]),
                                                            static_cast<float>(sum.y[lane]),
                                                            static_cast<float>(sum.z[lane]));
      if ((sum.nonfinite >> lane & 1) != 0) tally_.noteBad(scene_.receivers.points[i].pixel);
    }
  }
}

}  // namespace lobelia::gather
