// The numerical core's number types: one source for float and for SIMD registers.
//
// A core header (NAME-inl.h) holds templates over a number type F. It is compiled
//  - once per SIMD target inside a file that Highway's foreach_target.h includes again and again
//    (namespace lobelia::N_AVX3 and so on; F = Vf, a register of floats, base/simd-inl.h), and
//  - once for scalar code (namespace lobelia::core; F = float), which a GPU compiler can read too.
// Core headers keep to: + - * / and comparisons on F, select(mask, a, b), min, max, abs, sqrt, exp,
// log, floor, fma-free arithmetic, V3<F>; branches are selects where both sides are cheap. They are
// never included by public headers (a public header must mean the same in every file).
#if defined(LOBELIA_BASE_CORE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_BASE_CORE_INL_H_
#undef LOBELIA_BASE_CORE_INL_H_
#else
#define LOBELIA_BASE_CORE_INL_H_
#endif

#include <algorithm>
#include <cmath>

#ifndef LOBELIA_CORE_BEGIN
#ifdef HWY_TARGET_INCLUDE
#include "hwy/highway.h"
#define LOBELIA_CORE_BEGIN \
  HWY_BEFORE_NAMESPACE();  \
  namespace lobelia {      \
  namespace HWY_NAMESPACE {
#define LOBELIA_CORE_END \
  }                      \
  }                      \
  HWY_AFTER_NAMESPACE();
#else
#define LOBELIA_CORE_BEGIN \
  namespace lobelia {      \
  namespace core {
#define LOBELIA_CORE_END \
  }                      \
  }
#endif
#if defined(__CUDACC__)
#define LOBELIA_HD __host__ __device__ inline
#else
#define LOBELIA_HD inline
#endif
#endif

LOBELIA_CORE_BEGIN

// Scalar twins of the SIMD functions (base/simd-inl.h overloads them for registers).
LOBELIA_HD float select(bool m, float a, float b) { return m ? a : b; }
LOBELIA_HD bool any(bool m) { return m; }
LOBELIA_HD float min(float a, float b) { return a < b ? a : b; }
LOBELIA_HD float max(float a, float b) { return a > b ? a : b; }
LOBELIA_HD float abs(float a) { return a < 0 ? -a : a; }
LOBELIA_HD float sqrt(float a) { return ::sqrtf(a); }
LOBELIA_HD float floor(float a) { return ::floorf(a); }
LOBELIA_HD float exp(float a) { return ::expf(a); }
LOBELIA_HD float log(float a) { return ::logf(a); }
LOBELIA_HD float gather(const float* base, float index) { return base[static_cast<int>(index)]; }

template <class F>
struct V3 {
  F x, y, z;
};
template <class F>
LOBELIA_HD V3<F> operator+(V3<F> a, V3<F> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
LOBELIA_HD V3<F> operator-(V3<F> a, V3<F> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F>
LOBELIA_HD V3<F> operator*(V3<F> a, F s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class F>
LOBELIA_HD V3<F> operator*(V3<F> a, V3<F> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class F>
LOBELIA_HD F dot(V3<F> a, V3<F> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F>
LOBELIA_HD F sqr(F a) {
  return a * a;
}

LOBELIA_CORE_END

#endif  // per-target include guard
