// An isotropic lobe without Fresnel factor, layers and bumps has an albedo and a mean direction
// that depend on its roughness and the elevation of wo alone: tables. What these factors change is
// smooth over the lobe, so that the ratio to the bare lobe is known from few points. Anisotropic
// lobes have no tables, nor do interfaces seen from inside, where total
// reflection begins within the lobe: these get more points.
#include "lobelia/transfer/quick_moments.h"

#include <array>
#include <cmath>
#include <mutex>
#include <optional>

#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/albedo_grid.h"
#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {
namespace {

constexpr uint32_t kTablePoints = 1024, kRatioPoints = 64, kAnisotropicPoints = 512,
                   kInsidePoints = 1024;

// What the mean direction has of the mirror direction and of the normal.
using Grid = AlbedoGrid<2>;

// Roughness as the grids have it; Phong's as the albedo's.
float alphaOf(const Lobe& lobe) {
  return lobe.type == LobeType::phong ? std::sqrt(2 / (lobe.alphaX + 2)) : lobe.alphaX;
}
void setAlpha(Lobe* lobe, float alpha) {
  lobe->alphaX = lobe->alphaY =
      lobe->type == LobeType::phong ? std::max(2 / (alpha * alpha) - 2, 0.f) : alpha;
}

Grid makeGrid(const Lobe& kind) {
  // Spherical Gaussians go on to a roughness of 2 (bsdf/captured.h).
  const float most = kind.distribution == Distribution::sphericalGaussian ? 2.f : 1.f;
  return Grid(33, 18, kLeastAlpha, most, [&](float cosine, float alpha) {
    Bsdf bsdf;
    bsdf.add(kind);
    setAlpha(&bsdf.lobes[0], alpha);
    const float z = std::min(cosine, 1 - 5e-5f), sine = std::sqrt(1 - z * z);
    const LobeMoments moments = glossyMoments(bsdf, bsdf.lobes[0], {sine, 0, z}, kTablePoints);
    const float energy = luminance(moments.albedo);
    if (!(energy > 0)) return Grid::Entry{1, 0};
    const Vec3f mean = moments.first / energy;
    return Grid::Entry{-mean.x / sine, mean.z + mean.x / sine * z};
  });
}

// Of the kinds that differ in more than roughness; `lobe` is bare.
const Grid& gridOf(const Lobe& lobe) {
  constexpr size_t kDistributions = 5, kKinds = kDistributions + 3 + 1;
  static std::array<std::once_flag, kKinds> made;
  static std::array<std::optional<Grid>, kKinds> grids;
  const size_t kind = lobe.type == LobeType::microfacetReflection
                          ? static_cast<size_t>(lobe.distribution)
                      : lobe.type == LobeType::ward ? kDistributions + lobe.variant
                                                    : kKinds - 1;
  std::call_once(made[kind], [&] { grids[kind].emplace(makeGrid(lobe)); });
  return *grids[kind];
}

// Without Fresnel factor and layers, alike from both sides.
Lobe bareLobe(const Lobe& lobe) {
  Lobe bare = lobe;
  bare.fresnel = Fresnel::one;
  if (lobe.type == LobeType::microfacetReflection) bare.variant = 0;
  bare.weight = Rgb(1.f);
  bare.interface = false, bare.twoSided = true;
  return bare;
}

bool isBare(const Lobe& lobe) { return lobe.fresnel == Fresnel::one && !isCoated(lobe); }

LobeMoments tabulated(const ShadingFrame& frame, const Lobe& bare, Vec3f wo) {
  const float signedCosine = dot(frame.n, wo), cosine = std::min(std::abs(signedCosine), 1.f);
  const Vec3f n = signedCosine < 0 ? -frame.n : frame.n;
  const Grid::Entry parts = gridOf(bare).lookUp(cosine, alphaOf(bare));
  const Rgb albedo = lobeAlbedo(bare, cosine);
  const Vec3f mean = (n * (2 * cosine) - wo) * parts[0] + n * parts[1];
  return {albedo, mean * luminance(albedo)};
}

}  // namespace

LobeMoments quickMoments(const Bsdf& bsdf, const Lobe& lobe, Vec3f wo) {
  const ShadingFrame& frame = bsdf.frameOf(lobe);
  const float cosine = dot(frame.n, wo);
  if (!isActive(lobe, cosine)) return {};
  const bool isotropic = lobe.type == LobeType::phong || lobe.alphaX == lobe.alphaY;
  if (lobe.interface && cosine < 0) return glossyMoments(bsdf, lobe, wo, kInsidePoints);
  if (!isotropic) return glossyMoments(bsdf, lobe, wo, kAnisotropicPoints);
  const Lobe bare = bareLobe(lobe);
  LobeMoments moments = tabulated(frame, bare, wo);
  if (isBare(lobe) && !frame.perturbed) {
    moments.first *= luminance(lobe.weight);
    moments.albedo *= lobe.weight;
    return moments;
  }
  const MomentPair pair = momentPair(bsdf, lobe, bare, wo, kRatioPoints);
  const float bareEnergy = luminance(pair.other.albedo), energy = luminance(pair.own.albedo);
  if (!(bareEnergy > 0) || !(energy > 0)) return {};
  const auto closed = closedAlbedo(bsdf, lobe, wo);
  const Rgb albedo = closed ? *closed : pair.own.albedo / pair.other.albedo * moments.albedo;
  const Vec3f mean = moments.first / luminance(moments.albedo) + pair.own.first / energy -
                     pair.other.first / bareEnergy;
  const float longest = 1 - 1 / kMostKappa, size = length(mean);
  return {albedo, mean * (luminance(albedo) * (size > longest ? longest / size : 1.f))};
}

}  // namespace lobelia::transfer
