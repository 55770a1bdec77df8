#include "lobelia/gather/mrcs_kernels.h"

#include <algorithm>

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/gather/mrcs_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
// After Highway's headers: compiled once per target.
#include "lobelia/base/simd-inl.h"
#include "lobelia/gather/mrcs_kernels.h"

LOBELIA_CORE_BEGIN

namespace g = ::lobelia::gather;

HWY_INLINE Vf mulAdd(Vf a, Vf b, Vf c) { return hn::MulAdd(a.v, b.v, c.v); }

void sketchRow(const float* row, size_t length, const float* signs, size_t dims, float* sketch) {
  constexpr size_t kRegisters = g::kMrcsLanes / kLanes;
  for (size_t d = 0; d < dims; d += g::kMrcsLanes) {
    Vf sum[kRegisters];
    for (size_t v = 0; v < kRegisters; ++v) sum[v] = Vf(0.f);
    for (size_t r = 0; r < length; ++r) {
      if (row[r] == 0) continue;  // most lights do not reach most rows
      const Vf x(row[r]);
      for (size_t v = 0; v < kRegisters; ++v)
        sum[v] = mulAdd(x, Vf::load(signs + r * dims + d + v * kLanes), sum[v]);
    }
    for (size_t v = 0; v < kRegisters; ++v) sum[v].store(sketch + d + v * kLanes);
  }
}

using HalfLanes = hn::Rebind<hwy::float16_t, Df>;

void packHalves(const float* values, size_t count, uint16_t* halves) {
  auto* out = reinterpret_cast<hwy::float16_t*>(halves);
  for (size_t i = 0; i < count; i += kLanes)
    hn::StoreU(hn::DemoteTo(HalfLanes(), Vf::load(values + i).v), HalfLanes(), out + i);
}

void unpackHalves(const uint16_t* halves, size_t count, float scale, float* values) {
  const auto* in = reinterpret_cast<const hwy::float16_t*>(halves);
  for (size_t i = 0; i < count; i += kLanes)
    (Vf(hn::PromoteTo(Df(), hn::LoadU(HalfLanes(), in + i))) * Vf(scale)).store(values + i);
}

float dotProduct(const float* a, const float* b, size_t count) {
  Vf sum(0.f);
  for (size_t i = 0; i < count; i += kLanes) sum = mulAdd(Vf::load(a + i), Vf::load(b + i), sum);
  alignas(64) float lanes[kLanes];
  sum.store(lanes);
  float total = 0;
  for (size_t i = 0; i < kLanes; ++i) total += lanes[i];
  return total;
}

void addScaled(float factor, const float* values, size_t count, float* sum) {
  for (size_t i = 0; i < count; i += kLanes)
    mulAdd(Vf(factor), Vf::load(values + i), Vf::load(sum + i)).store(sum + i);
}

// Least scores so far of a light, lane by lane, and whose they are (exact below 2^24).
struct Best {
  alignas(64) float score[kLanes];
  alignas(64) float centre[kLanes];
};

// As many lights and registers of centres at once as fill AVX2's 16 registers.
inline constexpr size_t kAtOnce = 6;
inline constexpr size_t kWide = g::kMrcsLanes / kLanes < 2 ? 1 : 2;

// Centres [begin, begin + kWide * kLanes) of a group with kAtOnce lights.
HWY_INLINE void scoreCentres(const float* const* vectors, const float* squared,
                             const g::CentreTable& centres, size_t group, size_t lane, Best* best) {
  const float* table = &centres.vectors[group * centres.dims * g::kMrcsLanes + lane];
  Vf dots[kAtOnce][kWide];
  for (size_t i = 0; i < kAtOnce; ++i)
    for (size_t v = 0; v < kWide; ++v) dots[i][v] = Vf(0.f);
  for (size_t d = 0; d < centres.dims; ++d) {
    Vf c[kWide];
    for (size_t v = 0; v < kWide; ++v) c[v] = Vf::load(table + d * g::kMrcsLanes + v * kLanes);
    for (size_t i = 0; i < kAtOnce; ++i) {
      const Vf a(vectors[i][d]);
      for (size_t v = 0; v < kWide; ++v) dots[i][v] = mulAdd(a, c[v], dots[i][v]);
    }
  }
  for (size_t v = 0; v < kWide; ++v) {
    const size_t first = group * g::kMrcsLanes + lane + v * kLanes;
    const Vf gain = Vf::load(&centres.gain[first]), offset = Vf::load(&centres.offset[first]);
    const Vf number = Vf(hn::Iota(Df(), 0.f)) + Vf(static_cast<float>(first));
    for (size_t i = 0; i < kAtOnce; ++i) {
      const Vf score = mulAdd(gain, Vf(squared[i]), offset) - dots[i][v];
      const Vf least = Vf::load(best[i].score);
      const Mf better = score < least;
      select(better, score, least).store(best[i].score);
      select(better, number, Vf::load(best[i].centre)).store(best[i].centre);
    }
  }
}

