// Light of visible pairs of receiver points and spherical lights [Hasan09 eq. 5]:
//   power / (pi r^2) * integral over directions l from x of f(x; wo, l) cos * f(p; -l, wi) *
//   indicator,
// by a few directions per pair, in registers of points for one light.
//
// Directions. A base that covers all that counts: points of the disc, far away; the cone around the
// sphere, nearer than two radii; the hemisphere below the disc's plane, inside of the sphere. Where
// the cone is wide against the lobes, half of the directions (at most) come from the products of
// the two ends' Gaussians instead, or from the micro-normals of either end, weighted by the balance
// heuristic as one mixture: the density never falls below half of the base's.
//
// Deviations from the paper, each a setting: the indicator is whether l meets the disc in the
// tangent plane where it lies on the surface (SphereShading::planar; spherical_coverage.h), for
// which the paper has the cosine at the light; directions by the paper's three strategies are in
// spherical_paper.cpp. The number of directions follows the overlap of lobes and cone, which the
// paper wishes for in section 4. Inside of the sphere the paper's cone jumps to the hemisphere of
// n_x; with the cosine as indicator it opens as acos(-sqrt(1 - (d/r)^2)), which is continuous in d;
// the planar indicator does not depend on the cone. Lights show their lit side only (unless they
// transmit), where the cosine would let a strip behind the plane through.
#if defined(LOBELIA_GATHER_SPHERICAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_SPHERICAL_INL_H_
#undef LOBELIA_GATHER_SPHERICAL_INL_H_
#else
#define LOBELIA_GATHER_SPHERICAL_INL_H_
#endif

#include "lobelia/gather/shading-inl.h"
#include "lobelia/gather/spherical_paper.h"

LOBELIA_CORE_BEGIN

