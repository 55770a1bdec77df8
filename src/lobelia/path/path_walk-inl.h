// The path tracer's loop, for any answerer of ray queries.
#pragma once

#include "lobelia/path/path_walk.h"

namespace lobelia {

inline Rgb absolute(Rgb c) { return {std::abs(c.x), std::abs(c.y), std::abs(c.z)}; }

inline void prefetchRead(const void* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#else
  (void)address;
#endif
}

// What surfacePoint() reads of the triangle, once its indices have arrived.
template <class Rays>
void PathWalk<Rays>::prefetch(const Hit& hit) const {
  const Scene& scene = emitters_.scene();
  const Mesh& mesh = scene[scene.instances[hit.instance].mesh];
  const Vec3u v = mesh.triangles[hit.triangle];
  for (const uint32_t i : {v.x, v.y, v.z}) {
    prefetchRead(&mesh.positions[i]);
    if (!mesh.normals.empty()) prefetchRead(&mesh.normals[i]);
    if (!mesh.uvs.empty()) prefetchRead(&mesh.uvs[i]);
  }
}

template <class Rays>
void PathWalk<Rays>::trace(std::span<PathState> paths, PathCounts& counts) const {
  constexpr size_t kMost = 64;
  if (settings_.maxDepth == 0) return;
  for (; paths.size() > kMost; paths = paths.subspan(kMost)) trace(paths.first(kMost), counts);
  PathState* active[kMost];
  size_t count = 0;
  for (PathState& path : paths) active[count++] = &path;
  const Scene& scene = emitters_.scene();
  while (count > 0) {
    counts.pathRays += count;
    for (size_t i = 0; i < count; ++i) {
      PathState& path = *active[i];
      path.hit = tracer_.intersect(path.ray);
      if (!path.hit) continue;
      const Instance& instance = scene.instances[path.hit->instance];
      prefetchRead(&scene[instance.mesh].triangles[path.hit->triangle]);
    }
    for (size_t i = 0; i < count; ++i) {
      if (active[i]->hit) prefetch(*active[i]->hit);
    }
    size_t left = 0;
    for (size_t i = 0; i < count; ++i) {
      if (advance(*active[i], counts)) active[left++] = active[i];
    }
    count = left;
  }
  for (PathState& path : paths) finish(path.result, counts);
}

template <class Rays>
void PathWalk<Rays>::meet(PathState& path, Rgb radiance, const SurfacePoint* hit) const {
  if (radiance == Rgb{} || (path.depth == 1 && settings_.hideEmitters)) return;
  radiance *= emissionWeight(emitters_, path.from, hit, path.ray.d, path.pdfFrom, path.deltaFrom,
                             path.samplesFrom);
  path.result.direct += path.metDirect * radiance;
  path.result.indirect += path.metIndirect * radiance;
}

template <class Rays>
bool PathWalk<Rays>::advance(PathState& path, PathCounts& counts) const {
  if (!path.hit) {
    meet(path, emitters_.escaped(path.ray.d), nullptr);
    return false;
  }
  const bool last = settings_.maxDepth >= 0 && path.depth >= settings_.maxDepth;
  const SurfacePoint at = surfacePoint(emitters_.scene(), *path.hit);
  const Vec3f wo = -path.ray.d;
  const Rgb inside = interiorTransmittance(emitters_.scene(), at, wo);
  path.chain *= inside, path.indirect *= inside;
  if (at.emitter.valid()) meet(path, emitters_.emitted(at, wo), &at);
  if (last && path.depth > 1) return false;
  if (settings_.component == Component::direct && path.chain == Rgb{}) return false;
  if (path.depth > settings_.rouletteDepth) {
    const float survival =
        rouletteSurvival(absolute(path.chain) + absolute(path.indirect), path.eta);
    if (!(path.random.next1D() < survival)) return false;
    path.chain /= survival;
    path.indirect /= survival;
  }

  const Bsdf bsdf = makeBsdf(emitters_.scene(), at, wo, settings_.specularLimit);
  if (path.depth == 1) {
    path.result.albedo = albedo(bsdf, wo);
    path.result.normal = bsdf.frame.n;
    path.result.depth = path.hit->t;
    if (last) return false;
  }
  path.from = lightQuery(at, bsdf, wo);
  path.samplesFrom = path.chain != Rgb{} ? std::max(settings_.directSamples, 1) : 1;

  const bool wanted = settings_.component != Component::indirect || path.indirect != Rgb{};
  if (wanted && !onlyDelta(bsdf)) {
    const float select = path.random.next1D();
    const Vec2f place = path.random.next2D();
    const Rgb light =
        sampleDirectLight(tracer_, emitters_, path.from, bsdf, wo, LobeSet::all, LobeSet::all, true,
                          {select, place.x, place.y}, &counts.shadowRays, path.samplesFrom);
    path.result.direct += path.chain * light;
    path.result.indirect += path.indirect * light;
  }

  const float uLobe = path.random.next1D();
  const auto s = sample(bsdf, wo, uLobe, path.random.next2D());
  if (!s || s->weight == Rgb{}) return false;
  const Rgb sharp = sharpPart(bsdf, wo, *s, Transport::radiance);
  path.metDirect = path.chain * s->weight;
  path.metIndirect = path.indirect * s->weight;
  path.indirect = path.metIndirect + path.chain * (s->weight - sharp);
  path.chain = path.chain * sharp;
  path.eta *= s->eta;
  path.pdfFrom = s->pdf;
  path.deltaFrom = s->delta;
  path.ray = Ray{};
  path.ray.o = offsetOrigin(at, s->wi);
  path.ray.d = s->wi;
  ++path.depth;
  return true;
}

template <class Rays>
void PathWalk<Rays>::finish(PathResult& result, PathCounts& counts) const {
  if (settings_.component == Component::direct) result.indirect = {};
  if (settings_.component == Component::indirect) result.direct = {};
  if (isFinite(result.direct) && isFinite(result.indirect)) return;
  ++counts.nonFinite;
  result.direct = result.indirect = {};
}

}  // namespace lobelia
