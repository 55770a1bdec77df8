// Mitsuba 3's spot (falls linearly in the angle; its picture lies on the tangent plane of the
// cutoff) and projector (its picture lies on the plane at distance one, with square pixels). The
// twin that path tracing samples is path/finite_lights.cpp.
#include "lobelia/gather/emission_pattern.h"

#include <cmath>

namespace lobelia::gather {
namespace {

Rgb spotPattern(const Scene& scene, const Emitter& emitter, Vec3f local) {
  const float cosine = local.z / length(local);
  const float angle = std::acos(std::min(cosine, 1.f));
  if (!(angle < emitter.cutoff)) return {};
  Rgb pattern(1.f);
  if (angle > emitter.beamWidth)
    pattern *= (emitter.cutoff - angle) / (emitter.cutoff - emitter.beamWidth);
  if (emitter.pattern.valid()) {
    const float scale = 0.5f / (local.z * std::tan(emitter.cutoff));
    TextureContext at;
    at.uv = {0.5f + local.x * scale, 0.5f + local.y * scale};
    pattern *= evaluate(scene, emitter.pattern, at);
  }
  return pattern;
}

float aspectRatio(const Scene& scene, TextureHandle texture) {
  while (texture.valid() && scene[texture].type == TextureType::scale) texture = scene[texture].a;
  if (!texture.valid() || !scene[texture].image.valid()) return 1;
  const Image& image = scene[scene[texture].image];
  return static_cast<float>(image.width) / static_cast<float>(image.height);
}

Rgb projectorPattern(const Scene& scene, const Emitter& emitter, Vec3f local) {
  if (!(local.z > 0)) return {};
  const float tanX = std::tan(0.5f * emitter.fov);
  const float tanY = tanX / aspectRatio(scene, emitter.radiance.texture);
  TextureContext at;
  at.uv = {0.5f - 0.5f * local.x / (local.z * tanX), 0.5f - 0.5f * local.y / (local.z * tanY)};
  if (at.uv.x < 0 || at.uv.x > 1 || at.uv.y < 0 || at.uv.y > 1) return {};
  const float cosine = local.z / length(local);
  return evaluate(scene, emitter.radiance, at) / (cosine * cosine * cosine);
}

}  // namespace

Rgb emissionPattern(const Scene& scene, uint32_t index, Vec3f direction) {
  const Emitter& emitter = scene.emitters[index];
  const Vec3f local = emitter.toWorld.from.vector(direction);
  if (emitter.type == EmitterType::spot) return spotPattern(scene, emitter, local);
  if (emitter.type == EmitterType::projector) return projectorPattern(scene, emitter, local);
  return Rgb(1.f);
}

}  // namespace lobelia::gather
