// How a choice among all emitters is made. With N emitters (an emissive shape counts one):
//  - half of the probability is shared evenly by all N, within a shape by area: no emitter is ever
//    sampled more than twice as rarely as by uniform selection, whatever the estimates below say;
//  - the other half goes to the infinite emitters one by one and to the tree over finite ones, half
//    of that evenly among these and half in proportion to the flux that they send into the scene.
// A single emitter that is one light (a sphere, a lamp, an environment) has probability one; there
// is no tree over two lights.
//
// Densities of all environments are added up and so are their radiances: the direction counts, not
// which of them it was drawn from.
#include "lobelia/path/emitter_sampling.h"

#include <bit>

#include "lobelia/base/random.h"
#include "lobelia/path/emitter_tree.h"
#include "lobelia/path/environment_sampling.h"
#include "lobelia/path/finite_lights.h"

namespace lobelia {

namespace {
constexpr size_t kFewLights = 2;  // the triangles of a quad: chosen by area, a tree does not pay
}

struct EmitterSampler::Impl {
  struct Infinite {
    uint32_t emitter = 0;
    bool directional = false;
    Vec3f direction;  // directional: towards the light
    Rgb irradiance;
    size_t environment = 0;  // index into environments
    double flux = 0;
    float probability = 0;
  };

  const Scene& scene;
  FiniteLights finite;
  EmitterTree tree;
  AliasTable uniform;               // finite lights, evenly by emitter
  std::vector<float> uniformShare;  // uniformProbability times the table's probabilities
  std::vector<EnvironmentSampler> environments;
  std::vector<Infinite> infinite;
  float treeProbability = 0, uniformProbability = 0;
  AliasTable rays;  // finite lights, then infinite ones, by flux
  Vec3f centre;     // bounding sphere of the scene
  float radius = 1;

  Impl(const Scene& s, Bounds3f bounds) : scene(s), finite(s) {
    if (!bounds.empty())
      centre = bounds.centre(), radius = std::max(bounds.radius(), 1e-6f) * 1.0001f;
    for (uint32_t e = 0; e < scene.emitters.size(); ++e) addInfinite(e);
    uniformShare.assign(finite.size(), 0);  // pdfHit() asks whether or not anything can be sampled
    std::vector<float> fluxes = finite.fluxes();
    double finiteFlux = 0;
    for (const float f : fluxes) finiteFlux += static_cast<double>(f);
    choose(finiteFlux);
    for (const Infinite& light : infinite) fluxes.push_back(static_cast<float>(light.flux));
    rays = AliasTable(fluxes);
  }

  void addInfinite(uint32_t e) {
    const Emitter& emitter = scene.emitters[e];
    const double disk = static_cast<double>(kPi * radius * radius);
    Infinite light;
    light.emitter = e;
    if (emitter.type == EmitterType::directional) {
      light.directional = true;
      light.direction = -normalize(emitter.direction);
      light.irradiance = mean(scene, emitter.radiance);
      light.flux = disk * static_cast<double>(std::max(0.f, luminance(light.irradiance)));
    } else if (emitter.type == EmitterType::constant || emitter.type == EmitterType::environment) {
      light.environment = environments.size();
      environments.emplace_back(scene, emitter);
      light.flux = disk * environments.back().integral();
    } else {
      return;
    }
    // One that cannot be sampled is still seen: its non-finite radiance is to be counted, not
    // hidden.
    if (light.flux > 0 && std::isfinite(light.flux)) {
      infinite.push_back(light);
    } else if (!light.directional && light.flux == 0) {
      environments.pop_back();
    }
  }

  void choose(double finiteFlux) {
    const bool hasFinite = finiteFlux > 0;
    const double emitters =
        static_cast<double>(infinite.size() + (hasFinite ? finite.emitterCount() : 0));
    if (emitters == 0) return;
    const double slots = static_cast<double>(infinite.size() + (hasFinite ? 1 : 0));
    double flux = finiteFlux;
    for (const Infinite& light : infinite) flux += light.flux;
    for (Infinite& light : infinite) {
      light.probability =
          static_cast<float>(0.5 / emitters + 0.25 / slots + 0.25 * light.flux / flux);
    }
    if (!hasFinite) return;
    uniform = AliasTable(finite.uniformWeights());
    const double even = 0.5 * static_cast<double>(finite.emitterCount()) / emitters;
    const double byTree = 0.25 / slots + 0.25 * finiteFlux / flux;
    if (finite.size() > kFewLights) tree = EmitterTree(finite.treeLights());
    treeProbability = static_cast<float>(tree.empty() ? 0 : byTree);
    uniformProbability = static_cast<float>(tree.empty() ? even + byTree : even);
    for (size_t i = 0; i < uniformShare.size(); ++i) {
      uniformShare[i] = uniformProbability * uniform.probability(i);
    }
  }

  float probability(uint32_t light, Vec3f p, Vec3f n) const {
    const float even = uniformShare[light];
    return treeProbability > 0 ? even + treeProbability * tree.probability(p, n, light) : even;
  }

  Rgb escaped(Vec3f d) const {
    Rgb sum{};
    for (const EnvironmentSampler& e : environments) sum += e.radiance(d);
    return sum;
  }

  float pdfEscaped(Vec3f n, Vec3f d) const {
    float sum = 0;
    for (const Infinite& light : infinite) {
      if (!light.directional) sum += light.probability * environments[light.environment].pdf(n, d);
    }
    return sum;
  }

