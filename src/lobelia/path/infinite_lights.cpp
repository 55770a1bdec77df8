#include "lobelia/path/infinite_lights.h"

namespace lobelia {
namespace {

using Kind = InfiniteLight::Kind;

// |a - b|^2 = 2 (1 - cos) between unit vectors keeps its precision where the cosine has none.
bool contains(const InfiniteLight& disc, Vec3f d) {
  return lengthSquared(d - disc.direction) <= 2 * disc.oneMinusCos;
}

float pdfOf(const InfiniteLight& disc) { return 1 / (kTwoPi * disc.oneMinusCos); }

InfiniteLight sunOf(const Scene& scene, const Emitter& emitter) {
  InfiniteLight light;
  light.direction = -normalize(emitter.direction);
  light.value = mean(scene, emitter.radiance);
  if (emitter.type == EmitterType::directional || emitter.angularRadius < kSmallestDisc)
    return light;
  light.kind = Kind::disc;
  const double half = std::sin(0.5 * static_cast<double>(emitter.angularRadius));
  const double oneMinusCos = 2 * half * half;
  light.oneMinusCos = static_cast<float>(oneMinusCos);
  light.value /= static_cast<float>(static_cast<double>(kPi) * oneMinusCos * (2 - oneMinusCos));
  return light;
}

}  // namespace

InfiniteLights::InfiniteLights(const Scene& scene, Vec3f centre, float radius)
    : centre_(centre), radius_(radius) {
  for (uint32_t e = 0; e < scene.emitters.size(); ++e) add(scene, e);
}

// One that cannot be sampled is still seen: its non-finite radiance is to be counted, not hidden.
void InfiniteLights::add(const Scene& scene, uint32_t e) {
  const Emitter& emitter = scene.emitters[e];
  InfiniteLight light;
  switch (emitter.type) {
    case EmitterType::directional:
    case EmitterType::sun: {
      light = sunOf(scene, emitter);
      const bool disc = light.kind == Kind::disc;
      const double solidAngle =
          disc ? 2.0 * static_cast<double>(kPi) * static_cast<double>(light.oneMinusCos) : 1.0;
      light.flux = disk() * solidAngle * static_cast<double>(std::max(0.f, luminance(light.value)));
      light.emitter = e;
      if (disc && !(light.value == Rgb{})) {
        discs_.push_back(light);
        seen_.push_back(e);
      }
      break;
    }
    case EmitterType::constant:
    case EmitterType::environment: {
      EnvironmentSampler environment(scene, emitter);
      light.kind = Kind::environment;
      light.emitter = e;
      light.flux = disk() * environment.integral();
      light.environment = environments_.size();
      if (light.flux != 0) {
        environments_.push_back(std::move(environment));
        environmentEmitters_.push_back(e);
        seen_.push_back(e);
      }
      break;
    }
    default:
      return;
  }
  if (light.flux > 0 && std::isfinite(light.flux)) lights_.push_back(light);
}

Rgb InfiniteLights::environment(Vec3f d) const {
  Rgb sum{};
  for (const EnvironmentSampler& e : environments_) sum += e.radiance(d);
  return sum;
}

Rgb InfiniteLights::escaped(Vec3f d) const {
  Rgb sum = environment(d);
  for (const InfiniteLight& disc : discs_)
    if (contains(disc, d)) sum += disc.value;
  return sum;
}

Rgb InfiniteLights::escaped(Vec3f d, Vec3f n, float* pdf) const {
  // Alone, and one that is sampled: the common case.
  if (environments_.size() == 1 && discs_.empty() && lights_.size() == 1 &&
      lights_[0].kind == Kind::environment) {
    const Rgb radiance = environments_[0].radiance(d, n, pdf);
    *pdf *= lights_[0].probability;
    return radiance;
  }
  *pdf = pdfEscaped(n, d);
  return escaped(d);
}

Rgb InfiniteLights::escaped(Vec3f d, uint32_t emitter) const {
  Rgb sum{};
  for (size_t i = 0; i < environments_.size(); ++i)
    if (environmentEmitters_[i] == emitter) sum += environments_[i].radiance(d);
  for (const InfiniteLight& disc : discs_)
    if (disc.emitter == emitter && contains(disc, d)) sum += disc.value;
  return sum;
}

float InfiniteLights::pdfEscaped(Vec3f n, Vec3f d) const {
  float sum = 0;
  for (const InfiniteLight& light : lights_) {
    if (light.kind == Kind::environment)
      sum += light.probability * environments_[light.environment].pdf(n, d);
    if (light.kind == Kind::disc && contains(light, d)) sum += light.probability * pdfOf(light);
  }
  return sum;
}

std::optional<EmitterDirection> InfiniteLights::sample(const InfiniteLight& light, Vec3f n,
                                                       Vec2f u) const {
  EmitterDirection out;
  out.emitter = light.emitter;
  out.distance = 3e38f;
  if (light.kind == Kind::direction) {
    out.wi = light.direction;
    out.delta = true;
    out.weight = light.value / light.probability;
    return out;
  }
  float pdf = pdfOf(light);
  Rgb radiance = light.value;
  if (light.kind == Kind::disc)
    out.wi = frameFromNormal(light.direction).toWorld(sampleConeUniform(u, light.oneMinusCos));
  else
    out.wi = environments_[light.environment].sample(n, u, &pdf, &radiance);
  if (!(pdf > 0)) return std::nullopt;
  const bool alone = environments_.size() + discs_.size() == 1;
  out.pdf = alone ? pdf * light.probability : pdfEscaped(n, out.wi);
  if (!(out.pdf > 0)) return std::nullopt;  // rounded out of its disc
  out.weight = (alone ? radiance : escaped(out.wi)) / out.pdf;
  return out;
}

std::optional<EmittedRay> InfiniteLights::sampleRay(const InfiniteLight& light, Vec2f uPosition,
                                                    Vec2f uDirection) const {
  EmittedRay out;
  out.emitter = light.emitter;
  out.infinite = true;
  Vec3f towards = light.direction;
  const float area = static_cast<float>(disk());
  if (light.kind == Kind::direction) {
    out.power = light.value * area;
  } else if (light.kind == Kind::disc) {
    towards = frameFromNormal(towards).toWorld(sampleConeUniform(uDirection, light.oneMinusCos));
    out.power = light.value * (area / pdfOf(light));
  } else {
    const EnvironmentSampler& environment = environments_[light.environment];
    float pdf;
    Rgb radiance;
    towards = environment.sample({}, uDirection, &pdf, &radiance);
    if (!(pdf > 0)) return std::nullopt;
    out.power = radiance * (area / pdf);
  }
  const Frame frame = frameFromNormal(towards);
  const Vec2f d = sampleDiskConcentric(uPosition);
  out.ray.o = centre_ + (towards + frame.s * d.x + frame.t * d.y) * radius_;
  out.ray.d = -towards;
  out.ng = out.ray.d;
  return out;
}

}  // namespace lobelia
