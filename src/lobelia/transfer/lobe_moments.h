// What lobes reflect in all and in which direction on average, by quadrature.
#pragma once

#include <optional>
#include <vector>

#include "lobelia/bsdf/lobe.h"

namespace lobelia::transfer {

// Of f cos over the directions of the upper hemisphere.
struct LobeMoments {
  Rgb albedo{};
  Vec3f first{};  // integral of the directions by luminance, world
  void add(const LobeMoments& m) { albedo += m.albedo, first += m.first; }
};

// A direction of a glossy lobe's quadrature.
struct LobePoint {
  Vec3f w;           // world, unit
  Rgb weight;        // f cos times the solid angle that it stands for
  float solidAngle;  // that solid angle
};

// Of one glossy lobe of the Bsdf for a wo on any side: points where the lobe's own sampler puts
// them for the points of a lattice, with what bump maps take away. `count`: a power of two. Error
// of the albedo: some 1 / count for lobes above the horizon, count^(-3/4) where it cuts them off.
// Appends at most count points.
void quadraturePoints(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, uint32_t count,
                      std::vector<LobePoint>* points);

LobeMoments glossyMoments(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo, uint32_t count);

// Those of a lobe and of another that is like it in shape, by the same points, which are the
// other's: for the ratio. What bump maps take away is in the first alone.
struct MomentPair {
  LobeMoments own, other;
};
MomentPair momentPair(const Bsdf& bsdf, const Lobe& lobe, const Lobe& other, Vec3f wo,
                      uint32_t count);

// Albedo of a lobe from tables, within .5 % of quadrature; empty where these are only estimates
// (anisotropic lobes, interfaces seen from inside, lobes under layers or under bump maps).
std::optional<Rgb> closedAlbedo(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo);

// Albedo of a Bsdf's diffuse lobes towards wo, within .5 %.
Rgb diffuseAlbedo(const Bsdf& bsdf, Vec3f wo);

}  // namespace lobelia::transfer