HWY_INLINE Vf fraction(Vf x) { return x - floor(x); }
HWY_INLINE V3<Vf> select(Mf m, V3<Vf> a, V3<Vf> b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

// Direction at an angle to an axis and at an azimuth around it [Duff17].
HWY_INLINE V3<Vf> aroundAxis(V3<Vf> axis, Vf oneMinusCos, Vf cosPhi, Vf sinPhi) {
  const Vf sign = select(axis.z < Vf(0.f), Vf(-1.f), Vf(1.f));
  const Vf a = Vf(-1.f) / (sign + axis.z), b = axis.x * axis.y * a;
  const V3<Vf> s{Vf(1.f) + sign * axis.x * axis.x * a, sign * b, Vf(0.f) - sign * axis.x};
  const V3<Vf> t{b, sign + axis.y * axis.y * a, Vf(0.f) - axis.y};
  const Vf sine = sqrt(max(oneMinusCos * (Vf(2.f) - oneMinusCos), Vf(0.f)));
  return axis * (Vf(1.f) - oneMinusCos) + s * (sine * cosPhi) + t * (sine * sinPhi);
}

// von Mises-Fisher density with exp(-sharpness |l - axis|^2 / 2).
HWY_INLINE Vf vmfDensity(V3<Vf> axis, Vf sharpness, V3<Vf> l) {
  return exp(Vf(-0.5f) * sharpness * squaredDistance(axis, l)) / sgIntegral(sharpness);
}

// Reflection by micro-normals of one lobe, for points of a register or for one light: drawn by the
// slopes of the micro-normal. Directions in the lobe's frame.
struct HalfVectorLobe {
  Distribution distribution;  // ggx or beckmann
  Vf alphaX, alphaY;
  V3<Vf> s, t, n;  // n on the side of w
  V3<Vf> w;        // the given direction

  HWY_INLINE void set(const V3<Vf>& s_, const V3<Vf>& t_, const V3<Vf>& n_, const V3<Vf>& local) {
    const Vf sign = select(local.z < Vf(0.f), Vf(-1.f), Vf(1.f));
    s = s_, t = t_, n = n_ * sign;
    w = {local.x, local.y, local.z * sign};
  }
  // World space.
  HWY_INLINE V3<Vf> sample(Vf u, Vf cosPhi, Vf sinPhi) const {
    const Vf rest = max(Vf(1.f) - u, Vf(1e-7f));
    const Vf r2 = distribution == Distribution::ggx ? u / rest : Vf(0.f) - log(rest);
    const Vf r = sqrt(max(r2, Vf(0.f)));
    const V3<Vf> h = unitVector(V3<Vf>{alphaX * r * cosPhi, alphaY * r * sinPhi, Vf(1.f)});
    const Vf cosine = dot(w, h);
    V3<Vf> l = h * (Vf(2.f) * cosine) - w;
    // A micro-normal that w does not see reflects nothing: no direction, which counts for nothing.
    l = l * select(cosine > Vf(0.f), Vf(1.f), Vf(0.f));
    return s * l.x + t * l.y + n * l.z;
  }
  HWY_INLINE Vf density(V3<Vf> world) const {
    const V3<Vf> l{dot(world, s), dot(world, t), dot(world, n)};
    const V3<Vf> h = unitVector(w + l);
    const Vf cosine = dot(w, h);
    const Vf d =
        microfacetDensity(distribution, alphaX, alphaY, h) * h.z / max(Vf(4.f) * cosine, Vf(1e-6f));
    return select((h.z > Vf(0.f)) & (cosine > Vf(0.f)), d, Vf(0.f));
  }
};
HWY_INLINE Distribution slopesOf(LobeType type, Distribution distribution) {
  return type != LobeType::ward && distribution == Distribution::ggx ? Distribution::ggx
                                                                     : Distribution::beckmann;
}

// What all directions of the points of a register to one light have in common.
class SphereView {
 public:
  SphereView(const g::Tile& tile, size_t stripIndex, size_t lane, const g::PreparedLight& light,
             const g::PreparedSphere& sphere, const SphereShading& shading)
      : tile_(tile),
        strip_(tile.strips[stripIndex]),
        sampling_(tile.sampling[stripIndex]),
        lane_(lane),
        sphere_(sphere),
        planar_(shading.indicator == SphereShading::Indicator::planar) {
    d_ = broadcast(light.p) - load(strip_.p, lane);
    d2_ = max(dot(d_, d_), Vf(1e-30f));
    direction_ = d_ * (Vf(1.f) / sqrt(d2_));
    n_ = broadcast(sphere.disc.n);
    const Vf height = dot(n_, d_);
    side_ = select(height > Vf(0.f), Vf(-1.f), Vf(1.f));  // -1: x lies behind the disc
    front_ = select(dot(load(strip_.ng, lane), d_) < Vf(0.f), Vf(-1.f), Vf(1.f));
    chooseBase();
    chooseLobes(shading);
  }

  Vf samples() const { return samples_; }

  // Direction k of each lane and its weight: indicator over density and number.
  HWY_INLINE V3<Vf> direction(int k, Vf* weight) const {
    const Vf index(static_cast<float>(k));
    const auto uniform = [&](size_t i, float step) {
      return fraction(Vf::load(sampling_.random[i] + lane_) + Vf(sphere_.random[i]) +
                      index * Vf(step));
    };
    // Additive recurrences of the plastic number, and of the golden ratio for the choice.
    const Vf u = uniform(0, 0.7548776662f), azimuth = uniform(1, 0.5698402910f);
    const Vf choice = uniform(2, 0.6180339887f);
    const Vf phi = azimuth * Vf(2 * kSgPi);
    const Vf cosPhi = hn::Cos(Df(), phi.v), sinPhi = hn::Sin(Df(), phi.v);
    V3<Vf> axis = direction_;
    Vf oneMinusCos = u * oneMinusCosMax_;
    axis = select(hemisphere_, n_ * (Vf(0.f) - side_), axis);
    Mf onDisc = disc_, byHalf = choice < Vf(0.f);
    if (mixed_) {
      const Mf byLobe = choice < share_;
      onDisc = onDisc & !byLobe;
      V3<Vf> lobeAxis = direction_;
      Vf sharpness(1.f), passed(0.f);
      for (int i = 0; i < lobeCount_; ++i) {
        const Mf next = choice >= share_ * passed;
        lobeAxis = select(next, axis_[i], lobeAxis);
        sharpness = select(next, sharpness_[i], sharpness);
        passed = passed + probability_[i];
      }
      byHalf = byLobe & (choice >= share_ * passed);
      // 1 - cos = -log(1 - u (1 - e^-2k)) / k
      const Vf t =
          Vf(0.f) -
          log(max(Vf(1.f) - u * (Vf(1.f) - exp(Vf(-2.f) * sharpness)), Vf(1e-30f))) / sharpness;
      axis = select(byLobe, lobeAxis, axis);
      oneMinusCos = select(byLobe, min(t, Vf(2.f)), oneMinusCos);
    }
    V3<Vf> l = direction_;
    if (!all(onDisc)) l = aroundAxis(axis, oneMinusCos, cosPhi, sinPhi);
    if (any(byHalf)) {
      const Mf byLight = byHalf & (choice >= share_ * (Vf(1.f) - lightHalfProbability_));
      if (sampling_.halfLobe >= 0) l = select(byHalf, receiverHalf_.sample(u, cosPhi, sinPhi), l);
      if (sphere_.halfLobe >= 0)
        l = select(byLight, lightHalf_.sample(u, cosPhi, sinPhi) * Vf(-1.f), l);
    }
    if (any(onDisc)) {
      const Vf radius = sqrt(u) * Vf(sphere_.radius);
      const V3<Vf> q = d_ + broadcast(sphere_.disc.s) * (radius * cosPhi) +
                       broadcast(sphere_.disc.t) * (radius * sinPhi);
      const Vf q2 = max(dot(q, q), Vf(1e-30f));
      l = select(onDisc, q * (Vf(1.f) / sqrt(q2)), l);
    }
    *weight = indicatorOverDensity(l, onDisc);
    return l;
  }

 private:
  static constexpr int kMaxLobeProducts = (g::kSphereGaussians + 1) * (g::kSphereGaussians + 1) - 1;

  void chooseBase() {
    const Vf r2(sphere_.squaredRadius);
    const Mf outside = d2_ > r2;
    const Vf s2 = min(r2 / d2_, Vf(1.f));
    const Vf cone = s2 / (Vf(1.f) + sqrt(max(Vf(1.f) - s2, Vf(0.f))));
    const Mf never = d2_ < Vf(0.f);
    if (planar_) {
      disc_ = d2_ > Vf(4.f) * r2;
      hemisphere_ = !outside;
      oneMinusCosMax_ = select(outside, cone, Vf(1.f));
    } else {
      disc_ = hemisphere_ = never;
      const Vf inside = Vf(1.f) + sqrt(max(Vf(1.f) - d2_ / r2, Vf(0.f)));
      oneMinusCosMax_ = select(outside, cone, inside);
    }
    solidAngle_ = oneMinusCosMax_ * Vf(2 * kSgPi);
  }

  // Products of the receiver's and the light's Gaussians, each with the part of its mass that lies
  // in the cone, roughly; and the number of directions.
  void chooseLobes(const SphereShading& shading) {
    lobeCount_ = 0;
    mixed_ = false;
    share_ = receiverHalfProbability_ = lightHalfProbability_ = Vf(0.f);
    Vf overlap = solidAngle_;
    const Vf sharpest = Vf::load(sampling_.sharpest + lane_) + Vf(sphere_.sharpest);
    // Every product is wider than this: where the cone is narrow against it, the base is best.
    if (any(sharpest * solidAngle_ > Vf(kNarrow * 2 * kSgPi))) weighLobes(&overlap);
    const Vf most(static_cast<float>(shading.maxSamples));
    // Where lobes are drawn their values differ from direction to direction, however small the
    // overlap is: as many directions as lobes have a share in them.
    const Vf wanted = most * max(overlap * Vf(0.5f / kSgPi), Vf(2.f) * share_);
    samples_ = max(min(floor(wanted + Vf(0.999f)), most), Vf(1.f));
  }

  void weighLobes(Vf* overlap) {
    const Vf cone = sqrt(Vf(2.f) * oneMinusCosMax_);  // its chord
    const Vf diffuseX = Vf::load(sampling_.diffuse + lane_);
    const bool halfX = sampling_.halfLobe >= 0, halfY = sphere_.halfLobe >= 0;
    Vf mass = diffuseX * Vf(sphere_.diffuse) * solidAngle_, useful(0.f);
    Vf spread = mass * solidAngle_;
    // Returns the mass for which directions of this lobe are of use.
    const auto weigh = [&](V3<Vf> axis, Vf sharpness, Vf amplitude, Vf exponent) {
      const Vf apart = max(sqrt(squaredDistance(axis, direction_)) - cone, Vf(0.f));
      const Vf whole = sgIntegral(sharpness), area = min(whole, solidAngle_);
      const Vf weight = amplitude * exp(exponent - Vf(0.5f) * sharpness * apart * apart) * area;
      mass = mass + weight;
      spread = spread + weight * area;
      // 0 where the cone is an eighth of the lobe, 1 from a half on.
      const Vf worth = (solidAngle_ / whole - Vf(kNarrow)) * Vf(1.f / (0.5f - kNarrow));
      return weight * min(max(worth, Vf(0.f)), Vf(1.f));
    };
    const auto add = [&](V3<Vf> axis, Vf sharpness, Vf weight) {
      axis_[lobeCount_] = axis, sharpness_[lobeCount_] = sharpness;
      probability_[lobeCount_++] = weight;
      useful = useful + weight;
    };
    Vf byReceiver(0.f), byLight(0.f);
    for (int j = 0; j < sphere_.gaussianCount; ++j) {
      const g::PreparedSphere::Gaussian& y = sphere_.gaussians[j];
      const V3<Vf> back = broadcast(-y.axis);  // as a function of the direction from x
      const Vf sharpness(y.sharpness), amplitude(y.amplitude);
      if (any(diffuseX > Vf(0.f))) {
        const Vf weight = weigh(back, sharpness, diffuseX * amplitude, Vf(0.f));
        halfY ? void(byLight = byLight + weight) : add(back, sharpness, weight);
      }
      for (size_t i = 0; i < strip_.gaussianCount; ++i) {
        const g::GaussianStrip& x = tile_.gaussians[strip_.firstGaussian + i];
        const V3<Vf> axisX = load(x.axis, lane_);
        const Vf sharpnessX = Vf::load(x.sharpness + lane_);
        const V3<Vf> v = axisX * sharpnessX + back * sharpness;
        const Vf length = sqrt(dot(v, v));
        const Vf sum = max(length + sharpnessX + sharpness, Vf(1e-20f));
        const V3<Vf> axis = v * (Vf(1.f) / max(length, Vf(1e-20f)));
        const Vf product = max(length, Vf(1e-3f));
        Vf weight = weigh(axis, product, Vf::load(x.amplitude + lane_) * amplitude,
                          Vf(0.f) - sharpnessX * sharpness * squaredDistance(axisX, back) / sum);
        // What is drawn exactly has a part: the product's shape is none of a Gaussian's there.
        const Vf part = weight * Vf(kExactPart);
        if (halfX) byReceiver = byReceiver + part, weight = weight - part;
        if (halfY) byLight = byLight + part, weight = weight - part;
        add(axis, product, weight);
      }
    }
    if (sphere_.diffuse > 0) {
      for (size_t i = 0; i < strip_.gaussianCount; ++i) {
        const g::GaussianStrip& x = tile_.gaussians[strip_.firstGaussian + i];
        const V3<Vf> axis = load(x.axis, lane_);
        const Vf sharpness = Vf::load(x.sharpness + lane_);
        const Vf weight =
            weigh(axis, sharpness, Vf::load(x.amplitude + lane_) * Vf(sphere_.diffuse), Vf(0.f));
        halfX ? void(byReceiver = byReceiver + weight) : add(axis, sharpness, weight);
      }
    }
    useful = useful + byReceiver + byLight;
    const Mf some = useful > Vf(1e-30f);
    if (any(some)) mixLobes(some, useful, mass, byReceiver, byLight);
    *overlap = select(mass > Vf(1e-30f), spread / max(mass, Vf(1e-30f)), solidAngle_);
  }

  void mixLobes(Mf some, Vf useful, Vf mass, Vf byReceiver, Vf byLight) {
    const Vf inverse = Vf(1.f) / max(useful, Vf(1e-30f));
    for (int i = 0; i < lobeCount_; ++i) probability_[i] = probability_[i] * inverse;
    receiverHalfProbability_ = byReceiver * inverse;
    lightHalfProbability_ = byLight * inverse;
    share_ = select(some, Vf(0.5f) * min(useful / max(mass, Vf(1e-30f)), Vf(1.f)), Vf(0.f));
    mixed_ = true;
    if (sampling_.halfLobe >= 0) {
      const g::LobeStrip& lobe =
          tile_.lobes[strip_.firstLobe + static_cast<size_t>(sampling_.halfLobe)];
      receiverHalf_.distribution = slopesOf(lobe.type, lobe.distribution);
      receiverHalf_.alphaX = Vf::load(lobe.alphaX + lane_);
      receiverHalf_.alphaY = Vf::load(lobe.alphaY + lane_);
      receiverHalf_.set(load(strip_.s, lane_), load(strip_.t, lane_), load(strip_.n, lane_),
                        load(strip_.wo, lane_));
    }
    if (sphere_.halfLobe >= 0) {
      const g::PreparedSphere::LightLobe& lobe = sphere_.lobes[sphere_.halfLobe];
      lightHalf_.distribution = slopesOf(lobe.lobe.type, lobe.lobe.distribution);
      lightHalf_.alphaX = Vf(lobe.lobe.alphaX), lightHalf_.alphaY = Vf(lobe.lobe.alphaY);
      lightHalf_.set(broadcast(lobe.frame.s), broadcast(lobe.frame.t), broadcast(lobe.frame.n),
                     broadcast(lobe.wi));
    }
  }

  HWY_INLINE Vf indicatorOverDensity(V3<Vf> l, Mf onDisc) const {
    const Vf cosLeave = (Vf(0.f) - dot(n_, l)) * side_;
    const Vf safe = max(cosLeave, Vf(1e-12f));
    // Where l meets the disc's plane, from the light.
    const Vf t = abs(dot(n_, d_)) / safe;
    const V3<Vf> hit = l * t - d_;
    const Mf below = cosLeave > Vf(0.f);
    const Mf onPlane = below & ((dot(hit, hit) <= Vf(sphere_.squaredRadius)) | onDisc);
    const Mf inCone = squaredDistance(l, direction_) <= Vf(2.00002f) * oneMinusCosMax_ + Vf(1e-12f);
    Vf density = select(hemisphere_, select(below, Vf(0.5f / kSgPi), Vf(0.f)),
                        select(inCone, Vf(1.f) / solidAngle_, Vf(0.f)));
    if (any(disc_)) {
      const Vf onArea = t * t / (safe * Vf(kSgPi * sphere_.squaredRadius));
      density = select(disc_, select(onPlane, onArea, Vf(0.f)), density);
    }
    if (mixed_) {
      Vf lobes(0.f);
      for (int i = 0; i < lobeCount_; ++i)
        lobes = lobes + probability_[i] * vmfDensity(axis_[i], sharpness_[i], l);
      if (sampling_.halfLobe >= 0)
        lobes = lobes + receiverHalfProbability_ * receiverHalf_.density(l);
      if (sphere_.halfLobe >= 0)
        lobes = lobes + lightHalfProbability_ * lightHalf_.density(l * Vf(-1.f));
      density = density * (Vf(1.f) - share_) + select(share_ > Vf(0.f), share_ * lobes, Vf(0.f));
    }
    Vf indicator;
    if (planar_) {
      indicator = select(onPlane, weightAt(hit), Vf(0.f));
      if (strip_.near) indicator = indicator * gatheredShare(strip_, lane_, t);
    } else {
      indicator = select(inCone, max(cosLeave, Vf(0.f)), Vf(0.f));
    }
    // Only what leaves on the side of the surface that the light's middle is on.
    const Mf above = dot(load(strip_.ng, lane_), l) * front_ > Vf(0.f);
    return select(above & (density > Vf(0.f)), indicator / (max(density, Vf(1e-30f)) * samples_),
                  Vf(0.f));
  }

  HWY_INLINE Vf weightAt(V3<Vf> hit) const {
    if (sphere_.whole) return Vf(1.f);
    const float scale = 0.5f * static_cast<float>(kDiscCells);
    const Vf inverse(scale / sphere_.radius), last(static_cast<float>(kDiscCells - 1));
    const auto cell = [&](Vec3f axis) {
      return min(max(floor(dot(hit, broadcast(axis)) * inverse + Vf(scale)), Vf(0.f)), last);
    };
    const Vf x = cell(sphere_.disc.s), y = cell(sphere_.disc.t);
    return lobelia::HWY_NAMESPACE::gather(sphere_.weights.data(),
                                          y * Vf(static_cast<float>(kDiscCells)) + x);
  }

  static constexpr float kNarrow = 0.125f, kExactPart = 0.25f;
  const g::Tile& tile_;
  const g::PointStrip& strip_;
  const g::SamplingStrip& sampling_;
  const size_t lane_;
  const g::PreparedSphere& sphere_;
  const bool planar_;
  V3<Vf> d_, direction_, n_;
  Vf d2_, side_, front_, oneMinusCosMax_, solidAngle_, samples_, share_;
  Mf disc_, hemisphere_;
  bool mixed_ = false;
  Vf receiverHalfProbability_, lightHalfProbability_;
  HalfVectorLobe receiverHalf_, lightHalf_;
  int lobeCount_ = 0;
  V3<Vf> axis_[kMaxLobeProducts];
  Vf sharpness_[kMaxLobeProducts], probability_[kMaxLobeProducts];
};

// Radiance that leaves the light along -l, per power and area.
HWY_INLINE V3<Vf> leavingRadiance(const g::PreparedSphere& sphere, V3<Vf> l) {
  V3<Vf> sum = splat(Vf(0.f));
  const V3<Vf> w = l * Vf(-1.f);
  for (int i = 0; i < sphere.lobeCount; ++i) {
    const g::PreparedSphere::LightLobe& lobe = sphere.lobes[i];
    const Lobe& f = lobe.lobe;
    LobeParameters<Vf> p;
    p.alphaX = Vf(f.alphaX), p.alphaY = Vf(f.alphaY);
    p.weight = broadcast(f.weight), p.eta = broadcast(f.eta), p.k = broadcast(f.k);
    p.parameters = broadcast(f.parameters), p.tint = broadcast(f.tint);
    p.sides = Vf(f.interface ? 2.f : f.twoSided ? 1.f : 0.f);
    const V3<Vf> local{dot(w, broadcast(lobe.frame.s)), dot(w, broadcast(lobe.frame.t)),
                       dot(w, broadcast(lobe.frame.n))};
    const CoatTable table{f.table, Vf(0.f)};
    const V3<Vf> value = evaluateLobe(LobeTags{f.type, f.distribution, f.fresnel, f.variant}, p,
                                      local, broadcast(lobe.wi), table);
    sum = sum + value * Vf(lobe.factor);
  }
  return sum;
}

// Directions wait here until there are as many as a block has lights; then the receivers' lobes are
// evaluated for all of them, kind by kind.
class SphereSamples {
 public:
  SphereSamples(const g::Tile& tile, const g::PointStrip& strip, size_t lane,
                const g::LightBlock& block, PairScratch* sums)
      : tile_(tile), strip_(strip), lane_(lane), block_(block), sums_(sums) {}

  HWY_INLINE void push(size_t pair, V3<Vf> l, Vf weight) {
    if (strip_.perturbed) weight = weight * bumpFactor(l);
    const size_t i = waiting_.count++;
    pair_[i] = pair;
    l.x.store(lX_[i].v), l.y.store(lY_[i].v), l.z.store(lZ_[i].v);
    weight.store(waiting_.factor[i].v);
    dot(l, load(strip_.s, lane_)).store(waiting_.wiX[i].v);
    dot(l, load(strip_.t, lane_)).store(waiting_.wiY[i].v);
    dot(l, load(strip_.n, lane_)).store(waiting_.wiZ[i].v);
    if (waiting_.count == g::kBlockLights) flush();
  }

  void flush() {
    addLobes(tile_, strip_, lane_, &waiting_);
    for (size_t i = 0; i < waiting_.count; ++i) {
      const size_t pair = pair_[i];
      const V3<Vf> l{Vf::load(lX_[i].v), Vf::load(lY_[i].v), Vf::load(lZ_[i].v)};
      const V3<Vf> light = leavingRadiance(*block_.spheres[sums_->light[pair]], l);
      const Vf weight = Vf::load(waiting_.factor[i].v);
      // 0 times what may overflow is 0.
      const Mf counts = weight > Vf(0.f);
      const auto addTo = [&](float* sum, const float* receiver, Vf leaving) {
        const Vf value = select(counts, Vf::load(receiver) * leaving * weight, Vf(0.f));
        (Vf::load(sum) + value).store(sum);
      };
      addTo(sums_->r[pair].v, waiting_.r[i].v, light.x);
      addTo(sums_->g[pair].v, waiting_.g[i].v, light.y);
      addTo(sums_->b[pair].v, waiting_.b[i].v, light.z);
    }
    waiting_.count = 0;
  }

 private:
  // bumpShadow() of bsdf/bsdf.h, and the agreement of the two normals.
  HWY_INLINE Vf bumpFactor(V3<Vf> l) const {
    const Vf c = dot(load(strip_.base, lane_), l);
    const Vf shadow = bumpShadowing(c, Vf::load(strip_.bumpAlpha2 + lane_));
    return select(c * dot(load(strip_.n, lane_), l) > Vf(0.f), shadow, Vf(0.f));
  }

  const g::Tile& tile_;
  const g::PointStrip& strip_;
  const size_t lane_;
  const g::LightBlock& block_;
  PairScratch* sums_;
  PairScratch waiting_;
  size_t pair_[g::kBlockLights];
  PairScratch::Lanes lX_[g::kBlockLights], lY_[g::kBlockLights], lZ_[g::kBlockLights];
};

// The pairs' values but for the lights' power over area, as r, g, b, and a factor.
void sphericalPairs(const g::Tile& tile, size_t stripIndex, size_t lane, const g::LightBlock& block,
                    PairScratch* pairs) {
  const g::PointStrip& strip = tile.strips[stripIndex];
  for (size_t i = 0; i < pairs->count; ++i) {
    Vf factor(1.f);
    // With the cosine no direction has a place of its own on the disc.
    if (strip.near && block.sphereShading.indicator == SphereShading::Indicator::cosine) {
      const Vf d2 =
          squaredDistance(broadcast(block.lights[pairs->light[i]].p), load(strip.p, lane));
      factor = gatheredShare(strip, lane, sqrt(d2));
    }
    factor.store(pairs->factor[i].v);
    for (float* sum : {pairs->r[i].v, pairs->g[i].v, pairs->b[i].v}) Vf(0.f).store(sum);
  }
  if (block.sphereShading.sampling != SphereShading::Sampling::product) {
    for (size_t i = 0; i < pairs->count; ++i)
      for (uint32_t bits = pairs->mask[i]; bits != 0; bits &= bits - 1) {
        const size_t k = static_cast<size_t>(__builtin_ctz(bits));
        const Rgb value = g::evaluateAsPrinted(tile, stripIndex, lane + k, block, pairs->light[i]);
        pairs->r[i].v[k] = value.x, pairs->g[i].v[k] = value.y, pairs->b[i].v[k] = value.z;
      }
    return;
  }
  SphereSamples samples(tile, strip, lane, block, pairs);
  for (size_t i = 0; i < pairs->count; ++i) {
    const uint32_t light = pairs->light[i];
    const SphereView view(tile, stripIndex, lane, block.lights[light], *block.spheres[light],
                          block.sphereShading);
    const Mf visible = maskFromBits(pairs->mask[i]);
    for (int k = 0;; ++k) {
      const Mf active = visible & (view.samples() > Vf(static_cast<float>(k)));
      if (!any(active)) break;
      Vf weight;
      const V3<Vf> l = view.direction(k, &weight);
      samples.push(i, l, select(active, weight, Vf(0.f)));
    }
  }
  samples.flush();
}

LOBELIA_CORE_END

#endif  // per-target include guard
