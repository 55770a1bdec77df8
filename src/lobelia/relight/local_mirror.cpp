#include "lobelia/relight/local_mirror.h"

namespace lobelia::relight {
namespace {

constexpr int kMostEvents = 4;  // of mirrors and panes in a row
constexpr size_t kMost = ShadowPacket::kSize;

struct MirrorRay {
  bool active = false;
  bool through = false;  // did it pass the pixel's surface?
  Ray ray;
  Rgb weight{1.f};
  Vec2f places{}, u{};
  float lobe = 0;
};

// The next ray from a surface through one of its sharp lobes.
bool advance(const SurfacePoint& at, const Bsdf& bsdf, Vec3f wo, MirrorRay* mirror) {
  mirror->active = false;
  if (!hasLobes(bsdf, LobeSet::sharp)) return false;
  const std::optional<BsdfSample> next = sample(bsdf, wo, mirror->lobe, mirror->u, LobeSet::sharp);
  if (!next || next->weight == Rgb{}) return false;
  mirror->weight *= next->weight;
  mirror->ray = Ray{};
  mirror->ray.o = offsetOrigin(at, next->wi);
  mirror->ray.d = next->wi;
  return mirror->active = true;
}

}  // namespace

uint64_t addMirrored(const LocalInput& input, std::span<LitPixel> pixels) {
  const Scene& scene = input.tracer.scene();
  MirrorRay rays[kMost];
  bool any = false;
  for (size_t i = 0; i < pixels.size(); ++i) {
    const LitPixel& pixel = pixels[i];
    rays[i].places = pixel.places, rays[i].u = pixel.mirrored, rays[i].lobe = pixel.lobe;
    any |= advance(pixel.at, pixel.bsdf, pixel.wo, &rays[i]);
    rays[i].through = dot(rays[i].ray.d, pixel.normal) < 0;
  }
  uint64_t count = 0;
  for (int event = 0; any && event < kMostEvents; ++event) {
    ShadowPacket packet{};
    for (size_t i = 0; i < pixels.size(); ++i)
      if (rays[i].active) packet.set(static_cast<int>(i), rays[i].ray), ++count;
    std::optional<Hit> hits[kMost];
    input.tracer.intersect(packet, false, hits);
    BouncePoint bounces[kMost];
    Rgb weights[kMost];
    any = false;
    for (size_t i = 0; i < pixels.size(); ++i) {
      bounces[i].at.asked = false;
      if (!rays[i].active) continue;
      const Vec3f wo = -rays[i].ray.d;
      if (!hits[i]) {
        if (input.settings.direct && (!input.settings.add || rays[i].through))
          pixels[i].sum += rays[i].weight * escaped(input, -wo);
        rays[i].active = false;
        continue;
      }
      const SurfacePoint at = surfacePoint(scene, *hits[i]);
      if (input.settings.direct) pixels[i].sum += rays[i].weight * input.emitters.emitted(at, wo);
      bounces[i] = bouncePoint(scene, at, wo, rays[i].places, kSmoothest);
      weights[i] = rays[i].weight;
      any |= advance(at, makeBsdf(scene, at, wo, kSmoothest), wo, &rays[i]);
    }
    if (!input.settings.bounced) continue;
    Rgb radiance[kMost];
    count += bouncedLight(input.tracer, input.sources, {bounces, pixels.size()}, 1,
                          {radiance, pixels.size()});
    for (size_t i = 0; i < pixels.size(); ++i) pixels[i].sum += weights[i] * radiance[i];
  }
  return count;
}

}  // namespace lobelia::relight
