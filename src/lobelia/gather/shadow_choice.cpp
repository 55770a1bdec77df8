#include "lobelia/gather/shadow_choice.h"

#include <algorithm>
#include <bit>

#include "lobelia/base/random.h"
#include "lobelia/gather/facing_pairs.h"
#include "lobelia/gather/light_range.h"

namespace lobelia::gather {
double ShadowChoice::randomOf(Vec3f p) const {
  const uint64_t xy = hashCombine(std::bit_cast<uint32_t>(p.x), std::bit_cast<uint32_t>(p.y));
  const uint64_t key = hashCombine(hashCombine(seed_, xy), std::bit_cast<uint32_t>(p.z));
  return static_cast<double>(key >> 11) * 0x1p-53;
}

ShadowChoice::ShadowChoice(const ShadowScene& scene, const Tile& tile, uint64_t seed)
    : scene_(scene), tile_(tile), seed_(seed), width_(tile.strips.size() * kStrip) {}

size_t ShadowChoice::add(size_t first, size_t end, TileSums* sums) {
  const int64_t start = nanosecondsNow();
  estimate(first, end);
  choose();
  shadeNs += nanosecondsNow() - start;
  size_t rays = 0;
  for (size_t at = first; at < end; at += kBlockLights) {
    prepareBlock(at, end);
    const float* factors = &weights_[(at - first) * width_];
    if (!keepChosen(factors)) continue;
    const int64_t prepared = nanosecondsNow();
    rays += keepVisible(tile_, block_, scene_.tracer, &pairs_);
    const int64_t traced = nanosecondsNow();
    values_.reset(static_cast<size_t>(block_.count), tile_.strips.size());
    shadePairs(tile_, block_, scene_.settings.clamp, pairs_, &values_);
    for (size_t l = 0; l < static_cast<size_t>(block_.count); ++l)
      addScaled(l, factors + l * width_, sums);
    visibilityNs += traced - prepared;
    shadeNs += nanosecondsNow() - traced;
  }
  sums->pairs += values_.pairs;
  sums->nonfinite += values_.nonfinite;
  values_.pairs = values_.nonfinite = 0;
  return rays;
}

// Leaves of the pairs those of lights that a point has chosen.
bool ShadowChoice::keepChosen(const float* factors) {
  bool any = false;
  for (size_t i = 0; i < static_cast<size_t>(block_.count) * tile_.strips.size(); ++i) {
    uint32_t chosen = 0;
    for (uint32_t lane = 0; lane < kStrip; ++lane)
      chosen |= (factors[i * kStrip + lane] > 0 ? 1u : 0u) << lane;
    pairs_.bits[i] &= static_cast<uint16_t>(chosen);
    any = any || pairs_.bits[i] != 0;
  }
  return any;
}

void ShadowChoice::prepareBlock(size_t first, size_t end) {
  prepare(scene_.lights, scene_.tracer.scene(), LightClass::gaussian, first,
          std::min(kBlockLights, end - first), &block_, scene_.prepared);
  allowPairs(tile_, block_, scene_.lights, scene_.settings, &pairs_);
}

void ShadowChoice::estimate(size_t first, size_t end) {
  weights_.assign((end - first) * width_, 0.f);
  PairLuminances luminances;
  for (size_t at = first; at < end; at += kBlockLights) {
    prepareBlock(at, end);
    keepFacing(tile_, block_, &pairs_);
    luminances.values = &weights_[(at - first) * width_];
    shadeLuminances(tile_, block_, scene_.settings.clamp, pairs_, &luminances);
  }
}

void ShadowChoice::choose() {
  std::vector<double> step(width_), next(width_), before(width_);
  for (size_t at = 0; at < weights_.size(); at += width_)
    for (size_t i = 0; i < width_; ++i) step[i] += static_cast<double>(weights_[at + i]);
  for (size_t i = 0; i < width_; ++i) {
    step[i] /= scene_.settings.shadowRays;
    next[i] = step[i] * randomOf(tile_.strips[i / kStrip].p.get(static_cast<int>(i % kStrip)));
  }
  for (size_t at = 0; at < weights_.size(); at += width_)
    for (size_t i = 0; i < width_; ++i) {
      const double weight = static_cast<double>(weights_[at + i]);
      before[i] += weight;
      int times = 0;
      for (; next[i] < before[i]; next[i] += step[i]) ++times;
      weights_[at + i] = times > 0 ? static_cast<float>(times * step[i] / weight) : 0.f;
    }
}

void ShadowChoice::addScaled(size_t light, const float* factors, TileSums* sums) const {
  for (size_t s = 0; s < tile_.strips.size(); ++s) {
    for (size_t lane = 0; lane < kStrip; ++lane) {
      if (!(pairs_.bits[light * pairs_.strips + s] >> lane & 1)) continue;
      const size_t i = light * width_ + s * kStrip + lane;
      const double factor = static_cast<double>(factors[s * kStrip + lane]);
      TileSums::Strip& sum = sums->strips[s];
      sum.x[lane] += factor * static_cast<double>(values_.x[i]);
      sum.y[lane] += factor * static_cast<double>(values_.y[i]);
      sum.z[lane] += factor * static_cast<double>(values_.z[i]);
    }
  }
}

}  // namespace lobelia::gather
