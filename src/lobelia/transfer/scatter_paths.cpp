#include "lobelia/transfer/scatter_paths.h"

#include <limits>

#include "lobelia/transfer/reflection.h"
#include "lobelia/transfer/transfer_data.h"

namespace lobelia::transfer {
namespace {

struct Reflected {
  BsdfSample sample;
  bool diffuse = false;
};

// By the glossy or the diffuse part, in proportion to their albedos.
std::optional<Reflected> reflect(const Bsdf& bsdf, Vec3f wo, Sampler& random) {
  const Bsdf parts[] = {glossyPart(bsdf), diffusePart(bsdf)};
  const float albedos[] = {luminance(albedo(parts[0], wo)), luminance(albedo(parts[1], wo))};
  const float sum = albedos[0] + albedos[1];
  if (!(sum > 0)) return {};
  const size_t chosen = random.next1D() * sum < albedos[0] ? 0 : 1;
  const float lobe = random.next1D();
  std::optional<BsdfSample> drawn = sample(parts[chosen], wo, lobe, random.next2D());
  if (!drawn) return {};
  drawn->weight *= sum / albedos[chosen];
  return Reflected{*drawn, chosen == 1};
}

}  // namespace

std::optional<PathEnd> ScatterPaths::follow(Vec3f from, Vec3f d, Sampler& random) {
  const Scene& scene = tracer_.scene();
  PathEnd end;
  bool diffuse = false;
  for (;; ++end.reflections) {
    ++segments_;
    const auto hit = tracer_.intersect({from, d, 0, std::numeric_limits<float>::infinity()});
    if (!hit) break;
    if (end.reflections == most_) return {};
    const SurfacePoint at = surfacePoint(scene, *hit);
    if (end.reflections == 0)
      end.lobeClass = static_cast<size_t>(classOf(at.material, classCount_));
    const auto next = reflect(makeBsdf(scene, at, -d, 0), -d, random);
    if (!next) return {};
    diffuse |= next->diffuse;
    end.weight = end.weight * next->sample.weight;
    d = next->sample.wi;
    from = offsetOrigin(at, d);
  }
  end.d = d;
  if (diffuse) end.lobeClass = static_cast<size_t>(classCount_);
  return end;
}

}  // namespace lobelia::transfer
