// How a choice among all emitters is made. With N emitters (an emissive shape counts one):
//  - half of the probability is shared evenly by all N, within a shape by area: no emitter is ever
//    sampled more than twice as rarely as by uniform selection, whatever the estimates below say;
//  - the other half goes to the infinite emitters one by one and to the tree over finite ones, half
//    of that evenly among these and half in proportion to the flux that they send into the scene.
// A single emitter that is one light (a sphere, a lamp, an environment) has probability one; there
// is no tree over two lights.
#include "lobelia/path/emitter_sampling.h"

#include <algorithm>
#include <bit>

#include "lobelia/base/prefetch.h"
#include "lobelia/base/random.h"
#include "lobelia/path/emitter_tree.h"
#include "lobelia/path/finite_lights.h"
#include "lobelia/path/infinite_lights.h"

namespace lobelia {

namespace {
constexpr size_t kFewLights = 2;  // the triangles of a quad: chosen by area, a tree does not pay
}

struct EmitterSampler::Impl {
  const Scene& scene;
  FiniteLights finite;
  InfiniteLights infinite;
  EmitterTree tree;
  AliasTable uniform;               // finite lights, evenly by emitter
  std::vector<float> uniformShare;  // uniformProbability times the table's probabilities
  float treeProbability = 0, uniformProbability = 0;
  AliasTable rays;  // finite lights, then infinite ones, by flux
  LightGroups groups;
  bool mixedSky = false;  // are the emitters that escaping rays see of several groups?

  Impl(const Scene& s, Bounds3f bounds)
      : scene(s),
        finite(s),
        infinite(s, bounds.empty() ? Vec3f() : bounds.centre(),
                 bounds.empty() ? 1.f : std::max(bounds.radius(), 1e-6f) * 1.0001f) {
    uniformShare.assign(finite.size(), 0);  // pdfHit() asks whether or not anything can be sampled
    std::vector<float> fluxes = finite.fluxes();
    double finiteFlux = 0;
    for (const float f : fluxes) finiteFlux += static_cast<double>(f);
    choose(finiteFlux);
    for (size_t i = 0; i < infinite.size(); ++i)
      fluxes.push_back(static_cast<float>(infinite[i].flux));
    rays = AliasTable(fluxes);
    groups = lightGroups(s);
    for (const uint32_t e : infinite.seen())
      mixedSky |= groups.of(e) != groups.of(infinite.seen().front());
  }

