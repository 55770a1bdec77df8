// Particles and the lights they leave [P000 section 3; Keller 1997, "Instant Radiosity"].
//
// A particle walks by all lobes and leaves lights where rough lobes are: a light stands for what
// the rough lobes scatter of its power. What the sharp lobes scatter is carried on by the particle
// alone; receivers reach it by specular connections (path/receivers.h).
//
// Exactness. Seen from the eye, a surface sends f |cos(wi, ns)| of arriving radiance on, and shows
// its geometric area. So the intensity of the light that stands for power arriving from wi is
//   I(w) = power f(w, wi) |cos(wi, ns)| / |cos(wi, ng)| |cos(w, ng)|        [Veach97 eq. 5.18]
// which for a diffuse lobe is a cosine lobe around the geometric normal: exact. A Gaussian already
// holds |cos(w, ns)|; its intensity is corrected by the ratio at its axis, limited to a factor
// of 2 either way, since the axis of a broad lobe may lie at the horizon.
//
// A light point (LightKind::gaussian) holds both parts of what leaves one side of the surface; of
// several Gaussians one is drawn, whichever side it leaves.
#include "lobelia/lights/particle_walk.h"

#include <algorithm>
#include <span>

#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

int deepestLight(const LightSettings& settings) {
  return settings.maxDepth < 0 ? kMaxLightDepth : std::min(settings.maxDepth - 2, kMaxLightDepth);
}

// Luminance of what a lobe sends out above its horizon, per unit of arriving power.
float energyOf(const GaussianLobe& lobe) {
  return luminance(lobe.amplitude) *
         lobes::hemisphereIntegral(dot(lobe.axis, lobe.normal), lobe.sharpness);
}

// One of the Gaussians, drawn in proportion to energy; scale: by which its light stands for that of
// all.
struct ChosenGaussian {
  const GaussianLobe* lobe;
  float scale;
};
std::optional<ChosenGaussian> chooseGaussian(const LobeExpansion& lobes, float u) {
  float energies[LobeExpansion::kMaxGaussians], total = 0;
  for (int i = 0; i < lobes.count; ++i)
    total += energies[i] = std::max(0.f, energyOf(lobes.gaussians[static_cast<size_t>(i)]));
  if (!(total > 0)) return std::nullopt;
  float left = u * total;
  int chosen = 0;
  while (chosen < lobes.count - 1 && (left >= energies[chosen] || energies[chosen] <= 0))
    left -= energies[chosen++];
  while (energies[chosen] <= 0) --chosen;  // rounding may run past the last lobe with energy
  return ChosenGaussian{&lobes.gaussians[static_cast<size_t>(chosen)], total / energies[chosen]};
}

GlossyLight glossyLight(const SurfacePoint& at, const Bsdf& bsdf, const GaussianLobe& lobe,
                        Rgb power) {
  const Vec3f n = dot(bsdf.ng, lobe.normal) > 0 ? bsdf.ng : -bsdf.ng;
  const Rgb intensity = power * lobe.amplitude * geometricRatio(lobe, n);
  return {offsetOrigin(at, n), n, lobe.axis, intensity, lobe.sharpness};
}

bool isFinite(const GlossyLight& light) {
  return isFinite(light.p) && isFinite(light.axis) && isFinite(light.intensity) &&
         light.sharpness >= 0 && std::isfinite(light.sharpness);
}

}  // namespace

void ParticleBatch::addCounts(const ParticleBatch& other) {
  rays += other.rays, cut += other.cut;
  dropped += other.dropped, nonFinite += other.nonFinite;
}

void ParticleBatch::book(Context& context) const {
  context.statistics.addCount("path_rays", rays);
  context.statistics.addCount("paths_cut", cut);
  context.statistics.addCount("lights_dropped", dropped);
  context.statistics.addCount("nonfinite", nonFinite);
}

uint64_t seedOf(const LightSettings& settings, const Context& context) {
  return settings.set == 0 ? context.seed : hashCombine(context.seed, settings.set);
}

float geometricRatio(const GaussianLobe& lobe, Vec3f n) {
  const float ratio =
      std::abs(dot(lobe.axis, n)) / std::max(1e-6f, std::abs(dot(lobe.axis, lobe.normal)));
  return std::clamp(ratio, 0.5f, 2.f);
}

ParticleWalk::ParticleWalk(const Tracer& tracer, const EmitterSampler& emitters,
                           const LightSettings& settings, uint64_t seed, uint64_t stream,
                           float scale)
    : tracer_(tracer),
      emitters_(emitters),
      settings_(settings),
      seed_(seed),
      stream_(stream),
      scale_(scale),
      lastDepth_(deepestLight(settings)) {}

