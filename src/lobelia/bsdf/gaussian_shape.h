// Shape of a glossy lobe as a sum of spherical Gaussians, without its energy: the parts that
// expand() (bsdf/gaussians.h) scales. In the lobe's frame, with wo on the front side (z > 0).
#pragma once

#include <array>
#include <span>

#include "lobelia/bsdf/lobe.h"

namespace lobelia {

inline constexpr size_t kMaxParts = 32;
struct ShapePart {
  Vec3f axis;
  float sharpness;
  float share;  // of the energy; the shares of a lobe sum to one
};

// Co-axial Gaussians that fit the distribution of micro-normals, reflected at normal incidence:
// `width` is sharpness * alpha^2 of the reflected lobe (Beckmann: 1/2). Narrow ones first.
struct ShapeComponent {
  float share, width;
};
inline constexpr int kMaxShapeComponents = 3;
struct ShapeComponents {
  int count = 0;
  std::array<ShapeComponent, kMaxShapeComponents> parts;
};
ShapeComponents componentsOf(Distribution distribution, float alpha, int limit);

// Writes at most parts.size() (1 to kMaxParts) Gaussians and returns their number; 0 when the lobe
// sends nothing out. `behind`: the interface is seen from inside. One part alone is the paper's
// form: at the mirror (or refracted) direction, width by the spherical warp [P000 section 3].
int shapeOf(const Lobe& lobe, Vec3f wo, bool behind, std::span<ShapePart> parts);

// The same without tables (gaussian_mixture.h), for any lobe: rows of Gaussians in closed form.
int rowShape(const Lobe& lobe, Vec3f wo, bool behind, std::span<ShapePart> parts);

// Energy that the lobe sends out for light arriving from wo (any side): its directional albedo.
// From tables for isotropic reflection; by a small fixed quadrature, about 0.5 %, where those are
// only estimates (anisotropic lobes, transmission).
Rgb glossyEnergy(const Lobe& lobe, Vec3f wo);

}  // namespace lobelia