  void choose(double finiteFlux) {
    const bool hasFinite = finiteFlux > 0;
    const double emitters =
        static_cast<double>(infinite.size() + (hasFinite ? finite.emitterCount() : 0));
    if (emitters == 0) return;
    const double slots = static_cast<double>(infinite.size() + (hasFinite ? 1 : 0));
    double flux = finiteFlux;
    for (size_t i = 0; i < infinite.size(); ++i) flux += infinite[i].flux;
    for (size_t i = 0; i < infinite.size(); ++i) {
      infinite.setProbability(
          i, static_cast<float>(0.5 / emitters + 0.25 / slots + 0.25 * infinite[i].flux / flux));
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

  // What remains of a number that chose the uniform choice.
  float uniformNumber(float choice) const {
    return std::clamp((choice - treeProbability) / uniformProbability, 0.f, 0x1.fffffep-1f);
  }

  bool sampleFinite(uint32_t light, float chosen, Vec3f p, Vec2f u, EmitterDirection& out) const {
    const auto take = [&](const std::optional<LightSample>& s, bool delta) {
      if (!s) return false;
      out.wi = s->wi;
      out.distance = s->distance;
      out.target = s->target;
      out.delta = delta;
      out.pdf = delta ? 0.f : s->pdf * chosen;
      out.weight = s->value / (delta ? chosen : s->pdf * chosen);
      out.emitter = finite.emitter(light);
      return true;
    };
    return finite.isTriangle(light) ? take(finite.sampleTriangle(light, p, u), false)
                                    : take(finite.sampleOther(light, p, u), finite.isPoint(light));
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

bool EmitterSampler::sampleDirection(Vec3f p, Vec3f n, float select, Vec2f place,
                                     EmitterDirection& out) const {
  const Impl& impl = *impl_;
  float choice = select;
  for (size_t i = 0; i < impl.infinite.size(); ++i) {
    const InfiniteLight& light = impl.infinite[i];
    if (choice < light.probability) {
      const auto s = impl.infinite.sample(light, n, place);
      if (s) out = *s;
      return s.has_value();
    }
    choice -= light.probability;
  }
  if (choice < impl.treeProbability) {
    // The 24 bits of one number would not tell 10^6 emitters apart: more come from the other two.
    const uint64_t low =
        hashCombine(std::bit_cast<uint32_t>(place.x), std::bit_cast<uint32_t>(place.y));
    const double fine = static_cast<double>(choice) + static_cast<double>(low >> 40) * 0x1p-48;
    const auto chosen = impl.tree.sample(
        p, n, std::min(fine / static_cast<double>(impl.treeProbability), 0x1.fffffffffffffp-1));
    if (!chosen) return false;
    const float probability =
        impl.treeProbability * chosen->probability + impl.uniformShare[chosen->light];
    return impl.sampleFinite(chosen->light, probability, p, place, out);
  }
  if (!(impl.uniformProbability > 0)) return false;  // rounding at the very end of [0,1)
  const uint32_t light = static_cast<uint32_t>(impl.uniform.sample(impl.uniformNumber(choice)));
  return impl.sampleFinite(light, impl.probability(light, p, n), p, place, out);
}

bool EmitterSampler::scattered() const {
  return !impl_->tree.empty() || impl_->infinite.hasEnvironments();
}

void EmitterSampler::prefetch(std::span<const Vec3f> u) const {
  const Impl& impl = *impl_;
  const bool manyLights = !impl.tree.empty();
  std::vector<std::vector<Vec2f>> infinite(impl.infinite.size());
  std::vector<float> uniform;
  for (const Vec3f& v : u) {
    float choice = v.x;
    size_t i = 0;
    while (i < infinite.size() && !(choice < impl.infinite[i].probability))
      choice -= impl.infinite[i++].probability;
    if (i < infinite.size()) {
      infinite[i].push_back({v.y, v.z});
    } else if (manyLights && !(choice < impl.treeProbability)) {
      uniform.push_back(impl.uniformNumber(choice));
    }
  }
  for (size_t i = 0; i < infinite.size(); ++i)
    impl.infinite.prefetch(impl.infinite[i], infinite[i]);
  for (const float v : uniform) impl.uniform.prefetch(v);
  for (const float v : uniform) {
    const size_t light = impl.uniform.sample(v);
    impl.finite.prefetch(static_cast<uint32_t>(light));
    prefetchRead(&impl.uniformShare[light]);
  }
}

float EmitterSampler::pdfHit(Vec3f p, Vec3f n, const SurfacePoint& hit, Vec3f wi) const {
  const auto light = impl_->finite.lightOf(hit);
  if (!light) return 0;
  const float pdf = impl_->finite.pdf(*light, p, hit, wi);
  return pdf > 0 ? pdf * impl_->probability(*light, p, n) : 0.f;
}

float EmitterSampler::pdfEscaped(Vec3f, Vec3f n, Vec3f wi) const {
  return impl_->infinite.pdfEscaped(n, wi);
}

Rgb EmitterSampler::emitted(const SurfacePoint& hit, Vec3f wo) const {
  if (!hit.emitter.valid() || !(dot(hit.ng, wo) > 0)) return {};
  return evaluate(impl_->scene, impl_->scene[hit.emitter].radiance, hit.texture);
}

Rgb EmitterSampler::escaped(Vec3f d) const { return impl_->infinite.escaped(d); }
Rgb EmitterSampler::escaped(Vec3f d, Vec3f n, float* pdf) const {
  return impl_->infinite.escaped(d, n, pdf);
}
Rgb EmitterSampler::environment(Vec3f d) const { return impl_->infinite.environment(d); }

Rgb EmitterSampler::environment(Vec3f d, size_t group) const {
  Rgb sum{};
  for (const uint32_t e : impl_->infinite.seen())
    if (impl_->scene.emitters[e].type != EmitterType::sun && impl_->groups.of(e) == group)
      sum += impl_->infinite.escaped(d, e);
  return sum;
}

const LightGroups& EmitterSampler::groups() const { return impl_->groups; }

void EmitterSampler::addByGroup(uint32_t emitter, Vec3f d, Rgb value, Rgb* sums) const {
  const Impl& impl = *impl_;
  const std::vector<uint32_t>& seen = impl.infinite.seen();
  const bool sky =
      emitter == kEscaped || std::find(seen.begin(), seen.end(), emitter) != seen.end();
  if (!sky || !impl.mixedSky) {
    const uint32_t one = emitter == kEscaped && !seen.empty() ? seen.front() : emitter;
    sums[impl.groups.of(one)] += value;
    return;
  }
  const Rgb all = impl.infinite.escaped(d);
  for (const uint32_t e : seen) {
    const Rgb part = impl.infinite.escaped(d, e);
    Rgb& sum = sums[impl.groups.of(e)];
    for (int c = 0; c < 3; ++c)
      if (all[c] != 0) sum[c] += value[c] * (part[c] / all[c]);
  }
}

std::optional<EmittedRay> EmitterSampler::sampleRay(float uSelect, Vec2f uPosition,
                                                    Vec2f uDirection) const {
  const Impl& impl = *impl_;
  if (!(impl.rays.total() > 0)) return std::nullopt;
  const size_t chosen = impl.rays.sample(uSelect);
  const float probability = impl.rays.probability(chosen);
  if (!(probability > 0)) return std::nullopt;
  std::optional<EmittedRay> out;
  if (chosen < impl.finite.size())
    out = impl.finite.sampleRay(static_cast<uint32_t>(chosen), uPosition, uDirection);
  else
    out =
        impl.infinite.sampleRay(impl.infinite[chosen - impl.finite.size()], uPosition, uDirection);
  if (out) out->power /= probability;
  return out;
}

}  // namespace lobelia
