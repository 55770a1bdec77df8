// Shadow rays of a tile and a block of lights in full packets.
//
// Pairs that face each other are compacted into a queue in the order light, strip, lane; whenever
// 16 rays have gathered they are traced as a packet. Neighbours in it come from neighbouring points
// and mostly go to one light, which is what makes packets coherent. Where the points of a strip lie
// further apart than the lights (few pixels of a picture, or very many lights), the order is strip,
// lane, light. Where one receiver is asked for each light (keepVisibleByOne()), no two rays of a
// packet share either, and it is not called coherent.
#if defined(LOBELIA_GATHER_VISIBILITY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_VISIBILITY_INL_H_
#undef LOBELIA_GATHER_VISIBILITY_INL_H_
#else
#define LOBELIA_GATHER_VISIBILITY_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstring>
#include <iterator>

#include "lobelia/base/random.h"
#include "lobelia/gather/depth_lookup-inl.h"
#include "lobelia/gather/facing-inl.h"
#include "lobelia/gather/kernels.h"
#include "lobelia/trace/tracer.h"

LOBELIA_CORE_BEGIN

class RayQueue {
 public:
  RayQueue(const Tracer& tracer, g::PairMasks* visible, float tMax, bool coherent)
      : tracer_(tracer), visible_(visible), tMax_(tMax), coherent_(coherent) {}

  // Appends the lanes of `mask`. firstPair: number of lane 0's pair, (light * strips + strip) * 16
  // + lane.
  HWY_INLINE void push(Mf mask, V3<Vf> origin, V3<Vf> direction, uint32_t firstPair) {
    const Df d;
    append(mask, origin.x, ox_);
    append(mask, origin.y, oy_);
    append(mask, origin.z, oz_);
    append(mask, direction.x, dx_);
    append(mask, direction.y, dy_);
    append(mask, direction.z, dz_);
    const hn::RebindToSigned<Df> di;
    const auto ids = hn::Add(hn::Iota(di, 0), hn::Set(di, static_cast<int32_t>(firstPair)));
    hn::StoreU(hn::Compress(ids, hn::RebindMask(di, mask.m)), di, pair_ + count_);
    count_ += hn::CountTrue(d, mask.m);
    if (count_ >= ShadowPacket::kSize) trace(ShadowPacket::kSize);
  }
  void push(Vec3f origin, Vec3f direction, uint32_t pair) {
    ox_[count_] = origin.x, oy_[count_] = origin.y, oz_[count_] = origin.z;
    dx_[count_] = direction.x, dy_[count_] = direction.y, dz_[count_] = direction.z;
    pair_[count_] = static_cast<int32_t>(pair);
    if (++count_ == ShadowPacket::kSize) trace(ShadowPacket::kSize);
  }
  void flush() {
    if (count_ > 0) trace(count_);
  }
  size_t traced() const { return traced_; }

 private:
  static constexpr size_t kSize = ShadowPacket::kSize;

  HWY_INLINE void append(Mf mask, Vf value, float* array) {
    hn::StoreU(hn::Compress(value.v, mask.m), Df(), array + count_);
  }

  HWY_NOINLINE void trace(size_t count) {
    ShadowPacket packet;
    std::memcpy(packet.ox, ox_, sizeof(packet.ox));
    std::memcpy(packet.oy, oy_, sizeof(packet.oy));
    std::memcpy(packet.oz, oz_, sizeof(packet.oz));
    std::memcpy(packet.dx, dx_, sizeof(packet.dx));
    std::memcpy(packet.dy, dy_, sizeof(packet.dy));
    std::memcpy(packet.dz, dz_, sizeof(packet.dz));
    for (size_t i = 0; i < kSize; ++i) {
      packet.tMin[i] = 0;
      packet.tMax[i] = tMax_;
      packet.active[i] = i < count ? -1 : 0;
    }
    uint32_t bits = tracer_.visible(packet, coherent_);
    traced_ += count;
    for (; bits != 0; bits &= bits - 1) {
      const size_t pair = static_cast<size_t>(pair_[__builtin_ctz(bits)]);
      visible_->bits[pair / g::kStrip] |= static_cast<uint16_t>(1u << (pair % g::kStrip));
    }
    for (float* array : {ox_, oy_, oz_, dx_, dy_, dz_}) {
      std::memcpy(array, array + kSize, kSize * sizeof(float));
    }
    std::memcpy(pair_, pair_ + kSize, kSize * sizeof(int32_t));
    count_ -= count;
  }

  // Up to 15 waiting rays and a register of new ones, stored whole.
  alignas(64) float ox_[2 * kSize] = {}, oy_[2 * kSize] = {}, oz_[2 * kSize] = {};
  alignas(64) float dx_[2 * kSize] = {}, dy_[2 * kSize] = {}, dz_[2 * kSize] = {};
  alignas(64) int32_t pair_[2 * kSize] = {};
  size_t count_ = 0;
  const Tracer& tracer_;
  g::PairMasks* visible_;
  const float tMax_;
  const bool coherent_;
  size_t traced_ = 0;
};

