// Absorption inside of closed dielectrics (Beer-Lambert).
//
// Nothing is remembered along a path: one that meets an absorbing surface from behind was inside of
// it for the whole length of its last edge. That holds for closed surfaces that do not overlap;
// others inside (a stone in a glass) leave the edges that end on them unabsorbed. Neither are the
// edges of direct light, nor those between virtual lights and receivers: an interface that refracts
// blocks both anyway, so that only what is itself inside loses by it.
#include <cmath>

#include "lobelia/scene/material_lobes.h"
#include "lobelia/scene/shading.h"

namespace lobelia {
namespace {

// Absorption per unit length of what lies behind the surface.
Rgb absorptionOf(const Scene& scene, MaterialHandle handle, const TextureContext& at, int depth) {
  if (!handle.valid() || depth > kMaxNesting) return {};
  const Material& m = scene[handle];
  switch (m.type) {
    case MaterialType::dielectric:
    case MaterialType::roughDielectric:
      return m.absorption;
    case MaterialType::metallicRoughness:
      return m.thin ? Rgb(0.f) : m.absorption;
    case MaterialType::twoSided:
    case MaterialType::mask:
    case MaterialType::bump:
    case MaterialType::normalMap:
      return absorptionOf(scene, m.a, at, depth + 1);
    case MaterialType::blend: {
      const float w = std::clamp(evaluate(scene, m.weight, at), 0.f, 1.f);
      return absorptionOf(scene, m.a, at, depth + 1) * (1 - w) +
             absorptionOf(scene, m.b, at, depth + 1) * w;
    }
    default:
      return {};
  }
}

}  // namespace

Rgb interiorTransmittance(const Scene& scene, const SurfacePoint& at, Vec3f wo) {
  if (!(dot(at.ng, wo) < 0)) return Rgb(1.f);
  const Rgb a = absorptionOf(scene, at.material, at.texture, 0);
  if (a == Rgb(0.f)) return Rgb(1.f);
  return {std::exp(-a.x * at.t), std::exp(-a.y * at.t), std::exp(-a.z * at.t)};
}

}  // namespace lobelia