void ParticleWalk::trace(uint32_t particle, ParticleBatch* out) const {
  Sampler random(seed_, stream_, particle);
  const float uSelect = random.next1D();
  const Vec2f uPosition = random.next2D(), uDirection = random.next2D();
  const auto emitted = emitters_.sampleRay(uSelect, uPosition, uDirection);
  if (!emitted) return;
  if (settings_.directAsLights) leaveOnEmitter(*emitted, emitted->power * scale_, out);
  traceFrom(*emitted, random, out);
}

void ParticleWalk::traceFrom(const EmittedRay& emitted, Sampler random, ParticleBatch* out) const {
  Rgb power = emitted.power * scale_;
  const float emittedPower = maxComponent(power);
  if (!isFinite(power)) ++out->nonFinite;
  if (!(emittedPower > 0) || !isFinite(power)) return;

  const uint16_t group = emitters_.groups().of(emitted.emitter);
  Ray ray = emitted.ray;
  for (int depth = 1; depth <= lastDepth_; ++depth) {
    ++out->rays;
    const auto hit = tracer_.intersect(ray);
    if (!hit) return;
    const SurfacePoint at = surfacePoint(emitters_.scene(), *hit);
    const Vec3f wi = -ray.d;
    power *= interiorTransmittance(emitters_.scene(), at, wi);
    const Bsdf bsdf = makeBsdf(emitters_.scene(), at, wi, settings_.specularLimit);
    const float uGaussian = random.next1D();
    const bool rough = hasLobes(bsdf, LobeSet::rough);
    if (rough && settings_.photons) leavePhoton(at, wi, power, {depth, group}, out);
    if (rough && !settings_.photons)
      leaveLights(*hit, at, bsdf, wi, power, {depth, group}, uGaussian, out);

    const float uLobe = random.next1D();
    const Vec2f u = random.next2D();
    const float uRoulette = random.next1D();
    if (depth == lastDepth_) {
      if (settings_.maxDepth < 0) ++out->cut;
      return;
    }
    const auto scattered = sample(bsdf, wi, uLobe, u, LobeSet::all, Transport::importance);
    if (!scattered) return;
    power *= scattered->weight;
    if (!isFinite(power)) {
      ++out->nonFinite;
      return;
    }
    // Survivors carry about the power that they were emitted with: lights of equal power give the
    // least noise for their number.
    const float survival = std::min(1.f, maxComponent(power) / emittedPower);
    if (!(uRoulette < survival)) return;
    power /= survival;
    ray = {offsetOrigin(at, scattered->wi), scattered->wi};
  }
}

void ParticleWalk::leavePhoton(const SurfacePoint& at, Vec3f wi, Rgb power, Place place,
                               ParticleBatch* out) const {
  if (!isFinite(at.p) || !isFinite(at.ng) || !isFinite(wi)) {
    ++out->nonFinite;
  } else if (maxComponent(power) > 0) {
    out->photons.push_back(
        {at.p, power, encodeOctahedral(wi), encodeOctahedral(at.ng),
         static_cast<uint32_t>(place.depth) | static_cast<uint32_t>(place.group) << 8});
  }
}

void ParticleWalk::leaveOnEmitter(const EmittedRay& emitted, Rgb power, ParticleBatch* out) const {
  if (emitters_.scene().emitters[emitted.emitter].type != EmitterType::area) return;
  const Place place{0, emitters_.groups().of(emitted.emitter)};
  if (settings_.kind == LightKind::gaussian) {
    LightPoint point;
    point.p = emitted.ray.o, point.n = emitted.ng, point.diffuse = power;
    addPoint(point, place, out);
  } else {
    addDiffuse(emitted.ray.o, emitted.ng, power * kInvPi, place, out);
  }
}

void ParticleWalk::leaveLights(const Hit& hit, const SurfacePoint& at, const Bsdf& bsdf, Vec3f wi,
                               Rgb power, Place place, float u, ParticleBatch* out) const {
  // Light that arrives from one side by the shading normals and from the other in truth.
  const std::span frames(bsdf.frames, static_cast<size_t>(bsdf.frameCount));
  if (std::ranges::none_of(frames, [&](auto& f) { return arrivingShare(bsdf, f, wi) > 0; })) return;
  if (settings_.kind == LightKind::spherical) return addSpherical(hit, at, wi, power, place, out);
  const LobeExpansion lobes = expand(bsdf, wi, settings_.gaussiansPerLobe);
  const Vec3f side = dot(wi, bsdf.ng) > 0 ? bsdf.ng : -bsdf.ng;
  const size_t before = out->lightCount();
  if (settings_.kind == LightKind::gaussian) {
    leavePoints(at, bsdf, lobes, side, power, place, u, out);
    if (out->lightCount() == before) ++out->dropped;
    return;
  }
  if (maxComponent(lobes.diffuse) > 0)
    addDiffuse(offsetOrigin(at, side), side, power * lobes.diffuse * kInvPi, place, out);
  if (maxComponent(lobes.diffuseTransmitted) > 0)
    addDiffuse(offsetOrigin(at, -side), -side, power * lobes.diffuseTransmitted * kInvPi, place,
               out);
  if (settings_.kind == LightKind::glossy) leaveGlossy(at, bsdf, lobes, power, place, u, out);
  if (out->lightCount() == before) ++out->dropped;
}

