// Bounds of the light that the items of one node send over the items of another, as templates over
// the number type: pairs of nodes side by side in registers, or one pair in floats. A point is a
// node of one item.
//
// Value of a pair (x, y), summed over the lights y of node q, at any receiver x of node p:
//   light(y, w) receiver(x, w) / d^2, w the direction from x to y;
//   light: cosine amplitude * [n.-w]+ (diffuse), Gaussian where n.-w > 0 (glossy), both
//   (spherical), intensity (omni); irradiance without 1 / d^2 along a direction of its own
//   (directional);
//   receiver: cosine amplitude * [n.w]+ (diffuse), Gaussian where n.w > 0 (glossy).
//
// [P000 section 4.2], corrected: the upper bound takes the smallest angles with the smallest
// sharpness, the sum of all amplitudes and the smallest distance; the lower bound the opposite of
// each; lobes' angles reach pi. Our glossy lobes contain their cosine, so that only the side
// remains of it. A visibility of 1 is assumed.
//
// Past the paper (BoundForm::tight): a Gaussian's amplitude and sharpness go together, so that it
// is also bounded by its energy times the largest (smallest) von Mises-Fisher density of a
// sharpness in the node's range; angles are also bounded by the box of all differences of places,
// as [Walter05 section 4.1] has it for cosines, and distances by the boxes.
#if defined(LOBELIA_GATHER_NODE_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_NODE_BOUNDS_INL_H_
#undef LOBELIA_GATHER_NODE_BOUNDS_INL_H_
#else
#define LOBELIA_GATHER_NODE_BOUNDS_INL_H_
#endif

#include "lobelia/gather/node_bounds.h"
#include "lobelia/lobes/kernels-inl.h"

LOBELIA_CORE_BEGIN

namespace g = ::lobelia::gather;

using g::kBoundInfinity;
// Room for rounding: of angles in radians (their sine), of values.
inline constexpr float kAngleRoom = 1e-6f, kValueRoom = 3e-5f;

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

// What there is between two nodes.
template <class F>
class NodeGap {
 public:
  NodeGap(const BoundSide<F>& p, const BoundSide<F>& q, bool tight) : tight_(tight) {
    const V3<F> d = q.centre - p.centre;
    const F distance = sqrt(dot(d, d)), radii = p.radius + q.radius;
    inverse_ = F(1.f) / max(distance, F(1e-30f));
    w_ = d * inverse_;
    lo_ = q.lo - p.hi, hi_ = q.hi - p.lo;
    const F sine = radii * inverse_ + F(kAngleRoom);
    spread_ =
        choose(sine < F(1.f), Angle<F>{sqrt(max(F(1.f) - sine * sine, F(0.f))), min(sine, F(1.f))},
               Angle<F>{F(-1.f), F(0.f)});
    const V3<F> near{max(max(lo_.x, F(0.f) - hi_.x), F(0.f)),
                     max(max(lo_.y, F(0.f) - hi_.y), F(0.f)),
                     max(max(lo_.z, F(0.f) - hi_.z), F(0.f))};
    const F apart = max(distance - radii, F(0.f));
    leastSquaredDistance_ = max(dot(near, near), apart * apart);
    const F most = distance + radii;
    mostSquaredDistance_ = most * most;
    if (!tight) return;
    const V3<F> far{max(abs(lo_.x), abs(hi_.x)), max(abs(lo_.y), abs(hi_.y)),
                    max(abs(lo_.z), abs(hi_.z))};
    mostSquaredDistance_ = min(mostSquaredDistance_, dot(far, far));
    // Where the boxes meet, or nearly, their directions are all directions.
    separate_ = dot(near, near) > F(1e-10f) * dot(far, far);
  }

  // Angles between any direction of a cone and any direction from p to q, or of `back` from q to p.
  struct Range {
    Angle<F> least, most;
  };
  Range angles(V3<F> axis, Angle<F> cone, bool back) const {
    if (back) axis = axis * F(-1.f);
    const V3<F> c{axis.y * w_.z - axis.z * w_.y, axis.z * w_.x - axis.x * w_.z,
                  axis.x * w_.y - axis.y * w_.x};
    const Angle<F> middle{dot(axis, w_), sqrt(dot(c, c))};
    Range range{middle - spread_, middle + spread_};
    if (tight_) narrow(axis, &range);
    return {range.least - cone, range.most + cone};
  }

  V3<F> direction() const { return w_; }
  F inverseSquare() const { return inverse_ * inverse_; }
  F mostInverseSquare() const {
    return select(leastSquaredDistance_ > F(1e-36f), F(1.f) / max(leastSquaredDistance_, F(1e-36f)),
                  F(kBoundInfinity));
  }
  F leastInverseSquare() const { return F(1.f) / max(mostSquaredDistance_, F(1e-36f)); }

