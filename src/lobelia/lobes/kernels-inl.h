// Spherical Gaussians over a number type F (base/core-inl.h): the forms that scalar code and the
// SIMD gather share. Formulas, their algebra and their sources: docs/lobes.md.
#if defined(LOBELIA_LOBES_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_LOBES_KERNELS_INL_H_
#undef LOBELIA_LOBES_KERNELS_INL_H_
#else
#define LOBELIA_LOBES_KERNELS_INL_H_
#endif

#include "lobelia/base/core-inl.h"

LOBELIA_CORE_BEGIN

inline constexpr float kSgPi = 3.14159265358979323846f;
inline constexpr float kSgInvSqrtPi = 0.56418958354775628695f;

// (1 - e^-x)/x for x >= 0, without cancellation: relative error below 3e-7.
template <class F>
LOBELIA_HD F expRatio(F x) {
  // Beyond, 1 - e^-x rounds to 1: the same bits without the work.
  if (!any(x < F(18.f))) return F(1.f) / x;
  // Taylor to x^7 below 1/2; above, 1 - e^-x loses at most two bits.
  const F series =
      F(1.f) +
      x * (F(-1 / 2.f) +
           x * (F(1 / 6.f) +
                x * (F(-1 / 24.f) + x * (F(1 / 120.f) + x * (F(-1 / 720.f) + x * F(1 / 5040.f))))));
  const F safe = max(x, F(0.5f));
  return select(x < F(0.5f), series, (F(1.f) - exp(F(0.f) - safe)) / safe);
}

// Complementary error function for x >= 0 [Abramowitz and Stegun 7.1.26]: absolute error 1.5e-7.
template <class F>
LOBELIA_HD F erfcPositive(F x) {
  const F t = F(1.f) / (F(1.f) + F(0.3275911f) * x);
  const F p = t * (F(0.254829592f) +
                   t * (F(-0.284496736f) +
                        t * (F(1.421413741f) + t * (F(-1.453152027f) + t * F(1.061405429f)))));
  return p * exp(F(0.f) - x * x);
}
template <class F>
LOBELIA_HD F erfcAny(F x) {
  const F e = erfcPositive(abs(x));
  return select(x < F(0.f), F(2.f) - e, e);
}
// erf(x)/x for x >= 0, relative error below 1e-6 (the Taylor series below 1/2).
template <class F>
LOBELIA_HD F erfRatio(F x) {
  const F q = x * x;
  const F series =
      F(2 * kSgInvSqrtPi) *
      (F(1.f) +
       q * (F(-1 / 3.f) +
            q * (F(1 / 10.f) + q * (F(-1 / 42.f) + q * (F(1 / 216.f) + q * F(-1 / 1320.f))))));
  const F safe = max(x, F(0.5f));
  return select(x < F(0.5f), series, (F(1.f) - erfcPositive(safe)) / safe);
}

// exp(sharpness (axis.w - 1)) of unit vectors: axis.w - 1 = -|axis - w|^2 / 2 has no cancellation.
template <class F>
LOBELIA_HD F gaussian(V3<F> axis, F sharpness, V3<F> w) {
  const V3<F> d = axis - w;
  return exp(F(-0.5f) * sharpness * dot(d, d));
}

// A = 2 pi (1 - e^(-2 sharpness)) / sharpness: integral over the sphere.
template <class F>
LOBELIA_HD F sgIntegral(F sharpness) {
  return F(4 * kSgPi) * expRatio(sharpness + sharpness);
}

// Integral of the product of two Gaussians with unit amplitudes: e^g A(|v|), v = l1 a1 + l2 a2,
// g = |v| - l1 - l2 = -l1 l2 |a1 - a2|^2 / (|v| + l1 + l2).
template <class F>
LOBELIA_HD F sgProductIntegral(V3<F> axis1, F sharpness1, V3<F> axis2, F sharpness2) {
  const V3<F> v = axis1 * sharpness1 + axis2 * sharpness2;
  const V3<F> d = axis1 - axis2;
  const F length = sqrt(dot(v, v));
  const F sum = max(length + sharpness1 + sharpness2, F(1e-30f));
  return exp(F(0.f) - sharpness1 * sharpness2 * dot(d, d) / sum) * sgIntegral(length);
}