uint32_t bestOf(const Best& best) {
  size_t found = 0;
  for (size_t k = 1; k < kLanes; ++k) {
    const bool less = best.score[k] < best.score[found];
    const bool earlier = best.score[k] == best.score[found] && best.centre[k] < best.centre[found];
    if (less || earlier) found = k;
  }
  return static_cast<uint32_t>(best.centre[found]);
}

void nearestCentres(const float* vectors, const float* squaredLengths, size_t count,
                    const g::CentreTable& centres, uint32_t* best) {
  constexpr size_t kLights = 16 * kAtOnce;  // their vectors stay in the first cache
  constexpr size_t kTableFloats = 16384;    // and so do these of centres in the second
  const size_t groups = std::max<size_t>(kTableFloats / (centres.dims * g::kMrcsLanes), 1);
  Best found[kLights];
  for (size_t begin = 0; begin < count; begin += kLights) {
    const size_t lights = std::min(kLights, count - begin);
    for (Best& b : found) {
      Vf(kInfinityF).store(b.score);
      Vf(0.f).store(b.centre);
    }
    for (size_t first = 0; first < centres.groups; first += groups) {
      const size_t last = std::min(first + groups, centres.groups);
      for (size_t l = 0; l < lights; l += kAtOnce) {
        const float* a[kAtOnce];
        float squared[kAtOnce];
        for (size_t i = 0; i < kAtOnce; ++i) {  // the last few may repeat one
          const size_t light = begin + std::min(l + i, lights - 1);
          a[i] = vectors + light * centres.dims;
          squared[i] = squaredLengths[light];
        }
        for (size_t group = first; group < last; ++group)
          for (size_t lane = 0; lane < g::kMrcsLanes; lane += kWide * kLanes)
            scoreCentres(a, squared, centres, group, lane, found + l);
      }
    }
    for (size_t l = 0; l < lights; ++l) best[begin + l] = bestOf(found[l]);
  }
}

LOBELIA_CORE_END

#if HWY_ONCE
namespace lobelia {
HWY_EXPORT(sketchRow);
HWY_EXPORT(packHalves);
HWY_EXPORT(unpackHalves);
HWY_EXPORT(dotProduct);
HWY_EXPORT(addScaled);
HWY_EXPORT(nearestCentres);
}  // namespace lobelia

namespace lobelia::gather {

void sketchRow(const float* row, size_t length, const float* signs, size_t dims, float* sketch) {
  HWY_DYNAMIC_DISPATCH(lobelia::sketchRow)(row, length, signs, dims, sketch);
}
void packHalves(const float* values, size_t count, uint16_t* halves) {
  HWY_DYNAMIC_DISPATCH(lobelia::packHalves)(values, count, halves);
}
void unpackHalves(const uint16_t* halves, size_t count, float scale, float* values) {
  HWY_DYNAMIC_DISPATCH(lobelia::unpackHalves)(halves, count, scale, values);
}
float dotProduct(const float* a, const float* b, size_t count) {
  return HWY_DYNAMIC_DISPATCH(lobelia::dotProduct)(a, b, count);
}
void addScaled(float factor, const float* values, size_t count, float* sum) {
  HWY_DYNAMIC_DISPATCH(lobelia::addScaled)(factor, values, count, sum);
}
void nearestCentres(const float* vectors, const float* squaredLengths, size_t count,
                    const CentreTable& centres, uint32_t* best) {
  HWY_DYNAMIC_DISPATCH(lobelia::nearestCentres)(vectors, squaredLengths, count, centres, best);
}

CentreTable::CentreTable(size_t centreCount, size_t dimensions)
    : count(centreCount),
      groups((centreCount + kMrcsLanes - 1) / kMrcsLanes),
      dims(dimensions),
      vectors(groups * dims * kMrcsLanes, 0.f),
      gain(groups * kMrcsLanes, 0.f),
      offset(groups * kMrcsLanes, 3e38f) {}  // centres that fill the last group are never nearest

void CentreTable::set(size_t k, const float* centre, float squaredLength, float gainOfCentre) {
  float* out = &vectors[k / kMrcsLanes * dims * kMrcsLanes + k % kMrcsLanes];
  for (size_t d = 0; d < dims; ++d) out[d * kMrcsLanes] = 2 * gainOfCentre * centre[d];
  gain[k] = gainOfCentre;
  offset[k] = gainOfCentre * squaredLength;
}

}  // namespace lobelia::gather
#endif