 private:
  // Angles of the box's directions to an axis, from the box's extents along it and across.
  void narrow(V3<F> axis, Range* range) const {
    const V3<F> middle = (lo_ + hi_) * F(0.5f), half = (hi_ - lo_) * F(0.5f);
    const F sign = select(axis.z < F(0.f), F(-1.f), F(1.f));  // frame: [Duff17]
    const F a = F(-1.f) / (sign + axis.z), b = axis.x * axis.y * a;
    const V3<F> s{F(1.f) + sign * axis.x * axis.x * a, sign * b, F(0.f) - sign * axis.x};
    const V3<F> t{b, sign + axis.y * axis.y * a, F(0.f) - axis.y};
    const auto extent = [&](V3<F> e) {
      return abs(e.x) * half.x + abs(e.y) * half.y + abs(e.z) * half.z;
    };
    const F x = abs(dot(s, middle)), y = abs(dot(t, middle)), z = dot(axis, middle);
    const F ex = extent(s), ey = extent(t), ez = extent(axis);
    const F nearX = max(x - ex, F(0.f)), nearY = max(y - ey, F(0.f));
    const F near = sqrt(nearX * nearX + nearY * nearY);
    const F far = sqrt(sqr(x + ex) + sqr(y + ey));
    const F high = z + ez, low = z - ez;
    const Angle<F> room{F(1.f), F(kAngleRoom)};
    const Angle<F> least = angleOf(select(high > F(0.f), near, far), high) - room;
    const Angle<F> most = angleOf(select(low > F(0.f), far, near), low) + room;
    range->least = choose(separate_, larger(range->least, least), range->least);
    range->most = choose(separate_, smaller(range->most, most), range->most);
  }
  static Angle<F> angleOf(F across, F along) {
    const F l = F(1.f) / max(sqrt(across * across + along * along), F(1e-30f));
    return {along * l, across * l};
  }

  const bool tight_;
  V3<F> w_, lo_, hi_;
  Angle<F> spread_;
  F inverse_, leastSquaredDistance_, mostSquaredDistance_;
  decltype(F() < F()) separate_ = F(0.f) < F(0.f);
};

// The value of an interaction's factor: at the representatives, and its bounds.
template <class F>
struct Factor {
  F value, upper, lower;
};

// 1 / integral over the sphere.
template <class F>
LOBELIA_HD F inverseIntegral(F sharpness) {
  return F(1.f) / sgIntegral(sharpness);
}

// Largest von Mises-Fisher density of a sharpness in [least, most] where 1 - cosine is t. With its
// maximum inside, by k / (1 - e^-2k) <= k + 1/2, which has its own at 1/t - 1/2; that is A3(k) =
// cosine but for the exponential.
template <class F>
LOBELIA_HD F largestDensity(F least, F most, F t, F atLeast, F atMost) {
  const F peak = min(max(F(1.f) / max(t, F(1e-12f)) - F(0.5f), least), most);
  const F inside = (peak + F(0.5f)) * exp(F(0.f) - peak * t) * F(0.5f / kSgPi);
  // 1 - A3(k) falls from 1 to 0, between 1/k - 2 / (e^2k - 1) <= 1/k and 1/(k + 1).
  const auto falls = t > F(1.f) / max(least, F(1.f)), rises = t < F(1.f) / (most + F(1.f));
  const F ends = max(atLeast, atMost);
  return select(falls || rises, min(ends, inside), inside);
}

// The Gaussians of a node, at angles of the directions in between.
template <class F>
Factor<F> gaussianFactor(const BoundSide<F>& side, const typename NodeGap<F>::Range& range, V3<F> w,
                         bool tight) {
  Factor<F> factor;
  factor.value =
      side.amount * inverseIntegral(side.sharpness) * gaussian(side.axis, side.sharpness, w);
  const F near = fall(range.least), far = fall(range.most);
  const F broad = exp(F(0.f) - side.leastSharpness * near);
  factor.upper = side.peak * broad;
  const F narrow = exp(F(0.f) - side.mostSharpness * far);
  factor.lower = side.leastPeak * narrow;
  if (!tight) return factor;
  const F least = inverseIntegral(side.leastSharpness), most = inverseIntegral(side.mostSharpness);
  const F density = largestDensity(side.leastSharpness, side.mostSharpness, near, broad * least,
                                   exp(F(0.f) - side.mostSharpness * near) * most);
  factor.upper = min(factor.upper, side.energy * density);
  factor.lower =
      max(factor.lower,
          side.leastEnergy * min(exp(F(0.f) - side.leastSharpness * far) * least, narrow * most));
  return factor;
}

// 1 where all, or any (upper), or the representative's directions leave on the normals' side.
template <class F>
Factor<F> sideFactor(const BoundSide<F>& side, const typename NodeGap<F>::Range& range, V3<F> w) {
  const F one(1.f), none(0.f);
  return {select(dot(side.n, w) > none, one, none), select(range.least.cosine > none, one, none),
          select(range.most.cosine > none, one, none)};
}