// Do the points of a strip lie further apart than the lights of a block? Then rays from one point
// to the lights are coherent, not those from the points to one light.
inline bool apart(const g::PointStrip& strip, const Bounds3f& lights) {
  Bounds3f points;
  for (int lane = 0; lane < g::kStrip; ++lane) points.add(strip.p.get(lane));
  return length(points.extent()) > length(lights.extent());
}

// Rays from the points of a strip to the lights of a block.
class StripRays {
 public:
  StripRays() : masks_{} {}
  HWY_INLINE void put(size_t light, size_t lane, Mf mask, V3<Vf> origin, V3<Vf> direction) {
    const Vf values[] = {origin.x, origin.y, origin.z, direction.x, direction.y, direction.z};
    for (size_t i = 0; i < 6; ++i) values[i].store(&rays_[light][i][lane]);
    masks_[light] |= maskBits(mask) << lane;
  }
  // Point by point, and forgets them. firstPair, stride: numbers of the pairs of lane 0.
  void drain(uint32_t firstPair, uint32_t stride, RayQueue* queue) {
    for (uint32_t lane = 0; lane < g::kStrip; ++lane)
      for (uint32_t light = 0; light < g::kBlockLights; ++light) {
        if (!(masks_[light] >> lane & 1)) continue;
        const auto at = [&](size_t i) { return rays_[light][i][lane]; };
        queue->push({at(0), at(1), at(2)}, {at(3), at(4), at(5)},
                    firstPair + light * stride + lane);
      }
    std::fill(std::begin(masks_), std::end(masks_), 0u);
  }

 private:
  alignas(64) float rays_[g::kBlockLights][6][g::kStrip];
  uint32_t masks_[g::kBlockLights];
};

template <g::LightClass kClass>
class VisiblePairs {
 public:
  VisiblePairs(const g::Tile& tile, const g::LightBlock& block, const Tracer& tracer,
               g::PairMasks* pairs, bool coherent)
      : tile_(tile),
        block_(block),
        pairs_(*pairs),
        // Ends of rays are off the lights' surfaces already.
        queue_(tracer, pairs, kInfinite ? 3.4e38f : 1.f, coherent) {
    if (choosesPlaces()) hashPoints();
  }

  size_t run() {
    bool wide[g::kMaxTilePoints] = {};  // strip by strip: there are no more than points
    if (!kInfinite) {
      Bounds3f lights;
      for (size_t l = 0; l < lightCount(); ++l) lights.add(block_.lights[l].p);
      for (size_t s = 0; s < tile_.strips.size(); ++s) wide[s] = apart(tile_.strips[s], lights);
    }
    for (size_t l = 0; l < lightCount(); ++l)
      for (size_t s = 0; s < tile_.strips.size(); ++s)
        if (!wide[s])
          forRays(l, s, [&](size_t lane, Mf mask, V3<Vf> origin, V3<Vf> direction) {
            queue_.push(mask, origin, direction, pairOf(l, s) + static_cast<uint32_t>(lane));
          });
    if (std::any_of(std::begin(wide), std::end(wide), [](bool w) { return w; })) runWide(wide);
    queue_.flush();
    return queue_.traced();
  }

 private:
  static constexpr bool kInfinite = kClass == g::LightClass::directional;
  static constexpr int kPlaceShift = 30;
  static_assert(GaussianLight::kPlaces == 1 << (32 - kPlaceShift));

  size_t lightCount() const { return static_cast<size_t>(block_.count); }
  uint32_t pairOf(size_t l, size_t s) const {  // of lane 0
    return static_cast<uint32_t>((l * pairs_.strips + s) * g::kStrip);
  }

  void runWide(const bool* wide) {
    StripRays rays;
    for (size_t s = 0; s < tile_.strips.size(); ++s) {
      if (!wide[s]) continue;
      for (size_t l = 0; l < lightCount(); ++l)
        forRays(l, s, [&](size_t lane, Mf mask, V3<Vf> origin, V3<Vf> direction) {
          rays.put(l, lane, mask, origin, direction);
        });
      rays.drain(pairOf(0, s), pairOf(1, 0), &queue_);
    }
  }

  // use(lane, mask, origin, direction) for the candidates that face each other.
  template <class Use>
  HWY_INLINE void forRays(size_t l, size_t s, const Use& use) {
    const uint32_t candidates = pairs_.at(l, s);
    pairs_.at(l, s) = 0;  // the queue sets visible ones again
    if (candidates == 0) return;
    const g::PreparedLight& light = block_.lights[l];
    const g::PointStrip& strip = tile_.strips[s];
    for (size_t lane = 0; lane < g::kStrip; lane += kLanes) {
      const V3<Vf> d = toLight<kClass>(light, load(strip.p, lane));
      const Mf mask = lightFaces<kClass>(light, d) & receiverFaces(strip, lane, d, light.extent) &
                      beyondNear<kClass>(strip, lane, d) & maskFromBits(candidates >> lane);
      if (!any(mask)) continue;
      if (kClusters && block_.depthMaps != nullptr) {
        const Mf lit = litByMaps(l, strip, lane, mask);
        pairs_.at(l, s) |= static_cast<uint16_t>(maskBits(lit) << lane);
        continue;
      }
      if (pairs_.traced != nullptr) {
        (*pairs_.traced)[l * pairs_.strips + s] |= static_cast<uint16_t>(maskBits(mask) << lane);
      }
      V3<Vf> end = broadcast(light.end);
      if constexpr (kClass == g::LightClass::spherical)
        end = choose(dot(broadcast(light.n), d) > Vf(0.f), broadcast(light.endBehind), end);
      if (choosesPlaces()) end = chosenPlaces(l, s, lane);
      if constexpr (kClusters) end = aboveHorizon(l, strip, lane, mask, end);
      // Clusters reach to both sides: the side that the ray's end is on counts.
      const V3<Vf> towards = kClusters ? end - load(strip.p, lane) : d;
      const Mf front = dot(load(strip.ng, lane), towards) >= Vf(0.f);
      const V3<Vf> origin = choose(front, load(strip.front, lane), load(strip.back, lane));
      use(lane, mask, origin, kInfinite ? end : end - origin);
    }
  }

