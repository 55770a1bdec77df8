// Light of visible pairs of receiver points and spherical lights [Hasan09 eq. 5]:
//   power / (area pi-less: of the disc on the surface) * integral over directions l from x of
//     f(x; wo, l) cos * f(p; -l, wi) * indicator(l),
// by a few directions per pair, in registers of points for one light.
//
// Directions. A base that covers all that counts: points of the disc, far away; the cone around the
// sphere, nearer than two radii; the hemisphere below the disc's plane, inside of the sphere. Where
// the cone is wide against the lobes, half of the directions (at most) come from the products of the
// two ends' Gaussians instead, weighted by the balance heuristic as one mixture: the density never
// falls below half of the base's.
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
HWY_INLINE Vf squaredDistance(V3<Vf> a, V3<Vf> b) {
  const V3<Vf> d = a - b;
  return dot(d, d);
}

// Direction at an angle to an axis and at an azimuth around it [Duff et al. 2017, "Building an
// Orthonormal Basis, Revisited"].
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
    Mf onDisc = disc_;
    if (lobeCount_ > 0) {
      const Mf byLobe = choice < share_;
      onDisc = onDisc & !byLobe;
      V3<Vf> lobeAxis = axis_[0];
      Vf sharpness = sharpness_[0];
      Vf passed = probability_[0];
      for (int i = 1; i < lobeCount_; ++i) {
        const Mf next = choice >= share_ * passed;
        lobeAxis = select(next, axis_[i], lobeAxis);
        sharpness = select(next, sharpness_[i], sharpness);
        passed = passed + probability_[i];
      }
      // 1 - cos = -log(1 - u (1 - e^-2k)) / k
      const Vf t = Vf(0.f) - log(max(Vf(1.f) - u * (Vf(1.f) - exp(Vf(-2.f) * sharpness)),
                                     Vf(1e-30f))) /
                                 sharpness;
      axis = select(byLobe, lobeAxis, axis);
      oneMinusCos = select(byLobe, min(t, Vf(2.f)), oneMinusCos);
    }
    V3<Vf> l = direction_;
    if (!all(onDisc)) l = aroundAxis(axis, oneMinusCos, cosPhi, sinPhi);
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
    share_ = Vf(0.f);
    Vf overlap = solidAngle_;
    const Vf sharpest = Vf::load(sampling_.sharpest + lane_) + Vf(sphere_.sharpest);
    // Every product is wider than this: where the cone is narrow against it, the base is best.
    if (any(sharpest * solidAngle_ > Vf(kNarrow * 2 * kSgPi))) weighLobes(&overlap);
    const Vf most(static_cast<float>(shading.maxSamples));
    samples_ = max(min(floor(most * overlap * Vf(0.5f / kSgPi) + Vf(0.999f)), most), Vf(1.f));
  }

  void weighLobes(Vf* overlap) {
    const Vf cone = sqrt(Vf(2.f) * oneMinusCosMax_);  // its chord
    const Vf diffuseX = Vf::load(sampling_.diffuse + lane_);
    Vf mass = diffuseX * Vf(sphere_.diffuse) * solidAngle_, useful(0.f);
    Vf spread = mass * solidAngle_;
    const auto add = [&](V3<Vf> v, Vf length, Vf amplitude, Vf exponent) {
      const Vf sharpness = max(length, Vf(1e-3f));
      const V3<Vf> axis = v * (Vf(1.f) / max(length, Vf(1e-20f)));
      const Vf apart = max(sqrt(squaredDistance(axis, direction_)) - cone, Vf(0.f));
      const Vf area = min(sgIntegral(sharpness), solidAngle_);
      const Vf weight = amplitude * exp(exponent - Vf(0.5f) * sharpness * apart * apart) * area;
      // 0 where the cone is an eighth of the lobe, 1 from a half on.
      const Vf ratio = solidAngle_ / sgIntegral(sharpness);
      const Vf worth = min(max((ratio - Vf(kNarrow)) * Vf(1.f / (0.5f - kNarrow)), Vf(0.f)),
                           Vf(1.f));
      mass = mass + weight;
      spread = spread + weight * area;
      useful = useful + weight * worth;
      axis_[lobeCount_] = axis;
      sharpness_[lobeCount_] = sharpness;
      probability_[lobeCount_++] = weight * worth;
    };
    for (int j = 0; j < sphere_.gaussianCount; ++j) {
      const g::PreparedSphere::Gaussian& y = sphere_.gaussians[j];
      const V3<Vf> back = broadcast(-y.axis);  // as a function of the direction from x
      const Vf sharpness(y.sharpness), amplitude(y.amplitude);
      if (any(diffuseX > Vf(0.f))) add(back * sharpness, sharpness, diffuseX * amplitude, Vf(0.f));
      for (size_t i = 0; i < strip_.gaussianCount; ++i) {
        const g::GaussianStrip& x = tile_.gaussians[strip_.firstGaussian + i];
        const V3<Vf> axis = load(x.axis, lane_);
        const Vf sharpnessX = Vf::load(x.sharpness + lane_);
        const V3<Vf> v = axis * sharpnessX + back * sharpness;
        const Vf length = sqrt(dot(v, v));
        const Vf sum = max(length + sharpnessX + sharpness, Vf(1e-20f));
        add(v, length, Vf::load(x.amplitude + lane_) * amplitude,
            Vf(0.f) - sharpnessX * sharpness * squaredDistance(axis, back) / sum);
      }
    }
    if (sphere_.diffuse > 0) {
      for (size_t i = 0; i < strip_.gaussianCount; ++i) {
        const g::GaussianStrip& x = tile_.gaussians[strip_.firstGaussian + i];
        const Vf sharpness = Vf::load(x.sharpness + lane_);
        add(load(x.axis, lane_) * sharpness, sharpness,
            Vf::load(x.amplitude + lane_) * Vf(sphere_.diffuse), Vf(0.f));
      }
    }
    const Mf some = useful > Vf(1e-30f);
    const Vf inverse = Vf(1.f) / max(useful, Vf(1e-30f));
    for (int i = 0; i < lobeCount_; ++i) probability_[i] = probability_[i] * inverse;
    share_ = select(some, Vf(0.5f) * min(useful / max(mass, Vf(1e-30f)), Vf(1.f)), Vf(0.f));
    *overlap = select(mass > Vf(1e-30f), spread / max(mass, Vf(1e-30f)), solidAngle_);
    if (!any(some)) lobeCount_ = 0;
  }

  HWY_INLINE Vf indicatorOverDensity(V3<Vf> l, Mf onDisc) const {
    const Vf cosLeave = (Vf(0.f) - dot(n_, l)) * side_;
    const Vf safe = max(cosLeave, Vf(1e-12f));
    // Where l meets the disc's plane, from the light.
    const Vf t = abs(dot(n_, d_)) / safe;
    const V3<Vf> hit = l * t - d_;
    const Mf below = cosLeave > Vf(0.f);
    const Mf onPlane = below & ((dot(hit, hit) <= Vf(sphere_.squaredRadius)) | onDisc);
    const Mf inCone =
        squaredDistance(l, direction_) <= Vf(2.00002f) * oneMinusCosMax_ + Vf(1e-12f);
    Vf density = select(hemisphere_, select(below, Vf(0.5f / kSgPi), Vf(0.f)),
                        select(inCone, Vf(1.f) / solidAngle_, Vf(0.f)));
    if (any(disc_)) {
      const Vf onArea = t * t / (safe * Vf(kSgPi * sphere_.squaredRadius));
      density = select(disc_, select(onPlane, onArea, Vf(0.f)), density);
    }
    if (lobeCount_ > 0) {
      Vf lobes(0.f);
      for (int i = 0; i < lobeCount_; ++i)
        lobes = lobes + probability_[i] * vmfDensity(axis_[i], sharpness_[i], l);
      density = density * (Vf(1.f) - share_) + select(share_ > Vf(0.f), share_ * lobes, Vf(0.f));
    }
    Vf indicator;
    if (planar_) {
      indicator = select(onPlane, weightAt(hit), Vf(0.f));
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

  static constexpr float kNarrow = 0.125f;
  const g::Tile& tile_;
  const g::PointStrip& strip_;
  const g::SamplingStrip& sampling_;
  const size_t lane_;
  const g::PreparedSphere& sphere_;
  const bool planar_;
  V3<Vf> d_, direction_, n_;
  Vf d2_, side_, front_, oneMinusCosMax_, solidAngle_, samples_, share_;
  Mf disc_, hemisphere_;
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
      const V3<Vf> light = leavingRadiance(block_.spheres[sums_->light[pair]], l);
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
    const Vf c = dot(load(strip_.base, lane_), l), c2 = max(c * c, Vf(1e-20f));
    const Vf alpha2 = Vf::load(strip_.bumpAlpha2 + lane_);
    const Vf shadow =
        Vf(2.f) / (Vf(1.f) + sqrt(Vf(1.f) + alpha2 * (Vf(1.f) - c2) / c2));
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

// The pairs' values but for the lights' power over area, as r, g, b with a factor of 1.
void sphericalPairs(const g::Tile& tile, size_t stripIndex, size_t lane,
                    const g::LightBlock& block, PairScratch* pairs) {
  for (size_t i = 0; i < pairs->count; ++i) {
    Vf(1.f).store(pairs->factor[i].v);
    for (float* sum : {pairs->r[i].v, pairs->g[i].v, pairs->b[i].v}) Vf(0.f).store(sum);
  }
  if (block.sphereShading.sampling == SphereShading::Sampling::paper) {
    for (size_t i = 0; i < pairs->count; ++i)
      for (uint32_t bits = pairs->mask[i]; bits != 0; bits &= bits - 1) {
        const size_t k = static_cast<size_t>(__builtin_ctz(bits));
        const Rgb value = g::evaluateAsPrinted(tile, stripIndex, lane + k, block, pairs->light[i]);
        pairs->r[i].v[k] = value.x, pairs->g[i].v[k] = value.y, pairs->b[i].v[k] = value.z;
      }
    return;
  }
  SphereSamples samples(tile, tile.strips[stripIndex], lane, block, pairs);
  for (size_t i = 0; i < pairs->count; ++i) {
    const uint32_t light = pairs->light[i];
    const SphereView view(tile, stripIndex, lane, block.lights[light], block.spheres[light],
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