template <class F>
Factor<F> cosineFactor(const BoundSide<F>& side, const typename NodeGap<F>::Range& range, V3<F> w,
                       F amount, F least) {
  return {amount * max(dot(side.n, w), F(0.f)), side.cosine * max(range.least.cosine, F(0.f)),
          least * max(range.most.cosine, F(0.f))};
}

template <class F>
LOBELIA_HD Factor<F> operator*(Factor<F> a, Factor<F> b) {
  return {a.value * b.value, a.upper * b.upper, a.lower * b.lower};
}

// A node's lobes towards the directions in between. back: of the light's side. kCosine,
// kGaussian: what it has.
template <bool kCosine, bool kGaussian, class F>
Factor<F> lobeFactor(const BoundSide<F>& side, const NodeGap<F>& gap, bool back, bool tight) {
  const V3<F> w = back ? gap.direction() * F(-1.f) : gap.direction();
  const auto normals = gap.angles(side.normalAxis, side.normalAngle, back);
  Factor<F> factor{F(0.f), F(0.f), F(0.f)};
  if constexpr (kGaussian) {
    const auto axes = gap.angles(side.lobeAxis, side.lobeAngle, back);
    factor = gaussianFactor(side, axes, w, tight) * sideFactor(side, normals, w);
  }
  if constexpr (kCosine && !kGaussian)
    factor = cosineFactor(side, normals, w, side.amount, side.leastPeak);
  if constexpr (kCosine && kGaussian) {
    // Spherical lights; `amount` is a sum over lights of energies or, without Gaussians, cosines.
    const Factor<F> diffuse = cosineFactor(side, normals, w, side.cosine, F(0.f));
    factor.value = factor.value * side.energy / max(side.amount, F(1e-30f)) + diffuse.value;
    factor.upper += diffuse.upper;
    factor.lower = F(0.f);
  }
  return factor;
}

// The receivers' factor where light comes along directions of a cone (directional lights).
template <bool kGlossy, class F>
Factor<F> directionalFactor(const BoundSide<F>& p, const BoundSide<F>& q, bool tight) {
  const auto angles = [&](V3<F> axis, Angle<F> cone) {
    const V3<F> a = q.lobeAxis;
    const V3<F> c{axis.y * a.z - axis.z * a.y, axis.z * a.x - axis.x * a.z,
                  axis.x * a.y - axis.y * a.x};
    const Angle<F> middle{dot(axis, a), sqrt(dot(c, c))};
    const Angle<F> wide = cone + q.lobeAngle + Angle<F>{F(1.f), F(kAngleRoom)};
    return typename NodeGap<F>::Range{middle - wide, middle + wide};
  };
  const auto normals = angles(p.normalAxis, p.normalAngle);
  if constexpr (!kGlossy) return cosineFactor(p, normals, q.axis, p.amount, p.leastPeak);
  return gaussianFactor(p, angles(p.lobeAxis, p.lobeAngle), q.axis, tight) *
         sideFactor(p, normals, q.axis);
}

// Value at the representatives and bounds of what lights of node q, of one class, send over any
// receiver of node p. Upper bounds of nodes that meet are at least kBoundInfinity, unless they do
// not face each other.
template <g::LightClass kLight, bool kGlossy, class F>
Factor<F> pairBounds(const BoundSide<F>& p, const BoundSide<F>& q, g::BoundForm form) {
  const bool tight = form == g::BoundForm::tight;
  Factor<F> result;
  if constexpr (kLight == g::LightClass::directional) {
    result = directionalFactor<kGlossy>(p, q, tight);
    result = result * Factor<F>{q.cosine, q.cosine, q.cosine};
  } else {
    const NodeGap<F> gap(p, q, tight);
    Factor<F> light{q.cosine, q.cosine, q.cosine};
    if constexpr (kLight == g::LightClass::diffuse)
      light = lobeFactor<true, false>(q, gap, true, tight);
    if constexpr (kLight == g::LightClass::glossy)
      light = lobeFactor<false, true>(q, gap, true, tight);
    if constexpr (kLight == g::LightClass::spherical) {
      light = lobeFactor<true, true>(q, gap, true, tight);
      // The sphere's solid angle over its disc's area is at most 2 / d^2.
      light.upper *= F(2.f);
    }
    result = lobeFactor<!kGlossy, kGlossy>(p, gap, false, tight) * light;
    const F far = gap.leastInverseSquare();
    result.value *= gap.inverseSquare();
    result.lower *= far;
    const F near = gap.mostInverseSquare();
    result.upper =
        select(result.upper > F(0.f), min(result.upper * near, F(kBoundInfinity)), F(0.f));
    result.upper =
        select(near >= F(kBoundInfinity) && result.upper > F(0.f), F(kBoundInfinity), result.upper);
  }
  result.upper *= F(1.f + kValueRoom);
  result.lower *= F(1.f - kValueRoom);
  return result;
}

LOBELIA_CORE_END

#endif  // per-target include guard