void ParticleWalk::addSpherical(const Hit& hit, const SurfacePoint& at, Vec3f wi, Rgb power,
                                Place place, ParticleBatch* out) const {
  if (!isFinite(at.p) || !isFinite(wi) || !isFinite(power)) {
    ++out->nonFinite;
    return;
  }
  SphericalLight light{};
  light.p = at.p;
  light.power = power;
  light.arriving = encodeOctahedral(wi);
  light.instance = hit.instance, light.triangle = hit.triangle;
  light.b1 = hit.b1, light.b2 = hit.b2;
  light.depth = static_cast<uint16_t>(place.depth), light.group = place.group;
  out->spherical.push_back(light);
}

void ParticleWalk::leaveGlossy(const SurfacePoint& at, const Bsdf& bsdf, const LobeExpansion& lobes,
                               Rgb power, Place place, float u, ParticleBatch* out) const {
  if (settings_.everyGaussian) {
    for (int i = 0; i < lobes.count; ++i)
      addGlossy(at, bsdf, lobes.gaussians[static_cast<size_t>(i)], power, place, out);
    return;
  }
  if (const auto chosen = chooseGaussian(lobes, u))
    addGlossy(at, bsdf, *chosen->lobe, power * chosen->scale, place, out);
}

void ParticleWalk::leavePoints(const SurfacePoint& at, const Bsdf& bsdf, const LobeExpansion& lobes,
                               Vec3f side, Rgb power, Place place, float u,
                               ParticleBatch* out) const {
  LightPoint near, far;  // on the side that the light comes from, on the other
  near.p = offsetOrigin(at, side), near.n = side, near.diffuse = power * lobes.diffuse;
  far.p = offsetOrigin(at, -side), far.n = -side;
  far.diffuse = power * lobes.diffuseTransmitted;
  if (const auto chosen = chooseGaussian(lobes, u)) {
    const GlossyLight glossy = glossyLight(at, bsdf, *chosen->lobe, power * chosen->scale);
    LightPoint& point = glossy.n == side ? near : far;
    point.glossy =
        glossy.intensity / lobes::clippedPeak(dot(glossy.axis, glossy.n), glossy.sharpness);
    point.axis = glossy.axis, point.sharpness = glossy.sharpness;
  }
  addPoint(near, place, out);
  addPoint(far, place, out);
}

void ParticleWalk::addDiffuse(Vec3f p, Vec3f n, Rgb intensity, Place place,
                              ParticleBatch* out) const {
  if (!isFinite(p) || !isFinite(n) || !isFinite(intensity)) {
    ++out->nonFinite;
  } else if (maxComponent(intensity) > 0) {
    out->diffuse.push_back({p, intensity, encodeOctahedral(n), tagOf(place)});
  }
}

void ParticleWalk::addGlossy(const SurfacePoint& at, const Bsdf& bsdf, const GaussianLobe& lobe,
                             Rgb power, Place place, ParticleBatch* out) const {
  const GlossyLight light = glossyLight(at, bsdf, lobe, power);
  if (!isFinite(light)) {
    ++out->nonFinite;
  } else if (maxComponent(light.intensity) > 0) {
    out->glossy.push_back(light);
    out->glossyDepth.push_back(static_cast<uint8_t>(place.depth));
    out->glossyGroup.push_back(place.group);
  }
}

void ParticleWalk::addPoint(const LightPoint& point, Place place, ParticleBatch* out) const {
  if (!isFinite(point.p) || !isFinite(point.n) || !isFinite(point.diffuse) ||
      !isFinite(point.glossy) || !isFinite(point.axis) || !(point.sharpness >= 0) ||
      !std::isfinite(point.sharpness)) {
    ++out->nonFinite;
  } else if (point.power() > 0) {
    out->points.push_back(point);
    out->points.back().depth = static_cast<uint16_t>(place.depth);
    out->points.back().group = place.group;
  }
}

}  // namespace lobelia
