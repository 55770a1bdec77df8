// [Hasan09 sections 3.1 to 3.3]. Deviations: inside of the sphere the cone opens to
// acos(-sqrt(1 - (d/r)^2)) about the light and the hemisphere above x clips it, where the paper
// jumps to that hemisphere at d = r; the planar indicator may be asked for, too, for which the cone
// is the whole sphere there, as it is for the photon light.
#include "lobelia/gather/spherical_paper.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "lobelia/base/sampling.h"
#include "lobelia/scene/shading.h"

namespace lobelia::gather {
namespace {

// The cone of directions from x to the sphere.
struct Cone {
  Vec3f axis;
  float oneMinusCos;
  // whole: all directions from within the sphere.
  Cone(Vec3f d, float radius, bool whole) {
    const float d2 = std::max(lengthSquared(d), 1e-30f), r2 = radius * radius;
    axis = d / std::sqrt(d2);
    const float s2 = std::min(r2 / d2, 1.f);
    oneMinusCos = d2 > r2 ? s2 / (1 + std::sqrt(std::max(0.f, 1 - s2)))
                  : whole ? 2.f
                          : 1 + std::sqrt(std::max(0.f, 1 - d2 / r2));
  }
  explicit Cone(const SpherePair& pair)
      : Cone(pair.light.p - pair.point.p, pair.sphere.radius,
             pair.indicator == SphereShading::Indicator::planar) {}
  float solidAngle() const { return kTwoPi * oneMinusCos; }
  // "proportional to the size of the solid angle, with a maximum of up to 100 samples for 2 pi".
  int sampleCount() const {
    return std::clamp(static_cast<int>(std::ceil(100 * solidAngle() / kTwoPi)), 1, 100);
  }
  bool contains(Vec3f l) const {
    return lengthSquared(l - axis) <= 2.00002f * oneMinusCos + 1e-12f;
  }
  Vec3f sample(Vec2f u) const {
    return frameFromNormal(axis).toWorld(sampleConeUniform(u, oneMinusCos));
  }
  float pdf(Vec3f l) const { return contains(l) ? 1 / solidAngle() : 0.f; }
};

// The light's lobes by their own sampling: a BSDF whose wo is where the power came from.
Bsdf lightBsdf(const PreparedSphere& sphere) {
  Bsdf bsdf;
  bsdf.ng = sphere.disc.n;
  bsdf.frameCount = 0;
  for (int i = 0; i < sphere.lobeCount; ++i) {
    bsdf.add(sphere.lobes[i].lobe);
    bsdf.lobes[i].frame = bsdf.addFrame(sphere.lobes[i].frame);
  }
  bsdf.frameCount = std::max(bsdf.frameCount, 1);
  if (sphere.lobeCount > 0) bsdf.baseNormal = sphere.lobes[0].frame.n;
  return bsdf;
}

Vec3f arriving(const PreparedSphere& sphere) {
  return sphere.lobeCount > 0 ? sphere.lobes[0].frame.toWorld(sphere.lobes[0].wi) : sphere.disc.n;
}

// Indicator times what the surface at p sends along -l.
Rgb leaving(const SpherePair& pair, const Cone& cone, Vec3f l) {
  const Vec3f d = pair.light.p - pair.point.p, n = pair.sphere.disc.n;
  const float side = dot(n, d) > 0 ? -1.f : 1.f;
  const float cosLeave = -dot(n, l) * side;
  if (pair.indicator == SphereShading::Indicator::cosine) {
    if (!(cosLeave > 0) || !cone.contains(l)) return {};
    return leavingRadiance(pair.sphere, -l) * cosLeave;
  }
  if (!(cosLeave > 1e-12f)) return {};
  const float t = std::abs(dot(n, d)) / cosLeave;
  const Vec3f hit = l * t - d;
  if (lengthSquared(hit) > pair.sphere.squaredRadius) return {};
  const float share = gatheredShare(t, pair.point.nearDistance);
  if (!pair.sphere.whole) {
    const auto cell = [&](Vec3f axis) {
      const float x = std::floor((dot(hit, axis) / pair.sphere.radius + 1) * (kDiscCells / 2));
      return static_cast<int>(std::clamp(x, 0.f, kDiscCells - 1.f));
    };
    const int index = cell(pair.sphere.disc.t) * kDiscCells + cell(pair.sphere.disc.s);
    return leavingRadiance(pair.sphere, -l) *
           (share * pair.sphere.weights[static_cast<size_t>(index)]);
  }
  return leavingRadiance(pair.sphere, -l) * share;
}

Rgb integrand(const SpherePair& pair, const Cone& cone, Vec3f l) {
  const Vec3f d = pair.light.p - pair.point.p;
  if (dot(pair.point.ng, l) * (dot(pair.point.ng, d) < 0 ? -1.f : 1.f) <= 0) return {};
  const Rgb light = leaving(pair, cone, l);
  if (!(maxComponent(light) > 0)) return {};
  return light * evaluate(pair.bsdf, pair.point.wo, l);
}

}  // namespace

Rgb integrateBySampling(const SpherePair& pair, const std::array<int, 3>& counts, Rng* random) {
  const Cone cone(pair);
  const Bsdf light = lightBsdf(pair.sphere);
  const Vec3f wi = arriving(pair.sphere);
  Rgb sum{};
  for (size_t strategy = 0; strategy < counts.size(); ++strategy) {
    for (int k = 0; k < counts[strategy]; ++k) {
      const float choice = random->next1D();
      const Vec2f u = random->next2D();
      Vec3f l;
      if (strategy == 0) {
        l = cone.sample(u);
      } else if (strategy == 1) {
        const auto s = sample(pair.bsdf, pair.point.wo, choice, u);
        if (!s) continue;
        l = s->wi;
      } else {
        const auto s = sample(light, wi, choice, u);
        if (!s) continue;
        l = -s->wi;
      }
      const Rgb f = integrand(pair, cone, l);
      if (!(maxComponent(f) > 0)) continue;
      float density = 0;
      if (counts[0] > 0) density += static_cast<float>(counts[0]) * cone.pdf(l);
      if (counts[1] > 0)
        density += static_cast<float>(counts[1]) * pdf(pair.bsdf, pair.point.wo, l);
      if (counts[2] > 0) density += static_cast<float>(counts[2]) * pdf(light, wi, -l);
      if (density > 0) sum += f / density;
    }
  }
  return sum;
}

Rgb integrateAsPrinted(const SpherePair& pair, Rng* random) {
  const Cone cone(pair);
  const int count = cone.sampleCount();
  if (count >= 3) {
    const int third = count / 3;
    return integrateBySampling(pair, {count - 2 * third, third, third}, random);
  }
  // One direction each, weighted as if all three had been asked: the balance heuristic with
  // fractional counts.
  Rgb sum{};
  for (int k = 0; k < count; ++k) {
    const int chosen = std::min(2, static_cast<int>(3 * random->next1D()));
    const Bsdf light = lightBsdf(pair.sphere);
    const Vec3f wi = arriving(pair.sphere);
    const float choice = random->next1D();
    const Vec2f u = random->next2D();
    Vec3f l;
    if (chosen == 0) {
      l = cone.sample(u);
    } else {
      const auto s =
          chosen == 1 ? sample(pair.bsdf, pair.point.wo, choice, u) : sample(light, wi, choice, u);
      if (!s) continue;
      l = chosen == 1 ? s->wi : -s->wi;
    }
    const Rgb f = integrand(pair, cone, l);
    if (!(maxComponent(f) > 0)) continue;
    const float density = (cone.pdf(l) + pdf(pair.bsdf, pair.point.wo, l) + pdf(light, wi, -l)) / 3;
    if (density > 0) sum += f / (density * static_cast<float>(count));
  }
  return sum;
}

Rgb integrateByCone(const SpherePair& pair, Rng* random) {
  const Cone cone(pair);
  return integrateBySampling(pair, {cone.sampleCount(), 0, 0}, random);
}

Rgb evaluateAsPrinted(const Tile& tile, size_t stripIndex, size_t lane, const LightBlock& block,
                      size_t light) {
  const PointStrip& strip = tile.strips[stripIndex];
  const SamplingStrip& sampling = tile.sampling[stripIndex];
  const ReceiverPoint& point = tile.receivers->points[strip.point[lane]];
  const PreparedSphere& sphere = *block.spheres[light];
  Rng random(hashCombine(std::bit_cast<uint32_t>(sampling.random[0][lane]),
                         std::bit_cast<uint32_t>(sampling.random[1][lane])),
             hashCombine(std::bit_cast<uint32_t>(sphere.random[0]),
                         std::bit_cast<uint32_t>(sphere.random[1])));
  const SpherePair pair{point, receiverBsdf(*tile.receivers, point), block.lights[light], sphere,
                        block.sphereShading.indicator};
  return block.sphereShading.sampling == SphereShading::Sampling::cone
             ? integrateByCone(pair, &random)
             : integrateAsPrinted(pair, &random);
}

Rgb photonLight(const Tracer& tracer, const SpherePair& pair, const SphericalLight& light,
                float specularLimit, int samples, Rng* random) {
  const ReceiverPoint& x = pair.point;
  const Cone cone(light.p - x.p, light.radius, true);
  Rgb sum{};
  for (int k = 0; k < samples; ++k) {
    const Vec3f l = cone.sample(random->next2D());
    const Rgb f = evaluate(pair.bsdf, x.wo, l);
    if (!(maxComponent(f) > 0)) continue;
    const auto hit = tracer.intersect({offsetOrigin(x.p, x.ng, x.error, l), l});
    if (!hit) continue;
    const SurfacePoint y = surfacePoint(tracer.scene(), *hit);
    if (lengthSquared(y.p - light.p) > light.radius * light.radius) continue;
    // f(y) for power from where the photon came.
    SphericalLight there = light;
    there.instance = hit->instance, there.triangle = hit->triangle;
    there.b1 = hit->b1, there.b2 = hit->b2;
    PreparedSphere sphere;
    prepareSphere(tracer.scene(), there, specularLimit, &sphere);
    sum += f * leavingRadiance(sphere, -l);
  }
  return sum * light.power *
         (cone.solidAngle() / (static_cast<float>(samples) * kPi * sqr(light.radius)));
}

}  // namespace lobelia::gather
