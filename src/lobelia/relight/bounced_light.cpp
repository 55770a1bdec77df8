#include "lobelia/relight/bounced_light.h"

#include <atomic>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/bsdf/albedo.h"
#include "lobelia/relight/lobe_reach.h"

namespace lobelia::relight {
namespace {

constexpr uint32_t kNoInstance = 0xffffffffu;
constexpr float kMeanCosine = 2.f / 3;  // of even light, weighted by its own cosine
constexpr uint64_t kStream = 0x626f756e;
constexpr float kAgree = 0.9f;  // cosine between a sample's normal and that of its place

Rgb diffuseAlbedo(const Bsdf& bsdf, Vec3f wo) {
  Rgb sum{};
  for (int l = 0; l < bsdf.lobeCount; ++l) {
    const Lobe& lobe = bsdf.lobes[l];
    if (!isTransmission(lobe.type) && !isMirror(lobe) && !lobe.sharp)
      sum += lobeAlbedo(lobe, dot(bsdf.frameOf(lobe).n, wo));
  }
  return sum;
}

// A direction at the mean angle, on the side of a normal.
Vec3f meanDirection(Vec3f n) {
  const Frame frame = frameFromNormal(n);
  return frame.n * kMeanCosine + frame.s * std::sqrt(1 - kMeanCosine * kMeanCosine);
}

}  // namespace

BouncePoint bouncePoint(const Scene& scene, const SurfacePoint& at, Vec3f side, Vec2f numbers,
                        float followed) {
  BouncePoint point;
  const bool behind = dot(at.ng, side) < 0;
  point.at = {at.p, behind ? -at.ng : at.ng, at.error, numbers};
  point.n = behind ? -at.frame.n : at.frame.n;
  const Vec3f wo = meanDirection(point.n);
  const Bsdf bsdf = makeBsdf(scene, at, wo, followed);
  point.albedo = diffuseAlbedo(bsdf, wo);
  point.at.asked = point.albedo != Rgb{};
  return point;
}

uint64_t bouncedLight(const Tracer& tracer, const LocalSources& sources,
                      std::span<const BouncePoint> points, int areaPlaces,
                      std::span<Rgb> radiance) {
  LitPoint lit[ShadowPacket::kSize];
  for (size_t i = 0; i < points.size(); ++i) lit[i] = points[i].at, radiance[i] = Rgb{};
  return addLocalLight(tracer, sources, {lit, points.size()}, areaPlaces, radiance,
                       [&](size_t i, Vec3f wi, Rgb value, bool /*point*/) {
                         const BouncePoint& point = points[i];
                         const float cosine = dot(point.n, wi);
                         if (!(cosine > 0) || !(dot(point.at.ng, wi) > 0)) return Rgb{};
                         return value * point.albedo * (cosine * (1 / kPi));
                       });
}

SampleSurfaces::SampleSurfaces(const Tracer& tracer, const LightSamples& samples)
    : hits_(samples.count()), normals_(samples.n) {
  const float diagonal = length(tracer.bounds().extent());
  std::atomic<size_t> lost = 0;
  parallelFor(samples.count(), 256, [&](size_t i) {
    // Samples lie off their surface by the error of its places.
    Ray ray;
    ray.o = samples.p[i] + samples.n[i] * (1e-6f * diagonal);
    ray.d = -samples.n[i];
    ray.tMax = 1e-4f * diagonal;
    const std::optional<Hit> hit = tracer.intersect(ray);
    hits_[i] = hit.value_or(Hit{});
    if (hit) {
      const SurfacePoint at = surfacePoint(tracer.scene(), *hit);
      if (std::abs(dot(at.ng, samples.n[i])) >= kAgree) return;
      hits_[i].instance = kNoInstance;
    }
    ++lost;
  });
  lost_ = lost;
}

std::vector<Rgb> SampleSurfaces::radiance(const Tracer& tracer, const LocalSources& sources,
                                          int areaPlaces, Context& context) const {
  constexpr size_t kBlock = ShadowPacket::kSize;
  std::vector<Rgb> out(hits_.size());
  std::atomic<uint64_t> rays = 0;
  parallelFor((hits_.size() + kBlock - 1) / kBlock, 16, [&](size_t block) {
    const size_t first = block * kBlock, count = std::min(kBlock, hits_.size() - first);
    BouncePoint points[kBlock];
    for (size_t i = 0; i < count; ++i) {
      const Hit& hit = hits_[first + i];
      points[i].at.asked = false;
      if (hit.instance == kNoInstance) continue;
      Sampler random(hashCombine(context.seed, kStream), first + i, 0);
      points[i] = bouncePoint(tracer.scene(), surfacePoint(tracer.scene(), hit),
                              normals_[first + i], random.next2D(), 0);
    }
    rays += bouncedLight(tracer, sources, {points, count}, areaPlaces, {out.data() + first, count});
  });
  context.statistics.addCount("light_rays", rays);
  return out;
}

}  // namespace lobelia::relight