// Mean of the cosine to the axis, coth s - 1/s.
template <class F>
LOBELIA_HD F sgMeanResultant(F sharpness) {
  const F s2 = sharpness * sharpness;
  const F series = sharpness * (F(1 / 3.f) + s2 * (F(-1 / 45.f) + s2 * F(2 / 945.f)));
  const F safe = max(sharpness, F(0.5f)), e = exp(F(-2.f) * safe);
  return select(sharpness < F(0.5f), series, (F(1.f) + e) / (F(1.f) - e) - F(1.f) / safe);
}

// Integral over the hemisphere whose normal is at the cosine c to the axis [Tokuyoshi22]; absolute
// error at most 0.0044 A.
template <class F>
LOBELIA_HD F sgHemisphereIntegral(F c, F sharpness) {
  const F l = sharpness;
  // sqrt first: the square of the numerator would overflow.
  const F s =
      l * sqrt((F(0.5f) * l + F(0.65173288f)) / ((l + F(1.34182800f)) * l + F(7.22166878f)));
  // erf(s c)/erf(s) with both divided by s.
  const F ratio = c * erfRatio(s * abs(c)) / erfRatio(s);
  const F upper = F(0.5f) + F(0.5f) * ratio;
  const F e = exp(F(0.f) - l);
  return F(2 * kSgPi) * expRatio(l) * (e + (F(1.f) - e) * upper);
}

// The same times the clamped cosine to the normal [Tokuyoshi24]; absolute error at most 0.0012 A.
template <class F>
LOBELIA_HD F sgCosineIntegral(F c, F sharpness) {
  const F l = sharpness;
  const F t = l * sqrt(F(0.5f) * ((l + F(2.73608316f)) * l + F(17.0212982f)) /
                       (((l + F(4.01008267f)) * l + F(15.2191561f)) * l + F(76.0878963f)));
  const F cc = max(F(-1.f), min(c, F(1.f)));
  const F y = t * t * (F(1.f) - cc * cc);
  // -expm1(-y)/t = t (1 - c^2) (1 - e^-y)/y: no division by a small t.
  const F edge =
      t * (F(1.f) - cc * cc) * expRatio(y) * exp(F(0.f) - t * t * cc * cc) * F(0.5f * kSgInvSqrtPi);
  const F f = F(0.5f) * (cc * erfcAny(F(0.f) - t * cc) + erfcPositive(t)) + edge;
  const F e = exp(F(0.f) - l);
  // Integrals with the normal along the axis (up) and against it (lo), over 2 pi.
  const F safe = max(l, F(0.5f));
  const F ratio = expRatio(safe);
  const F up =
      select(l < F(0.5f), F(0.5f) + l * (F(-1 / 6.f) + l * (F(1 / 24.f) + l * F(-1 / 120.f))),
             (F(1.f) - ratio) / safe);
  const F lo =
      e * select(l < F(0.5f), F(0.5f) + l * (F(-1 / 3.f) + l * (F(1 / 8.f) + l * F(-1 / 30.f))),
                 (ratio - exp(F(0.f) - safe)) / safe);
  return F(2 * kSgPi) * (lo + (up - lo) * max(F(0.f), min(f, F(1.f))));
}

// Does the plane across the normal cut through the Gaussian, less than 2.8 standard deviations from
// its axis? If not, the clamp changes the mean cosine by less than 3e-4, the horizon cuts off 0.24
// %.
template <class F>
LOBELIA_HD auto sgCutByHorizon(F c, F sharpness) {
  return (c * c * sharpness < F(8.f)) | (sharpness < F(12.f));
}

// Mean of the clamped cosine, and the share above the horizon: sgCosineIntegral() and
// sgHemisphereIntegral() over A. Where no lane has its Gaussian cut by the horizon, which is so for
// most lights at most points, the work is left out.
template <class F>
LOBELIA_HD F sgCosineMean(F c, F sharpness) {
  const auto cut = sgCutByHorizon(c, sharpness);
  const F whole = max(c, F(0.f)) * (F(1.f) - F(1.f) / sharpness);
  if (!any(cut)) return whole;
  return select(cut, sgCosineIntegral(c, sharpness) / sgIntegral(sharpness), whole);
}
template <class F>
LOBELIA_HD F sgShareAbove(F c, F sharpness) {
  const auto cut = sgCutByHorizon(c, sharpness);
  const F whole = select(c > F(0.f), F(1.f), F(0.f));
  if (!any(cut)) return whole;
  return select(cut, min(sgHemisphereIntegral(c, sharpness) / sgIntegral(sharpness), F(1.f)),
                whole);
}

LOBELIA_CORE_END

#endif  // per-target include guard