  // Of the lanes of `mask`, those that the light's shadow maps say are lit: the map of its first
  // place above their horizon, as rays have it (aboveHorizon()).
  HWY_INLINE Mf litByMaps(size_t l, const g::PointStrip& strip, size_t lane, Mf mask) const {
    const g::DepthMaps& maps = *block_.depthMaps;
    const V3<Vf> p = load(strip.p, lane), ng = load(strip.ng, lane);
    Mf asked = mask, lit = Vf(0.f) > Vf(0.f);
    for (int i = 0; i < GaussianLight::kPlaces && any(asked); ++i) {
      const V3<Vf> end = broadcast(block_.gaussians[l].ends[i]);
      const Mf above = asked & receiverFaces(strip, lane, end - p, 0);
      if (!any(above)) continue;
      lit = lit | (above & depthMapLit(maps.of(block_.index[l], i), maps.texels(i), end, p, ng));
      asked = asked & !above;
    }
    if (!any(asked)) return lit;
    const V3<Vf> end = broadcast(block_.lights[l].end);
    return lit | (asked & depthMapLit(maps.of(block_.index[l], 0), maps.texels(0), end, p, ng));
  }

  static constexpr bool kClusters = kClass == g::LightClass::gaussian;
  bool choosesPlaces() const {
    return kClusters && block_.gaussianShading.ends == GaussianShading::Ends::random;
  }
  // One of a cluster's places for each point, the same whatever tile the point is in.
  HWY_INLINE V3<Vf> chosenPlaces(size_t l, size_t s, size_t lane) const {
    const uint32_t key = static_cast<uint32_t>(hashCombine(block_.index[l], 0)) | 1;
    uint32_t bits[GaussianLight::kPlaces] = {};
    for (size_t k = 0; k < kLanes; ++k)
      bits[pointKeys_[s][lane + k] * key >> kPlaceShift] |= 1u << k;
    V3<Vf> end = broadcast(block_.gaussians[l].ends[0]);
    for (int i = 1; i < GaussianLight::kPlaces; ++i)
      end = choose(maskFromBits(bits[i]), broadcast(block_.gaussians[l].ends[i]), end);
    return end;
  }
  // What shading has of a cluster is the part above a receiver's horizon: where the end of its ray
  // lies below, another place is asked for, if one is above.
  HWY_INLINE V3<Vf> aboveHorizon(size_t l, const g::PointStrip& strip, size_t lane, Mf mask,
                                 V3<Vf> end) const {
    const V3<Vf> p = load(strip.p, lane);
    Mf below = mask & !receiverFaces(strip, lane, end - p, 0);
    for (int i = 0; i < GaussianLight::kPlaces && any(below); ++i) {
      const V3<Vf> other = broadcast(block_.gaussians[l].ends[i]);
      const Mf better = below & receiverFaces(strip, lane, other - p, 0);
      end = choose(better, other, end);
      below = below & !better;
    }
    return end;
  }
  void hashPoints() {
    for (size_t s = 0; s < tile_.strips.size(); ++s)
      for (size_t lane = 0; lane < g::kStrip; ++lane) {
        const Vec3f p = tile_.strips[s].p.get(static_cast<int>(lane));
        const uint64_t xy = hashCombine(std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y));
        pointKeys_[s][lane] = static_cast<uint32_t>(hashCombine(xy, std::bit_cast<uint32_t>(p.z)));
      }
  }

  HWY_INLINE static V3<Vf> choose(Mf mask, V3<Vf> a, V3<Vf> b) {
    return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
  }

  const g::Tile& tile_;
  const g::LightBlock& block_;
  g::PairMasks& pairs_;
  RayQueue queue_;
  uint32_t pointKeys_[kClusters ? g::kMaxTilePoints : 1][g::kStrip];  // there are no more strips
};

template <g::LightClass kClass>
size_t keepVisibleOf(const g::Tile& tile, const g::LightBlock& block, const Tracer& tracer,
                     g::PairMasks* pairs, bool coherent) {
  return VisiblePairs<kClass>(tile, block, tracer, pairs, coherent).run();
}

LOBELIA_CORE_END

#endif  // per-target include guard
