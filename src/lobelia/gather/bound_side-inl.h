// A node of lights or of receivers unpacked for kernels (trees/bound_node.h), and angles by their
// sines and cosines: templates over the number type.
#if defined(LOBELIA_GATHER_BOUND_SIDE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_BOUND_SIDE_INL_H_
#undef LOBELIA_GATHER_BOUND_SIDE_INL_H_
#else
#define LOBELIA_GATHER_BOUND_SIDE_INL_H_
#endif

#include "lobelia/base/core-inl.h"
#include "lobelia/trees/bound_node.h"

LOBELIA_CORE_BEGIN

// An angle in [0, pi].
template <class F>
struct Angle {
  F cosine, sine;
};
template <class F>
LOBELIA_HD Angle<F> choose(decltype(F() < F()) m, Angle<F> a, Angle<F> b) {
  return {select(m, a.cosine, b.cosine), select(m, a.sine, b.sine)};
}
template <class F>
LOBELIA_HD Angle<F> larger(Angle<F> a, Angle<F> b) {
  return choose(a.cosine < b.cosine, a, b);
}
template <class F>
LOBELIA_HD Angle<F> smaller(Angle<F> a, Angle<F> b) {
  return choose(a.cosine > b.cosine, a, b);
}
// At most pi.
template <class F>
LOBELIA_HD Angle<F> operator+(Angle<F> a, Angle<F> b) {
  const F sine = a.sine * b.cosine + a.cosine * b.sine;
  const F flat(-1.f);
  return choose(sine < F(0.f) || a.cosine <= flat || b.cosine <= flat, Angle<F>{flat, F(0.f)},
                Angle<F>{a.cosine * b.cosine - a.sine * b.sine, sine});
}
// At least 0.
template <class F>
LOBELIA_HD Angle<F> operator-(Angle<F> a, Angle<F> b) {
  const F sine = a.sine * b.cosine - a.cosine * b.sine;
  return choose(sine < F(0.f) || b.cosine <= F(-1.f), Angle<F>{F(1.f), F(0.f)},
                Angle<F>{a.cosine * b.cosine + a.sine * b.sine, sine});
}
// 1 - cosine, exact for small angles, too.
template <class F>
LOBELIA_HD F fall(Angle<F> a) {
  const F sharp = a.sine * a.sine / max(F(1.f) + a.cosine, F(0.5f));
  return select(a.cosine > F(0.f), sharp, F(1.f) - a.cosine);
}

// A node unpacked; fields as trees::BoundNode.
template <class F>
struct BoundSide {
  V3<F> lo, hi, centre;
  F radius;
  V3<F> normalAxis, lobeAxis;
  Angle<F> normalAngle, lobeAngle;
  F leastSharpness, mostSharpness;
  F cosine, peak, energy, leastPeak, leastEnergy;
  V3<F> n, axis;
  F sharpness, amount;
};

// Octahedral coordinates (lights/virtual_lights.h) in [-1, 1] to the unit vector.
template <class F>
LOBELIA_HD V3<F> octahedral(F u, F v) {
  const F z = F(1.f) - abs(u) - abs(v), fold = max(F(0.f) - z, F(0.f));
  const V3<F> d{u - select(u < F(0.f), F(0.f) - fold, fold),
                v - select(v < F(0.f), F(0.f) - fold, fold), z};
  return d * (F(1.f) / sqrt(dot(d, d)));
}

// Of a cone, from the sine of its half-angle's half.
template <class F>
LOBELIA_HD Angle<F> angleOfHalfSine(F s) {
  return {F(1.f) - F(2.f) * s * s, F(2.f) * s * sqrt(max(F(1.f) - s * s, F(0.f)))};
}

// Fields of a node as floats, to be set side by side for registers.
inline constexpr size_t kSideFields = 29;
inline void unpack(const trees::BoundNode& node, float* out, size_t stride) {
  const auto put = [&](float value) {
    *out = value;
    out += stride;
  };
  const auto code = [&](uint32_t c) {
    put(static_cast<float>(static_cast<int16_t>(c & 0xffff)) * (1 / 32767.f));
    put(static_cast<float>(static_cast<int16_t>(c >> 16)) * (1 / 32767.f));
  };
  for (const Vec3f* v : {&node.lo, &node.hi, &node.centre}) put(v->x), put(v->y), put(v->z);
  put(node.radius);
  for (const uint32_t c : {node.normalAxis, node.lobeAxis, node.n, node.axis}) code(c);
  put(static_cast<float>(node.normalAngle) * (1 / trees::kAngleCodes));
  put(static_cast<float>(node.lobeAngle) * (1 / trees::kAngleCodes));
  for (const float value :
       {node.leastSharpness, node.mostSharpness, node.cosine, node.peak, node.energy,
        node.leastPeak, node.leastEnergy, node.sharpness, node.amount})
    put(value);
}

// field(i): of those.
template <class F, class Field>
BoundSide<F> sideOf(const Field& field) {
  const auto vector = [&](size_t i) { return V3<F>{field(i), field(i + 1), field(i + 2)}; };
  const auto unit = [&](size_t i) { return octahedral(field(i), field(i + 1)); };
  BoundSide<F> side;
  side.lo = vector(0), side.hi = vector(3), side.centre = vector(6);
  side.radius = field(9);
  side.normalAxis = unit(10), side.lobeAxis = unit(12), side.n = unit(14), side.axis = unit(16);
  side.normalAngle = angleOfHalfSine(field(18)), side.lobeAngle = angleOfHalfSine(field(19));
  side.leastSharpness = field(20), side.mostSharpness = field(21);
  side.cosine = field(22), side.peak = field(23), side.energy = field(24);
  side.leastPeak = field(25), side.leastEnergy = field(26);
  side.sharpness = field(27), side.amount = field(28);
  return side;
}

LOBELIA_CORE_END

#endif  // per-target include guard
