// Final gathering [Jensen01 chapters 7 to 9]: a receiver x samples its rough lobes; the rough lobes
// of the surface y that a ray meets scatter the photons around y,
//     L(y, w) = sum over photons of  f(w, wi) |ns.wi| / |ng.wi|  power / area,
// which arrive by the geometric normal ng and are scattered by the shading normal ns. Photons stand
// where virtual lights would: light is split as for these (docs/architecture.md), so that emission
// met at y is direct light, sampled at x, and sharp lobes at y extend the eye's paths, as specular
// connections (path/receiver_walk.cpp). Photons that came over mirrors and glass (the book's
// caustics) are in the same map.
//
// The estimate is blurred over the area and darkens at edges; both fall with more photons. The book
// reads its map at once where a ray is short and shoots a second generation of rays; here a short
// ray reads the map as any other does.
#include "lobelia/gather/final_gather.h"

#include "lobelia/base/random.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/lights/virtual_lights.h"

namespace lobelia {
namespace {

constexpr uint64_t kStream = 0x66696e616cull;
constexpr float kLeastCosine = 1e-3f;  // of |ng.wi|, against photons along the surface

class FinalGather {
 public:
  FinalGather(const Tracer& tracer, const Receivers& receivers, const PhotonMap& photons,
              const FinalGatherSettings& settings, uint64_t seed)
      : tracer_(tracer),
        receivers_(receivers),
        photons_(photons),
        settings_(settings),
        seed_(hashCombine(seed, kStream)) {}

  Rgb at(const ReceiverPoint& point, uint64_t stream, Rgb* groups,
         ReceiverRayCounts* counts) const {
    // The receiver's edges, that of the ray, the photon's.
    const int mostDepth = settings_.maxDepth < 0 ? -1 : settings_.maxDepth - 1 - point.depth;
    if (settings_.maxDepth >= 0 && mostDepth < 1) return {};
    const Bsdf bsdf = receiverBsdf(receivers_, point);
    const int count = std::max(settings_.rayCount, 1);
    PhotonsFound found;
    Rgb sum{};
    for (int i = 0; i < count; ++i) {
      Sampler random(seed_, stream, static_cast<uint32_t>(settings_.rays.sample * count + i));
      const float uLobe = random.next1D();
      const auto s = sample(bsdf, point.wo, uLobe, random.next2D(), LobeSet::rough);
      if (!s) continue;
      ++counts->pathRays;
      const auto hit =
          tracer_.intersect({offsetOrigin(point.p, point.ng, point.error, s->wi), s->wi});
      if (!hit) continue;
      const Rgb factor = s->weight / static_cast<float>(count);
      sum += factor * scattered(*hit, -s->wi, mostDepth, factor, groups, &found);
    }
    return sum;
  }

 private:
  // Radiance that leaves the hit along w; times factor, it is added to the groups.
  Rgb scattered(const Hit& hit, Vec3f w, int mostDepth, Rgb factor, Rgb* groups,
                PhotonsFound* found) const {
    const Scene& scene = tracer_.scene();
    const SurfacePoint at = surfacePoint(scene, hit);
    const Bsdf bsdf = makeBsdf(scene, at, w, settings_.specularLimit);
    if (!hasLobes(bsdf, LobeSet::rough)) return {};
    photons_.find({at.p, at.ng, mostDepth, settings_.nearest, settings_.maxRadius}, found);
    if (found->entries.empty()) return {};
    const Rgb scale = interiorTransmittance(scene, at, w) / found->area;
    Rgb sum{};
    for (const PhotonsFound::Entry& entry : found->entries) {
      const Photon& photon = photons_.photons()[entry.index];
      const Vec3f wi = decodeOctahedral(photon.wi);
      const Rgb f = evaluate(bsdf, w, wi, LobeSet::rough);
      if (f == Rgb{}) continue;
      const Rgb value = scale * f * photon.power / std::max(std::abs(dot(wi, at.ng)), kLeastCosine);
      sum += value;
      if (groups != nullptr) groups[photon.group()] += factor * value;
    }
    return sum;
  }

  const Tracer& tracer_;
  const Receivers& receivers_;
  const PhotonMap& photons_;
  const FinalGatherSettings& settings_;
  const uint64_t seed_;
};

}  // namespace

void finalGather(const Tracer& tracer, const Receivers& receivers, const PhotonMap& photons,
                 const FinalGatherSettings& settings, std::span<Rgb> radiance, Context& context,
                 GatherParts* parts) {
  const FinalGather gather(tracer, receivers, photons, settings, context.seed);
  lightReceivers(
      receivers, settings.rays,
      [&](const ReceiverPoint& point, uint64_t stream, Rgb* groups, ReceiverRayCounts* counts) {
        return gather.at(point, stream, groups, counts);
      },
      "final_gather", radiance, context, parts);
}

}  // namespace lobelia
