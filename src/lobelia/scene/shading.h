// From a hit to what shading needs: position, normals, uv, frame, and the Bsdf value.
#pragma once

#include <cmath>

#include "lobelia/bsdf/lobe.h"
#include "lobelia/scene/scene.h"

namespace lobelia {

// What an acceleration structure returns. b1, b2: barycentrics of vertices 1 and 2.
struct Hit {
  float t = 0;
  float b1 = 0, b2 = 0;
  uint32_t instance = 0xffffffffu;
  uint32_t triangle = 0;
};

struct SurfacePoint {
  Vec3f p;
  Vec3f ng;     // unit, outside (orientation of the mesh after flipNormals)
  Frame frame;  // shading frame: n interpolated, s along dp/du
  Vec3f dpdu, dpdv;
  Vec2f uv;
  float t = 0;
  uint32_t instance = 0;
  MaterialHandle material;
  EmitterHandle emitter;
  TextureContext texture;
  float error = 0;  // absolute position error to keep away from the surface by
};

SurfacePoint surfacePoint(const Scene& scene, const Hit& hit);
// Its normals alone, at a fraction of the price: ng, and the interpolated one.
struct SurfaceNormals {
  Vec3f ng{}, n{};  // unit
};
SurfaceNormals surfaceNormals(const Scene& scene, const Hit& hit);
// Material to Bsdf at a point seen from wo; lobes classified by the specular limit (roughness).
// Opacity is not a lobe: rays pass masks stochastically (trace/tracer.h).
// light: the side of emission is not considered here.
Bsdf makeBsdf(const Scene& scene, const SurfacePoint& at, Vec3f wo, float specularLimit);
// What the inside of a closed dielectric leaves of light on the edge of length at.t that ends here,
// coming from wo: exp(-absorption t) from behind, 1 from outside (scene/absorption.cpp).
Rgb interiorTransmittance(const Scene& scene, const SurfacePoint& at, Vec3f wo);
// Probability that a ray stops at this hit: the mask's opacity; 0 for `null`.
float opacity(const Scene& scene, MaterialHandle material, const TextureContext& at);
bool hasOpacity(const Scene& scene, MaterialHandle material);  // is it ever below one?

// Origin moved off the surface to the side of `direction`, far enough not to hit it again and no
// farther (about 1e-6 of the coordinates' size; at.error).
inline Vec3f offsetOrigin(Vec3f p, Vec3f ng, float error, Vec3f direction) {
  return p + ng * std::copysign(error, dot(ng, direction));
}
inline Vec3f offsetOrigin(const SurfacePoint& at, Vec3f direction) {
  return offsetOrigin(at.p, at.ng, at.error, direction);
}

}  // namespace lobelia
