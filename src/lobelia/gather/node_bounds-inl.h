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
// Colours: trees/bound_node.h.
//
// Shares of near lights (ReceiverPoint::nearDistance) are none of it: a pair may be worth less, so
// upper bounds hold, and lower ones only where nothing is near (--near-lights 0).
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

#include "lobelia/gather/bound_side-inl.h"
#include "lobelia/gather/node_bounds.h"
#include "lobelia/lobes/kernels-inl.h"

LOBELIA_CORE_BEGIN

namespace g = ::lobelia::gather;

using g::kBoundInfinity;
// Room for rounding: of angles in radians (their sine), of values.
inline constexpr float kAngleRoom = 1e-6f, kValueRoom = 3e-5f;

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
    // Fluence is at most intensity over squared distance, wherever the light is in its sphere.
    if constexpr (kLight == g::LightClass::gaussian)
      light = lobeFactor<true, true>(q, gap, true, tight);
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