  std::optional<EmitterDirection> sampleInfinite(const Infinite& light, Vec3f n, Vec2f u) const {
    EmitterDirection out;
    out.emitter = light.emitter;
    out.distance = 3e38f;
    if (light.directional) {
      out.wi = light.direction;
      out.delta = true;
      out.weight = light.irradiance / light.probability;
      return out;
    }
    float pdf;
    out.wi = environments[light.environment].sample(n, u, &pdf);
    if (!(pdf > 0)) return std::nullopt;
    out.pdf = environments.size() == 1 ? pdf * light.probability : pdfEscaped(n, out.wi);
    out.weight = escaped(out.wi) / out.pdf;
    return out;
  }

  std::optional<EmitterDirection> sampleFinite(uint32_t light, float chosen, Vec3f p,
                                               Vec2f u) const {
    const auto s = finite.sample(light, p, u);
    if (!s) return std::nullopt;
    EmitterDirection out;
    out.wi = s->wi;
    out.distance = s->distance;
    out.target = s->target;
    out.delta = finite.isPoint(light);
    out.pdf = out.delta ? 0.f : s->pdf * chosen;
    out.weight = s->value / (out.delta ? chosen : out.pdf);
    out.emitter = finite.emitter(light);
    return out;
  }
};

EmitterSampler::EmitterSampler(const Scene& scene, Bounds3f sceneBounds)
    : impl_(std::make_unique<Impl>(scene, sceneBounds)) {}
EmitterSampler::~EmitterSampler() = default;

bool EmitterSampler::empty() const {
  return impl_->infinite.empty() && impl_->uniformProbability == 0;
}
const Scene& EmitterSampler::scene() const { return impl_->scene; }
double EmitterSampler::power() const { return impl_->rays.total(); }

std::optional<EmitterDirection> EmitterSampler::sampleDirection(Vec3f p, Vec3f n, Vec3f u) const {
  const Impl& impl = *impl_;
  float choice = u.x;
  for (const Impl::Infinite& light : impl.infinite) {
    if (choice < light.probability) return impl.sampleInfinite(light, n, {u.y, u.z});
    choice -= light.probability;
  }
  if (choice < impl.treeProbability) {
    // The 24 bits of one number would not tell 10^6 emitters apart: more come from the other two.
    const uint64_t low = hashCombine(std::bit_cast<uint32_t>(u.y), std::bit_cast<uint32_t>(u.z));
    const double fine = static_cast<double>(choice) + static_cast<double>(low >> 40) * 0x1p-48;
    const auto chosen = impl.tree.sample(
        p, n, std::min(fine / static_cast<double>(impl.treeProbability), 0x1.fffffffffffffp-1));
    if (!chosen) return std::nullopt;
    const float probability =
        impl.treeProbability * chosen->probability + impl.uniformShare[chosen->light];
    return impl.sampleFinite(chosen->light, probability, p, {u.y, u.z});
  }
  if (!(impl.uniformProbability > 0)) return std::nullopt;  // rounding at the very end of [0,1)
  const float rest = (choice - impl.treeProbability) / impl.uniformProbability;
  const uint32_t light =
      static_cast<uint32_t>(impl.uniform.sample(std::clamp(rest, 0.f, 0x1.fffffep-1f)));
  return impl.sampleFinite(light, impl.probability(light, p, n), p, {u.y, u.z});
}

float EmitterSampler::pdfHit(Vec3f p, Vec3f n, const SurfacePoint& hit, Vec3f wi) const {
  const auto light = impl_->finite.lightOf(hit);
  if (!light) return 0;
  const float pdf = impl_->finite.pdf(*light, p, hit, wi);
  return pdf > 0 ? pdf * impl_->probability(*light, p, n) : 0.f;
}

float EmitterSampler::pdfEscaped(Vec3f, Vec3f n, Vec3f wi) const {
  return impl_->pdfEscaped(n, wi);
}

Rgb EmitterSampler::emitted(const SurfacePoint& hit, Vec3f wo) const {
  if (!hit.emitter.valid() || !(dot(hit.ng, wo) > 0)) return {};
  return evaluate(impl_->scene, impl_->scene[hit.emitter].radiance, hit.texture);
}

Rgb EmitterSampler::escaped(Vec3f d) const { return impl_->escaped(d); }

std::optional<EmittedRay> EmitterSampler::sampleRay(float uSelect, Vec2f uPosition,
                                                    Vec2f uDirection) const {
  const Impl& impl = *impl_;
  if (!(impl.rays.total() > 0)) return std::nullopt;
  const size_t chosen = impl.rays.sample(uSelect);
  const float probability = impl.rays.probability(chosen);
  if (!(probability > 0)) return std::nullopt;
  if (chosen < impl.finite.size()) {
    EmittedRay out = impl.finite.sampleRay(static_cast<uint32_t>(chosen), uPosition, uDirection);
    out.power /= probability;
    return out;
  }
  const Impl::Infinite& light = impl.infinite[chosen - impl.finite.size()];
  EmittedRay out;
  out.emitter = light.emitter;
  out.infinite = true;
  const float disk = kPi * impl.radius * impl.radius;
  Vec3f towards = light.direction;
  if (light.directional) {
    out.power = light.irradiance * (disk / probability);
  } else {
    const EnvironmentSampler& environment = impl.environments[light.environment];
    float pdf;
    towards = environment.sample({}, uDirection, &pdf);
    if (!(pdf > 0)) return std::nullopt;
    out.power = environment.radiance(towards) * (disk / (pdf * probability));
  }
  const Frame frame = frameFromNormal(towards);
  const Vec2f d = sampleDiskConcentric(uPosition);
  out.ray.o = impl.centre + (towards + frame.s * d.x + frame.t * d.y) * impl.radius;
  out.ray.d = -towards;
  out.ng = out.ray.d;
  return out;
}

}  // namespace lobelia
