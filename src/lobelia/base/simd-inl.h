// The numerical core's number type for SIMD: Vf, a register of floats, and Mf, its mask, as thin
// wrappers of Highway's vectors (a wrapper, so that operators work alike for every compiler and
// that a float can stand where a register is expected).
//
// Include it in a file that Highway's foreach_target.h includes once per target; all names land in
// that target's namespace (base/core-inl.h). Arithmetic is not fused: what a core template computes
// differs between targets only by exp and log (about 1 unit in the last place).
// Scalable vectors (SVE, RVV) cannot be members of a struct: files that use Vf disable them, see
// LOBELIA_DISABLED_TARGETS.
#if defined(LOBELIA_BASE_SIMD_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_BASE_SIMD_INL_H_
#undef LOBELIA_BASE_SIMD_INL_H_
#else
#define LOBELIA_BASE_SIMD_INL_H_
#endif

#include <cstdint>
#include <limits>

#include "hwy/contrib/math/math-inl.h"
#include "hwy/highway.h"
#include "lobelia/base/core-inl.h"

LOBELIA_CORE_BEGIN

namespace hn = hwy::HWY_NAMESPACE;
// At most 16 lanes: as many as a packet of rays has.
using Df = hn::CappedTag<float, 16>;
using Di = hn::RebindToSigned<Df>;
inline constexpr size_t kLanes = hn::MaxLanes(Df());

struct Mf {
  hn::Mask<Df> m;
  friend HWY_INLINE Mf operator&(Mf a, Mf b) { return {hn::And(a.m, b.m)}; }
  friend HWY_INLINE Mf operator|(Mf a, Mf b) { return {hn::Or(a.m, b.m)}; }
  friend HWY_INLINE Mf operator&&(Mf a, Mf b) { return a & b; }
  friend HWY_INLINE Mf operator||(Mf a, Mf b) { return a | b; }
  friend HWY_INLINE Mf operator!(Mf a) { return {hn::Not(a.m)}; }
};

struct Vf {
  hn::Vec<Df> v;
  Vf() = default;
  HWY_INLINE Vf(hn::Vec<Df> raw) : v(raw) {}       // NOLINT: the wrapper is transparent
  HWY_INLINE Vf(float s) : v(hn::Set(Df(), s)) {}  // NOLINT: constants of templates over F
  static HWY_INLINE Vf load(const float* aligned) { return hn::Load(Df(), aligned); }
  HWY_INLINE void store(float* aligned) const { hn::Store(v, Df(), aligned); }
  friend HWY_INLINE Vf operator+(Vf a, Vf b) { return hn::Add(a.v, b.v); }
  friend HWY_INLINE Vf operator-(Vf a, Vf b) { return hn::Sub(a.v, b.v); }
  friend HWY_INLINE Vf operator*(Vf a, Vf b) { return hn::Mul(a.v, b.v); }
  friend HWY_INLINE Vf operator/(Vf a, Vf b) { return hn::Div(a.v, b.v); }
  friend HWY_INLINE Vf operator-(Vf a) { return hn::Neg(a.v); }
  HWY_INLINE Vf& operator+=(Vf b) { return *this = *this + b; }
  HWY_INLINE Vf& operator-=(Vf b) { return *this = *this - b; }
  HWY_INLINE Vf& operator*=(Vf b) { return *this = *this * b; }
  HWY_INLINE Vf& operator/=(Vf b) { return *this = *this / b; }
  friend HWY_INLINE Mf operator<(Vf a, Vf b) { return {hn::Lt(a.v, b.v)}; }
  friend HWY_INLINE Mf operator<=(Vf a, Vf b) { return {hn::Le(a.v, b.v)}; }
  friend HWY_INLINE Mf operator>(Vf a, Vf b) { return {hn::Gt(a.v, b.v)}; }
  friend HWY_INLINE Mf operator>=(Vf a, Vf b) { return {hn::Ge(a.v, b.v)}; }
  friend HWY_INLINE Mf operator==(Vf a, Vf b) { return {hn::Eq(a.v, b.v)}; }
  friend HWY_INLINE Mf operator!=(Vf a, Vf b) { return {hn::Ne(a.v, b.v)}; }
};

HWY_INLINE Vf select(Mf m, Vf a, Vf b) { return hn::IfThenElse(m.m, a.v, b.v); }
// As the scalar twins: the second operand where one is NaN.
HWY_INLINE Vf min(Vf a, Vf b) { return select(a < b, a, b); }
HWY_INLINE Vf max(Vf a, Vf b) { return select(a > b, a, b); }
HWY_INLINE Vf abs(Vf a) { return hn::Abs(a.v); }
HWY_INLINE Vf sqrt(Vf a) { return hn::Sqrt(a.v); }
HWY_INLINE Vf floor(Vf a) { return hn::Floor(a.v); }
inline constexpr float kInfinityF = std::numeric_limits<float>::infinity();
// 1 unit in the last place; 0 below about -104, infinite above 88.7.
HWY_INLINE Vf exp(Vf a) {
  return select(a > Vf(88.72283f), Vf(kInfinityF), Vf(hn::Exp(Df(), a.v)));
}
// Positive numbers; log(0) is -infinity.
HWY_INLINE Vf log(Vf a) { return select(a == Vf(0.f), Vf(-kInfinityF), Vf(hn::Log(Df(), a.v))); }

HWY_INLINE bool any(Mf m) { return !hn::AllFalse(Df(), m.m); }
HWY_INLINE bool all(Mf m) { return hn::AllTrue(Df(), m.m); }
// Bit i is lane i.
HWY_INLINE uint32_t maskBits(Mf m) {
  uint8_t bytes[8] = {};
  hn::StoreMaskBits(Df(), m.m, bytes);
  return static_cast<uint32_t>(bytes[0] | (bytes[1] << 8));
}
HWY_INLINE Mf maskFromBits(uint32_t bits) {
  const uint8_t bytes[8] = {static_cast<uint8_t>(bits), static_cast<uint8_t>(bits >> 8)};
  return {hn::LoadMaskBits(Df(), bytes)};
}
// base[i] of each lane, i an index held as a whole number.
HWY_INLINE Vf gather(const float* base, Vf index) {
  return hn::GatherIndex(Df(), base, hn::ConvertTo(Di(), index.v));
}
HWY_INLINE bool all(bool m) { return m; }

LOBELIA_CORE_END

#endif  // per-target include guard
