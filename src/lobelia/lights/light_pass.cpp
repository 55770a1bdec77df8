// The light pass: how many particles, in parallel, and their lights in one deterministic order.
//
// The number of particles is decided before they are traced, by a pilot with random numbers of its
// own. Tracing until enough lights are there would be biased: the last particle would be one that
// left lights, and the mean over particles would depend on when one stopped.
#include "lobelia/lights/light_pass.h"

#include <fmt/format.h>

#include <atomic>
#include <cassert>
#include <utility>

#include "lobelia/base/parallel.h"
#include "lobelia/lights/light_order.h"
#include "lobelia/lights/particle_walk.h"
#include "lobelia/lights/spherical_coverage.h"
#include "lobelia/lights/spherical_radius.h"
#include "lobelia/path/point_lights.h"

namespace lobelia {
namespace {

const char* nameOf(LightKind kind) {
  switch (kind) {
    case LightKind::diffuse:
      return "vpl";
    case LightKind::glossy:
      return "glossy";
    case LightKind::spherical:
      return "vsl";
    case LightKind::gaussian:
      break;
  }
  return "vsgl";
}

constexpr uint64_t kPilotStream = 0x70696c6f74ull, kStream = 0x6c6967687473ull;
constexpr size_t kBatchSize = 512;
constexpr uint64_t kMaxParticles = 0xffffffffull;  // Sampler's indices
constexpr size_t kDefaultEnvironmentLights = 1024;
constexpr size_t kLightsPerSun = 16;

std::vector<ParticleBatch> traceParticles(const ParticleWalk& walk, uint64_t count,
                                          Context& context, bool report) {
  std::vector<ParticleBatch> batches((count + kBatchSize - 1) / kBatchSize);
  std::atomic<size_t> done{0};
  parallelFor(batches.size(), 1, [&](size_t b) {
    if (context.cancelled()) return;
    const uint64_t end = std::min<uint64_t>(count, (b + 1) * kBatchSize);
    for (uint64_t i = b * kBatchSize; i < end; ++i)
      walk.trace(static_cast<uint32_t>(i), &batches[b]);
    const size_t finished = done.fetch_add(1, std::memory_order_relaxed) + 1;
    if (report && finished % 64 == 0)
      context.progress("lights",
                       static_cast<double>(finished) / static_cast<double>(batches.size()));
  });
  return batches;
}

size_t lightCount(const std::vector<ParticleBatch>& batches) {
  size_t n = 0;
  for (const ParticleBatch& b : batches) n += b.lightCount();
  return n;
}

// Particles that leave about settings.count lights. A pilot that finds few lights is repeated with
// more particles, up to a limit: a scene may leave none at all.
uint64_t chooseParticleCount(const Tracer& tracer, const EmitterSampler& emitters,
                             const LightSettings& settings, Context& context) {
  constexpr uint64_t kMaxPilot = 1u << 18;
  constexpr size_t kEnough = 256;
  const ParticleWalk walk(tracer, emitters, settings, seedOf(settings, context), kPilotStream, 1.f);
  uint64_t pilot = std::clamp<uint64_t>(settings.count / 16, 1024, 16384);
  for (;; pilot *= 4) {
    const size_t lights = lightCount(traceParticles(walk, pilot, context, false));
    if (lights < kEnough && pilot < kMaxPilot && !context.cancelled()) continue;
    if (lights == 0) return std::min<uint64_t>(settings.count, kMaxParticles);
    const double particles = static_cast<double>(settings.count) * static_cast<double>(pilot) /
                             static_cast<double>(lights);
    return static_cast<uint64_t>(
        std::clamp(std::round(particles), 1.0, static_cast<double>(kMaxParticles)));
  }
}

// Counting sort by depth over the batches: stable, and the same whatever thread made which batch.
template <class Light, class Lights, class Depth>
std::vector<uint32_t> sortByDepth(const std::vector<ParticleBatch>& batches, const Lights& lightsOf,
                                  const Depth& depthOf, std::vector<Light>* sorted) {
  std::vector<std::vector<size_t>> starts(batches.size());  // by batch and depth
  size_t depthCount = 0;
  for (size_t b = 0; b < batches.size(); ++b) {
    for (size_t i = 0; i < lightsOf(batches[b]).size(); ++i) {
      const size_t depth = depthOf(batches[b], i);
      if (starts[b].size() <= depth) starts[b].resize(depth + 1);
      ++starts[b][depth];
    }
    depthCount = std::max(depthCount, starts[b].size());
  }
  std::vector<uint32_t> ends;
  size_t next = 0;
  for (size_t depth = 0; depth < depthCount; ++depth) {
    for (auto& start : starts)
      if (depth < start.size()) next += std::exchange(start[depth], next);
    ends.push_back(static_cast<uint32_t>(next));
  }
  sorted->resize(next);
  parallelFor(batches.size(), 16, [&](size_t b) {
    for (size_t i = 0; i < lightsOf(batches[b]).size(); ++i)
      (*sorted)[starts[b][depthOf(batches[b], i)]++] = lightsOf(batches[b])[i];
  });
  return ends;
}

void countParticles(const std::vector<ParticleBatch>& batches, Context& context) {
  ParticleBatch total;
  for (const ParticleBatch& b : batches) total.addCounts(b);
  total.book(context);
}

void collect(const std::vector<ParticleBatch>& batches, VirtualLights* lights) {
  lights->diffuseDepthEnds = sortByDepth(
      batches, [](const ParticleBatch& b) -> auto& { return b.diffuse; },
      [](const ParticleBatch& b, size_t i) -> size_t { return b.diffuse[i].tag & 0xff; },
      &lights->diffuse);
  lights->glossyDepthEnds = sortByDepth(
      batches, [](const ParticleBatch& b) -> auto& { return b.glossy; },
      [](const ParticleBatch& b, size_t i) -> size_t { return b.glossyDepth[i]; }, &lights->glossy);
  sortByDepth(
      batches, [](const ParticleBatch& b) -> auto& { return b.glossyGroup; },
      [](const ParticleBatch& b, size_t i) -> size_t { return b.glossyDepth[i]; },
      &lights->glossyGroups);
  lights->sphericalDepthEnds = sortByDepth(
      batches, [](const ParticleBatch& b) -> auto& { return b.spherical; },
      [](const ParticleBatch& b, size_t i) -> size_t { return b.spherical[i].depth; },
      &lights->spherical);
}

// Emitters without an area, as lights of depth 0 (area emitters: ParticleWalk::leaveOnEmitter).
void addEmitters(const EmitterSampler& emitters, const LightSettings& settings, uint64_t seed,
                 VirtualLights* lights) {
  const Scene& scene = emitters.scene();
  for (uint32_t i = 0; i < scene.emitters.size(); ++i) {
    const Emitter& e = scene.emitters[i];
    if (isPointLike(e.type)) {
      const bool plain = e.type == EmitterType::point;
      lights->omni.push_back(
          {e.toWorld.point(Vec3f(0.f)), EmissionPattern(scene, e).base(), plain ? 0xffffffffu : i});
      lights->omniGroups.push_back(emitters.groups().of(i));
    }
  }
  const auto suns = sunLights(scene, kLightsPerSun, seed);
  lights->directional.insert(lights->directional.end(), suns.begin(), suns.end());
  const size_t count =
      settings.environmentLights > 0 ? settings.environmentLights : kDefaultEnvironmentLights;
  const auto environment = environmentLights(emitters, count, seed);
  lights->directional.insert(lights->directional.end(), environment.begin(), environment.end());
  for (const DirectionalLight& light : lights->directional)
    lights->directionalGroups.push_back(emitters.groups().of(light.emitter));
}

// Do the settings leave anything to particles?
bool wantsParticles(const EmitterSampler& emitters, const LightSettings& settings) {
  const int lastDepth = settings.maxDepth < 0 ? kMaxLightDepth : settings.maxDepth - 2;
  return !emitters.empty() && settings.count > 0 && lastDepth >= (settings.directAsLights ? 0 : 1);
}

// What as many particles as settings want leave, and their number.
struct Pass {
  std::vector<ParticleBatch> batches;
  uint64_t particles = 0;
};
Pass runPass(const Tracer& tracer, const EmitterSampler& emitters, const LightSettings& settings,
             Context& context) {
  Pass pass;
  pass.particles = chooseParticleCount(tracer, emitters, settings, context);
  const float scale = static_cast<float>(1.0 / static_cast<double>(pass.particles));
  const ParticleWalk walk(tracer, emitters, settings, seedOf(settings, context), kStream, scale);
  pass.batches = traceParticles(walk, pass.particles, context, true);
  countParticles(pass.batches, context);
  context.statistics.addCount("light_particles", pass.particles);
  return pass;
}

}  // namespace

VirtualLights emitterLights(const EmitterSampler& emitters, const LightSettings& settings,
                            Context& context) {
  VirtualLights lights;
  lights.model = nameOf(settings.kind);
  lights.sphereShading = settings.sphereShading;
  lights.maxDepth = settings.maxDepth;
  lights.specularLimit = settings.specularLimit;
  lights.direct = settings.directAsLights;
  lights.groups = emitters.groups().names;
  lights.seed = seedOf(settings, context);
  if (settings.directAsLights) addEmitters(emitters, settings, lights.seed, &lights);
  return lights;
}

VirtualLights makeLights(const Tracer& tracer, const EmitterSampler& emitters,
                         const LightSettings& settings, Context& context) {
  assert(settings.kind != LightKind::gaussian);
  const StageTimer timer(context, "lights");
  VirtualLights lights = emitterLights(emitters, settings, context);
  if (!wantsParticles(emitters, settings)) return lights;

  const Pass pass = runPass(tracer, emitters, settings, context);
  collect(pass.batches, &lights);
  sortByPlace(tracer.bounds(), &lights);
  if (!context.cancelled() && !lights.spherical.empty()) {
    chooseRadii(tracer, settings, &lights, context);
    coverSurfaces(tracer, &lights, context);
  }
  lights.particles = pass.particles;
  const size_t left = lights.diffuse.size() + lights.glossy.size() + lights.spherical.size();
  if (left == 0 && !context.cancelled())
    context.warning("no particle left a virtual light: lights give no indirect light");
  context.debug(fmt::format("{} particles left {} diffuse, {} glossy and {} spherical lights",
                            pass.particles, lights.diffuse.size(), lights.glossy.size(),
                            lights.spherical.size()));
  return lights;
}

std::vector<LightPoint> makeLightPoints(const Tracer& tracer, const EmitterSampler& emitters,
                                        const LightSettings& wanted, Context& context) {
  const StageTimer timer(context, "lights");
  LightSettings settings = wanted;
  settings.kind = LightKind::gaussian;
  std::vector<LightPoint> points;
  if (!wantsParticles(emitters, settings)) return points;
  const Pass pass = runPass(tracer, emitters, settings, context);
  for (const ParticleBatch& b : pass.batches)
    points.insert(points.end(), b.points.begin(), b.points.end());
  sortByGroup(&points);
  if (points.empty() && !context.cancelled())
    context.warning("no particle left a virtual light: lights give no indirect light");
  context.debug(fmt::format("{} particles left {} light points", pass.particles, points.size()));
  return points;
}

std::vector<Photon> makePhotons(const Tracer& tracer, const EmitterSampler& emitters,
                                const LightSettings& wanted, Context& context) {
  const StageTimer timer(context, "lights");
  LightSettings settings = wanted;
  settings.photons = true, settings.directAsLights = false;
  std::vector<Photon> photons;
  if (!wantsParticles(emitters, settings)) return photons;
  const Pass pass = runPass(tracer, emitters, settings, context);
  for (const ParticleBatch& b : pass.batches)
    photons.insert(photons.end(), b.photons.begin(), b.photons.end());
  context.statistics.addCount("photons", photons.size());
  if (photons.empty() && !context.cancelled())
    context.warning("no particle met a surface with rough lobes: there is no indirect light");
  return photons;
}

}  // namespace lobelia
