// Shadow rays of a tile and a block of lights in full packets.
//
// Pairs that face each other are compacted into a queue in the order light, strip, lane; whenever
// 16 rays have gathered they are traced as a packet. Neighbours in it come from neighbouring points
// and mostly go to one light, which is what makes packets coherent.
#if defined(LOBELIA_GATHER_VISIBILITY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_VISIBILITY_INL_H_
#undef LOBELIA_GATHER_VISIBILITY_INL_H_
#else
#define LOBELIA_GATHER_VISIBILITY_INL_H_
#endif

#include <cstring>

#include "lobelia/gather/facing-inl.h"
#include "lobelia/gather/kernels.h"
#include "lobelia/trace/tracer.h"

LOBELIA_CORE_BEGIN

class RayQueue {
 public:
  RayQueue(const Tracer& tracer, g::PairMasks* visible, float tMax)
      : tracer_(tracer), visible_(visible), tMax_(tMax) {}

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
    uint32_t bits = tracer_.visible(packet, true);
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
  float tMax_;
  size_t traced_ = 0;
};

template <g::LightClass kClass>
size_t keepVisibleOf(const g::Tile& tile, const g::LightBlock& block, const Tracer& tracer,
                     g::PairMasks* pairs) {
  constexpr bool kInfinite = kClass == g::LightClass::directional;
  // Ends of rays are off the lights' surfaces already.
  RayQueue queue(tracer, pairs, kInfinite ? 3.4e38f : 1.f);
  for (size_t l = 0; l < static_cast<size_t>(block.count); ++l) {
    const g::PreparedLight& light = block.lights[l];
    for (size_t s = 0; s < tile.strips.size(); ++s) {
      const uint32_t candidates = pairs->at(l, s);
      pairs->at(l, s) = 0;  // the queue sets visible ones again
      if (candidates == 0) continue;
      const g::PointStrip& strip = tile.strips[s];
      for (size_t lane = 0; lane < g::kStrip; lane += kLanes) {
        const V3<Vf> d = toLight<kClass>(light, load(strip.p, lane));
        const Mf mask = lightFaces<kClass>(light, d) & receiverFaces(strip, lane, d) &
                        maskFromBits(candidates >> lane);
        if (!any(mask)) continue;
        if (pairs->traced != nullptr) {
          (*pairs->traced)[l * pairs->strips + s] |= static_cast<uint16_t>(maskBits(mask) << lane);
        }
        const Mf front = dot(load(strip.ng, lane), d) >= Vf(0.f);
        const V3<Vf> f = load(strip.front, lane), b = load(strip.back, lane);
        const V3<Vf> origin{select(front, f.x, b.x), select(front, f.y, b.y),
                            select(front, f.z, b.z)};
        V3<Vf> end = broadcast(light.end);
        if constexpr (kClass == g::LightClass::spherical) {
          const Mf behind = dot(broadcast(light.n), d) > Vf(0.f);
          const V3<Vf> other = broadcast(light.endBehind);
          end = {select(behind, other.x, end.x), select(behind, other.y, end.y),
                 select(behind, other.z, end.z)};
        }
        const uint32_t pair = static_cast<uint32_t>((l * pairs->strips + s) * g::kStrip + lane);
        queue.push(mask, origin, kInfinite ? end : end - origin, pair);
      }
    }
  }
  queue.flush();
  return queue.traced();
}

LOBELIA_CORE_END

#endif  // per-target include guard
