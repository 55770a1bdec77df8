// Sampling of single lobes and its density. Directions in the lobe's frame (n = +z).
#pragma once

#include <optional>

#include "lobelia/base/vec.h"
#include "lobelia/bsdf/lobe.h"

namespace lobelia {

// Direction drawn from a non-delta lobe for an active wo; nothing where the sample is lost (below
// the horizon, total internal reflection).
std::optional<Vec3f> sampleLobe(const Lobe& lobe, Vec3f wo, Vec2f u);
// Density of sampleLobe() per solid angle of wi.
float lobePdf(const Lobe& lobe, Vec3f wo, Vec3f wi);

// evaluateLobe() (radiance) and lobePdf() at once.
struct LobeValue {
  Rgb value{};
  float pdf = 0;
};
LobeValue evaluateWithPdf(const Lobe& lobe, Vec3f wo, Vec3f wi);

// A rough interface: reflection and transmission of the same micro-normals, chosen between by the
// Fresnel reflectance of the normal. u1 chooses.
std::optional<Vec3f> sampleInterface(const Lobe& reflection, const Lobe& transmission, Vec3f wo,
                                     float u1, Vec2f u);
float interfacePdf(const Lobe& reflection, const Lobe& transmission, Vec3f wo, Vec3f wi);

// Mirror direction of w at m; refracted direction for eta = n(other side) / n(side of w), nothing
// under total internal reflection. m on w's side.
Vec3f reflect(Vec3f w, Vec3f m);
std::optional<Vec3f> refract(Vec3f w, Vec3f m, float eta);

}  // namespace lobelia
