#include "lobelia/gather/pair_shading.h"

#include <algorithm>

#include "lobelia/base/random.h"
#include "lobelia/gather/facing_pairs.h"

namespace lobelia::gather {
namespace {

// Lights and receivers of a pair that are tried until two face each other.
constexpr int kAttempts = 4;
constexpr uint64_t kLightStream = 0x6c69676874;

// As the packets of keepVisible() (visibility-inl.h) have it.
Vec3f rayOrigin(const PointStrip& strip, int lane, Vec3f toLight) {
  return dot(strip.ng.get(lane), toLight) >= 0 ? strip.front.get(lane) : strip.back.get(lane);
}
Vec3f rayEnd(const LightBlock& block, size_t light, Vec3f toLight) {
  const PreparedLight& l = block.lights[light];
  const bool behind = block.lightClass == LightClass::spherical && dot(l.n, toLight) > 0;
  return behind ? l.endBehind : l.end;
}

}  // namespace

PairShading::PairShading(const PairScene& scene, const ReceiverForest::Tree& receivers,
                         uint32_t node)
    : scene_(scene),
      receivers_(receivers),
      node_(node),
      first_(receivers.tree.nodes()[node].first),
      count_(receivers.tree.nodes()[node].count),
      tile_(makeTile(receivers.receivers, first_, first_ + count_)) {
  if (!receivers.whole.points.empty()) whole_ = makeTile(receivers.whole, first_, first_ + count_);
  if (!scene.lights.spherical.empty()) {
    addSampling(receivers.receivers, &tile_);
    if (!whole_.strips.empty()) addSampling(receivers.whole, &whole_);
  }
  receiverRays.assign(count_, 0);
  clear();
}

void PairShading::clear() {
  sums_ = {};
  sums_.strips.resize(tile_.strips.size());
  copied_.assign(scene_.share == Share::radiance ? count_ : 0, Vec3d{});
}

void PairShading::add(const LightForest::Tree& lights, std::vector<TreePair>* pairs,
                      std::span<const float> thresholds) {
  while (!pairs->empty()) {
    addOnce(lights, pairs);
    pairs->clear();
    if (!thresholds.empty()) splitUnanswered(lights, thresholds, pairs);
  }
}

void PairShading::splitUnanswered(const LightForest::Tree& lights,
                                  std::span<const float> thresholds,
                                  std::vector<TreePair>* children) {
  std::vector<TreePair> split;
  std::vector<NodePair> nodes;
  for (const Traced& pair : traced_) {
    const NodePair both{&receivers_.tree.nodes()[pair.nodes.receivers],
                        &lights.tree.nodes()[pair.nodes.lights]};
    if (pair.found || (both.receivers->leaf() && both.lights->leaf())) continue;
    split.push_back(pair.nodes);
    nodes.push_back(both);
  }
  std::vector<PairBounds> bounds(nodes.size());
  boundPairs(nodes, lights.lightClass, receivers_.glossy, BoundForm::tight, bounds.data());
  bounded += nodes.size();
  for (size_t i = 0; i < split.size(); ++i) {
    if (bounds[i].upper <= thresholds[split[i].receivers - node_]) continue;
    splitPair(receivers_.tree, lights, split[i],
              refinesLights(receivers_.tree, receivers_.glossy, lights, split[i]), children);
  }
}

void PairShading::addOnce(const LightForest::Tree& lights, std::vector<TreePair>* pairs) {
  std::sort(pairs->begin(), pairs->end(), [](const TreePair& a, const TreePair& b) {
    return a.lights != b.lights ? a.lights < b.lights : a.receivers < b.receivers;
  });
  traced_.clear();
  for (const TreePair& pair : *pairs) {
    const trees::BoundNode& p = receivers_.tree.nodes()[pair.receivers];
    const uint32_t begin = p.first - first_;
    traced_.push_back({pair, begin, begin + p.count, begin, false, false});
  }
  const int64_t start = nanosecondsNow();
  for (size_t i = 0; i < traced_.size(); i += kBlockLights)
    trace(lights, std::span(traced_).subspan(i, std::min(kBlockLights, traced_.size() - i)));
  const int64_t seen = nanosecondsNow();
  shadeAll(lights, traced_);
  visibilityNs += seen - start;
  shadeNs += nanosecondsNow() - seen;
}

void PairShading::trace(const LightForest::Tree& lights, std::span<Traced> pairs) {
  uint32_t waiting = static_cast<uint32_t>((uint64_t{1} << pairs.size()) - 1), found = 0;
  for (int attempt = 0; attempt < kAttempts && waiting != 0; ++attempt) {
    const uint32_t before = waiting;
    chooseEnds(lights, pairs, attempt, &waiting);
    found |= before & ~waiting;
  }
  traceRays(pairs, found);
}

// Of the waiting pairs (bit by bit) those that face each other wait no more.
void PairShading::chooseEnds(const LightForest::Tree& lights, std::span<Traced> pairs, int attempt,
                             uint32_t* waiting) {
  uint32_t index[kBlockLights], place[kBlockLights], receiver[kBlockLights];
  uint32_t count = 0;
  for (uint32_t i = 0; i < pairs.size(); ++i) {
    const Traced& pair = pairs[i];
    if ((*waiting >> i & 1) == 0) continue;
    const bool leaves = pair.end - pair.begin == 1 && lights.tree.nodes()[pair.nodes.lights].leaf();
    if (leaves && attempt > 0) continue;
    const uint64_t key = hashCombine(
        hashCombine(scene_.seed, uint64_t{pair.nodes.receivers} << 32 | pair.nodes.lights),
        static_cast<uint64_t>(attempt));
    place[count] = i;
    receiver[count] =
        pair.begin + static_cast<uint32_t>((key & 0xffffffffu) * (pair.end - pair.begin) >> 32);
    index[count++] = lightOf(lights, pair.nodes.lights, hashCombine(key, kLightStream));
  }
  if (count == 0) return;
  prepareChosen(scene_.lights, scene_.tracer.scene(), lights.lightClass, {index, count}, &ends_,
                scene_.prepared);
  for (size_t c = 0; c < count; ++c) {
    const size_t s = receiver[c] / kStrip;
    const int lane = static_cast<int>(receiver[c] % kStrip);
    if (!faces(tile_, s, static_cast<size_t>(lane), ends_, c)) continue;
    const uint32_t i = place[c];
    *waiting &= ~(1u << i);
    pairs[i].from = receiver[c];
    pairs[i].found = true;
    const PointStrip& strip = tile_.strips[s];
    const bool directional = lights.lightClass == LightClass::directional;
    const Vec3f d = directional ? ends_.lights[c].p : ends_.lights[c].p - strip.p.get(lane);
    rayFrom_[i] = rayOrigin(strip, lane, d);
    rayTo_[i] = directional ? ends_.lights[c].end : rayEnd(ends_, c, d) - rayFrom_[i];
    infinite_ = directional;
  }
}

void PairShading::traceRays(std::span<Traced> pairs, uint32_t found) {
  while (found != 0) {
    ShadowPacket packet;
    uint32_t which[ShadowPacket::kSize];
    int count = 0;
    for (; found != 0 && count < ShadowPacket::kSize; found &= found - 1) {
      const uint32_t i = static_cast<uint32_t>(__builtin_ctz(found));
      which[count] = i;
      packet.set(count++, Ray{rayFrom_[i], rayTo_[i], 0, infinite_ ? 3.4e38f : 1.f});
      ++receiverRays[pairs[i].from];
    }
    rays += static_cast<uint64_t>(count);
    for (int lane = count; lane < ShadowPacket::kSize; ++lane) {
      packet.set(lane, Ray{rayFrom_[which[0]], rayTo_[which[0]], 0, 1.f});
      packet.active[lane] = 0;
    }
    for (uint32_t bits = scene_.tracer.visible(packet, true); bits != 0; bits &= bits - 1)
      pairs[which[__builtin_ctz(bits)]].visible = true;
  }
}

// Blocks of light nodes, each with all of the visible pairs that it is in.
void PairShading::shadeAll(const LightForest::Tree& lights, std::span<const Traced> pairs) {
  uint32_t nodes[kBlockLights];
  size_t count = 0, first = 0;
  const auto flush = [&](size_t end) {
    prepareNodes(scene_.lights, scene_.tracer.scene(), lights, {nodes, count}, scene_.prepared,
                 &block_);
    shadeBlock(pairs.subspan(first, end - first), {nodes, count});
    count = 0;
  };
  for (size_t i = 0; i < pairs.size(); ++i) {
    if (!pairs[i].visible) continue;
    const uint32_t node = pairs[i].nodes.lights;
    if (count > 0 && nodes[count - 1] == node) continue;
    if (count == kBlockLights) flush(i);
    if (count == 0) first = i;
    nodes[count++] = node;
  }
  if (count > 0) flush(pairs.size());
}

// nodes: those of the visible pairs, in their order.
void PairShading::shadeBlock(std::span<const Traced> pairs, std::span<const uint32_t> nodes) {
  const size_t strips = tile_.strips.size();
  masks_.reset(nodes.size(), strips);
  std::fill(masks_.bits.begin(), masks_.bits.end(), uint16_t{0});
  size_t l = 0;
  for (const Traced& pair : pairs) {
    if (!pair.visible) continue;
    while (nodes[l] != pair.nodes.lights) ++l;
    const bool copies = scene_.share == Share::radiance;
    const uint32_t begin = copies ? pair.from : pair.begin;
    const uint32_t end = copies ? pair.from + 1 : pair.end;
    for (uint32_t i = begin; i < end; ++i)
      masks_.at(l, i / kStrip) |= static_cast<uint16_t>(1u << i % kStrip);
  }
  keepFacing(tile_, block_, &masks_);
  if (scene_.share == Share::radiance) return copyRadiance(pairs, nodes);
  if (!whole_.strips.empty()) return addValues();
  shadeMasks();
}

// Calls f(strip, lane, index of its value) for the pairs of the masks, in their order.
template <class F>
void PairShading::forMasked(const F& f) const {
  for (size_t m = 0; m < masks_.bits.size(); ++m) {
    for (uint32_t bits = masks_.bits[m]; bits != 0; bits &= bits - 1) {
      const size_t lane = static_cast<size_t>(__builtin_ctz(bits));
      f(m % masks_.strips, lane, m * kStrip + lane);
    }
  }
}

void PairShading::shadeMasks() {
  TileSums sums;
  sums.strips.resize(tile_.strips.size());
  shade(tile_, block_, scene_.clamp, masks_, &sums);
  for (size_t s = 0; s < sums.strips.size(); ++s) {
    for (size_t i = 0; i < kStrip; ++i) {
      sums_.strips[s].x[i] += sums.strips[s].x[i];
      sums_.strips[s].y[i] += sums.strips[s].y[i];
      sums_.strips[s].z[i] += sums.strips[s].z[i];
    }
    noteBad(s, sums.strips[s].nonfinite);
  }
  shaded += sums.pairs;
  nonfinite += sums.nonfinite;
}

// Of the masks, one by one; what is not in them is left as it was.
void PairShading::computeValues() {
  const auto compute = [&](const Tile& tile, float clamp, PairValues* values) {
    for (AlignedFloats* channel : {&values->x, &values->y, &values->z})
      channel->resize(masks_.bits.size() * kStrip);
    values->pairs = values->nonfinite = 0;
    shadePairs(tile, block_, clamp, masks_, values);
  };
  compute(tile_, whole_.strips.empty() ? scene_.clamp : 0, &values_);
  shaded += values_.pairs;
  nonfinite += values_.nonfinite;
  if (values_.nonfinite > 0) {  // whose they are, sums know
    TileSums sums;
    sums.strips.resize(tile_.strips.size());
    shade(tile_, block_, whole_.strips.empty() ? scene_.clamp : 0, masks_, &sums);
    for (size_t s = 0; s < sums.strips.size(); ++s) noteBad(s, sums.strips[s].nonfinite);
  }
  if (whole_.strips.empty()) return;
  compute(whole_, scene_.clamp, &clamped_);
  compute(whole_, 0, &free_);
  forMasked([&](size_t, size_t, size_t i) {
    const float all = free_.x[i] + free_.y[i] + free_.z[i];
    if (!(all > 0)) return;
    const float left = (clamped_.x[i] + clamped_.y[i] + clamped_.z[i]) / all;
    values_.x[i] *= left, values_.y[i] *= left, values_.z[i] *= left;
  });
}

void PairShading::addValues() {
  computeValues();
  forMasked([&](size_t s, size_t lane, size_t i) {
    sums_.strips[s].x[lane] += double{values_.x[i]};
    sums_.strips[s].y[lane] += double{values_.y[i]};
    sums_.strips[s].z[lane] += double{values_.z[i]};
  });
}

void PairShading::copyRadiance(std::span<const Traced> pairs, std::span<const uint32_t> nodes) {
  computeValues();
  const size_t strips = tile_.strips.size();
  size_t l = 0;
  for (const Traced& pair : pairs) {
    if (!pair.visible) continue;
    while (nodes[l] != pair.nodes.lights) ++l;
    const size_t mask = l * strips + pair.from / kStrip, at = mask * kStrip + pair.from % kStrip;
    if ((masks_.bits[mask] >> pair.from % kStrip & 1) == 0) continue;
    const Rgb weight = receivers_.receivers.points[first_ + pair.from].weight;
    const Rgb value = weight * Rgb(values_.x[at], values_.y[at], values_.z[at]);
    for (uint32_t i = pair.begin; i < pair.end; ++i)
      copied_[i] += Vec3d(double{value.x}, double{value.y}, double{value.z});
  }
}

void PairShading::noteBad(size_t strip, uint32_t lanes) {
  for (uint32_t lane = 0; lane < kStrip; ++lane) {
    if ((tile_.strips[strip].active & lanes) >> lane == 0) break;
    if (!((tile_.strips[strip].active & lanes) >> lane & 1)) continue;
    const uint32_t pixel = receivers_.receivers.points[tile_.strips[strip].point[lane]].pixel;
    if (!firstBad || pixel < *firstBad) firstBad = pixel;
  }
}

Rgb PairShading::radiance(uint32_t i) const {
  const auto rgb = [](double x, double y, double z) {
    return Rgb(static_cast<float>(x), static_cast<float>(y), static_cast<float>(z));
  };
  if (scene_.share == Share::radiance) return rgb(copied_[i].x, copied_[i].y, copied_[i].z);
  const TileSums::Strip& sum = sums_.strips[i / kStrip];
  const size_t lane = i % kStrip;
  return receivers_.receivers.points[first_ + i].weight *
         rgb(sum.x[lane], sum.y[lane], sum.z[lane]);
}

}  // namespace lobelia::gather
