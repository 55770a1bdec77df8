// The path tracer's loop, for any answerer of ray queries.
#pragma once

#include "lobelia/base/prefetch.h"
#include "lobelia/path/path_observer.h"
#include "lobelia/path/path_walk.h"
#include "lobelia/trace/flush_denormals.h"

namespace lobelia {

inline Rgb absolute(Rgb c) { return {std::abs(c.x), std::abs(c.y), std::abs(c.z)}; }

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

// The numbers that choose emitters come first, so that what they choose is on its way from memory
// while the hits are dealt with.
template <class Rays>
void PathWalk<Rays>::chooseLights(std::span<PathState* const> paths) const {
  const bool scattered = emitters_.scattered();
  std::vector<Vec3f> numbers;
  for (PathState* path : paths) {
    const float select = path->random.next1D();
    const Vec2f place = path->random.next2D();
    path->lightNumbers = {select, place.x, place.y};
    if (!scattered || !path->hit) continue;
    const int count = directSamples(*path);
    for (int i = 0; i < count; ++i)
      numbers.push_back(directLightNumbers(path->lightNumbers, i, count));
  }
  if (scattered) emitters_.prefetch(numbers);
}

template <class Rays>
void PathWalk<Rays>::trace(std::span<PathState> paths, PathCounts& counts) const {
  if (settings_.maxDepth == 0) return;
  Shadows shadows;
  while (!paths.empty()) {
    // Whole pixels, as many as there is room for.
    size_t count = std::min(kMost, paths.size());
    if (count < paths.size()) {
      size_t whole = count;
      while (whole > 0 && paths[whole].pixel == paths[whole - 1].pixel) --whole;
      if (whole > 0) count = whole;
    }
    traceSome(paths.first(count), shadows, counts);
    paths = paths.subspan(count);
  }
}

template <class Rays>
void PathWalk<Rays>::traceSome(std::span<PathState> paths, Shadows& shadows,
                               PathCounts& counts) const {
  PathState* active[kMost];
  size_t count = 0;
  for (PathState& path : paths) active[count++] = &path;
  const Scene& scene = emitters_.scene();
  for (bool first = true; count > 0; first = false) {
    counts.pathRays += count;
    if (first) intersectFirst(paths);
    {
      const FlushDenormals flush;
      for (size_t i = 0; i < count; ++i) {
        PathState& path = *active[i];
        if (!first) path.hit = tracer_.intersect(path.ray);
        if (!path.hit) continue;
        const Instance& instance = scene.instances[path.hit->instance];
        prefetchRead(&scene[instance.mesh].triangles[path.hit->triangle]);
      }
    }
    for (size_t i = 0; i < count; ++i) {
      if (active[i]->hit) prefetch(*active[i]->hit);
    }
    chooseLights(std::span(active, count));
    size_t left = 0;
    shadows.clear();
    for (size_t i = 0; i < count; ++i) {
      if (advance(*active[i], shadows)) active[left++] = active[i];
    }
    traceShadows(shadows, counts);
    count = left;
  }
  for (PathState& path : paths) {
    if (settings_.observer) settings_.observer->ended(path);
    finish(path, counts);
  }
}

// Where the run of equal pixels that starts at `first` ends.
template <class Range, class PixelOf>
size_t endOfPixel(const Range& range, size_t first, size_t most, const PixelOf& pixelOf) {
  size_t end = first + 1;
  while (end < range.size() && end - first < most && pixelOf(range[end]) == pixelOf(range[first])) {
    ++end;
  }
  return end;
}

template <class Rays>
void PathWalk<Rays>::intersectFirst(std::span<PathState> paths) const {
  constexpr size_t kLanes = ShadowPacket::kSize;
  for (size_t i = 0, end; i < paths.size(); i = end) {
    end = endOfPixel(paths, i, kLanes, [](const PathState& path) { return path.pixel; });
    if (end - i == 1) {
      paths[i].hit = tracer_.intersect(paths[i].ray);
      continue;
    }
    ShadowPacket packet{};
    for (size_t k = i; k < end; ++k) packet.set(static_cast<int>(k - i), paths[k].ray);
    std::optional<Hit> hits[kLanes];
    tracer_.intersect(packet, true, hits);
    for (size_t k = i; k < end; ++k) paths[k].hit = hits[k - i];
  }
}

template <class Rays>
void PathWalk<Rays>::traceShadows(const Shadows& shadows, PathCounts& counts) const {
  counts.shadowRays += shadows.size();
  const FlushDenormals flush;
  std::vector<const PathShadow*> seen;
  for (const PathShadow& shadow : shadows) {
    if (shadow.seen) {
      seen.push_back(&shadow);
    } else if (!tracer_.occluded(shadow.ray)) {
      lit(shadow);
    }
  }
  for (size_t i = 0, end; i < seen.size(); i = end) {
    end = endOfPixel(seen, i, seen.size(), [](const PathShadow* s) { return s->path->pixel; });
    tracePixel(std::span(seen).subspan(i, end - i));
  }
}

// The first emitter samples of all points together, then their second ones ...: they are stratified
// over the emitters.
template <class Rays>
void PathWalk<Rays>::tracePixel(std::span<const PathShadow* const> shadows) const {
  constexpr size_t kLanes = ShadowPacket::kSize;
  const PathShadow* lanes[kLanes];
  size_t filled = 0, done = 0;
  for (int sample = 0; done < shadows.size(); ++sample) {
    for (const PathShadow* shadow : shadows) {
      if (shadow->sample != sample) continue;
      lanes[filled++] = shadow, ++done;
      if (filled < kLanes && done < shadows.size()) continue;
      tracePacket(std::span(lanes, filled));
      filled = 0;
    }
  }
}

template <class Rays>
void PathWalk<Rays>::tracePacket(std::span<const PathShadow* const> shadows) const {
  if (shadows.size() == 1) {
    if (!tracer_.occluded(shadows[0]->ray)) lit(*shadows[0]);
    return;
  }
  ShadowPacket packet{};
  for (size_t i = 0; i < shadows.size(); ++i) packet.set(static_cast<int>(i), shadows[i]->ray);
  const uint32_t visible = tracer_.visible(packet, true);
  for (size_t i = 0; i < shadows.size(); ++i) {
    if ((visible >> i & 1) != 0) lit(*shadows[i]);
  }
}

template <class Rays>
void PathWalk<Rays>::lit(const PathShadow& shadow) const {
  shadow.add();
  if (settings_.observer) settings_.observer->lit(shadow);
}

template <class Rays>
void PathWalk<Rays>::escape(PathState& path) const {
  if (path.deltaFrom) return meet(path, emitters_.escaped(path.ray.d), nullptr);
  float pdf;
  const Rgb radiance = emitters_.escaped(path.ray.d, path.from.n, &pdf);
  meet(path, radiance * emissionWeight(path.pdfFrom, pdf, path.samplesFrom), nullptr);
}

// radiance: weighed against emitter samples.
template <class Rays>
void PathWalk<Rays>::meet(PathState& path, Rgb radiance, const SurfacePoint* hit) const {
  if (radiance == Rgb{} || (path.depth == 1 && settings_.hideEmitters)) return;
  if (settings_.observer)
    settings_.observer->met(path, path.metDirect * radiance, path.metIndirect * radiance);
  const Rgb direct = path.metDirect * radiance, indirect = path.metIndirect * radiance;
  path.result.direct += direct;
  path.result.indirect += indirect;
  path.groups.add(hit ? hit->emitter.index : EmitterSampler::kEscaped, path.ray.d, direct,
                  indirect);
}

template <class Rays>
bool PathWalk<Rays>::advance(PathState& path, Shadows& shadows) const {
  if (!path.hit) {
    escape(path);
    return false;
  }
  const bool last = settings_.maxDepth >= 0 && path.depth >= settings_.maxDepth;
  const SurfacePoint at = surfacePoint(emitters_.scene(), *path.hit);
  const Vec3f wo = -path.ray.d;
  const Rgb inside = interiorTransmittance(emitters_.scene(), at, wo);
  path.chain *= inside, path.indirect *= inside;
  if (at.emitter.valid()) {
    const Rgb radiance = emitters_.emitted(at, wo);
    if (radiance != Rgb{}) {
      meet(path,
           radiance * emissionWeight(emitters_, path.from, &at, path.ray.d, path.pdfFrom,
                                     path.deltaFrom, path.samplesFrom),
           &at);
    }
  }
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
  if (settings_.observer) settings_.observer->vertex(path, at, bsdf);
  if (path.depth == 1 && described_) {
    path.result.albedo = albedo(bsdf, wo);
    path.result.normal = bsdf.frames[0].n;
    path.result.depth = path.hit->t;
  }
  if (last) return false;
  path.from = lightQuery(at, bsdf, wo);
  path.samplesFrom = directSamples(path);

  const bool wanted = settings_.component != Component::indirect || path.indirect != Rgb{};
  if (wanted && !onlyDelta(bsdf)) light(path, bsdf, wo, shadows);

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
void PathWalk<Rays>::light(PathState& path, const Bsdf& bsdf, Vec3f wo, Shadows& shadows) const {
  sampleDirectLight(emitters_, path.from, bsdf, wo, LobeSet::all, LobeSet::all, true,
                    path.lightNumbers, path.samplesFrom,
                    [&](int sample, const EmitterDirection& light, Rgb value) {
                      ++path.shadowRays;
                      PathShadow& shadow = shadows.emplace_back();  // filled where it stays
                      shadow.ray = shadowRay(path.from, light);
                      shadow.path = &path;
                      shadow.sample = sample;
                      shadow.seen = path.chain != Rgb{};
                      shadow.direct = path.chain * value, shadow.indirect = path.indirect * value;
                      shadow.emitter = light.emitter;
                    });
}

template <class Rays>
void PathWalk<Rays>::finish(PathState& path, PathCounts& counts) const {
  PathResult& result = path.result;
  if (settings_.component == Component::direct) result.indirect = {};
  if (settings_.component == Component::indirect) result.direct = {};
  if (isFinite(result.direct) && isFinite(result.indirect)) return;
  ++counts.nonFinite;
  counts.firstBad = std::min(counts.firstBad, path.pixel);
  result.direct = result.indirect = {};
}

}  // namespace lobelia
