#include "lobelia/transfer/irradiance.h"

#include "lobelia/base/parallel.h"

namespace lobelia::transfer {
namespace {

constexpr int kNormalLevel = 3, kLightLevel = 5, kOctantLevel = 4;

DiffuseLobes openHemisphere(const GeodesicGrid& grid, Vec3f n) {
  std::array<float, kOctants> share{};
  std::array<Vec3f, kOctants> first{};
  float all = 0;
  for (size_t i = 0; i < grid.count(); ++i) {
    const Vec3f d = grid.directions()[i];
    const float weight = std::max(dot(n, d), 0.f) * grid.solidAngles()[i];
    if (weight <= 0) continue;
    share[octantOf(d)] += weight, first[octantOf(d)] += d * weight, all += weight;
  }
  DiffuseLobes out{};
  for (size_t o = 0; o < kOctants; ++o)
    if (share[o] > 0) out[o] = pack({Rgb(share[o] / all), first[o] / share[o]});
  return out;
}

}  // namespace

Irradiance::Irradiance(const PrefilteredLight& light)
    : normals_(kNormalLevel), values_(normals_.count()) {
  // Light at the directions of a fine grid, as smooth as these are apart.
  const GeodesicGrid grid(kLightLevel);
  const float kappa = static_cast<float>(grid.count()) / (4 * kPi);
  std::vector<Rgb> power(grid.count());
  parallelFor(grid.count(), 256, [&](size_t i) {
    power[i] = light.lookUp(grid.directions()[i], kappa) * grid.solidAngles()[i];
  });
  parallelFor(normals_.count(), 8, [&](size_t k) {
    // Divided by the same sum of a light of one, so that a constant light stays what it is.
    Rgb sum{};
    float all = 0;
    for (size_t i = 0; i < grid.count(); ++i) {
      const float cosine = std::max(dot(normals_.directions()[k], grid.directions()[i]), 0.f);
      sum += power[i] * cosine, all += grid.solidAngles()[i] * cosine;
    }
    values_[k] = sum / all;
  });
}

Rgb Irradiance::at(Vec3f n) const {
  const GridPlace place = normals_.locate(n);
  Rgb sum{};
  for (size_t k = 0; k < 3; ++k) sum += values_[place.index[k]] * place.weight[k];
  return sum;
}

std::vector<DiffuseLobes> unoccludedDiffuse(std::span<const TransferVertex> vertices,
                                            const DiffuseSides& sides) {
  const GeodesicGrid grid(kOctantLevel);
  std::vector<DiffuseLobes> out(sides.front(vertices.size()));
  parallelFor(vertices.size(), 64, [&](size_t v) {
    out[sides.front(v)] = openHemisphere(grid, vertices[v].n);
    if (sides.hasBack(v)) out[sides.find(v, Side::back)] = openHemisphere(grid, -vertices[v].n);
  });
  return out;
}

}  // namespace lobelia::transfer
