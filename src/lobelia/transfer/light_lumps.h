// Directed powers gathered into lumps small against a lobe, in order of their places, so that a
// narrow lobe looks at few.
//
// A lump's light is spread about its mean direction; the lobe with which it is convolved is wider
// by as much: a vMF lobe whose mean resultant is the lobe's times the lump's, which keeps the first
// moment exactly.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "lobelia/relight/distant_light.h"

namespace lobelia::transfer {

// By lump: a spherical Gaussian exp(-halfKappa |d - axis|^2) times r, g, b.
struct LumpLobes {
  std::vector<float> x, y, z, halfKappa, r, g, b;
  size_t count() const { return x.size(); }
};

class LightLumps {
 public:
  // kappa: of the lobe, a vMF lobe of integral 1. width: of lumps, radians.
  LightLumps(std::span<const relight::DirectedPower> powers, float kappa, float width);

  const LumpLobes& lobes() const { return lobes_; }
  // Appends ranges of lumps, [first, second): all whose cells meet the cone of half angle `radius`
  // about `axis`, each once, in a fixed order.
  void find(Vec3f axis, float radius, std::vector<std::pair<uint32_t, uint32_t>>* ranges) const;

 private:
  size_t rowOf(float theta) const;
  uint32_t cellOf(Vec3f d) const;
  void findInRow(size_t row, float phi, float halfWidth,
                 std::vector<std::pair<uint32_t, uint32_t>>* ranges) const;

  // Rows of cells by the angle from +z, columns by the angle about it.
  std::vector<uint32_t> rowBegin_;   // cells, by row; their number at last
  std::vector<uint32_t> cellBegin_;  // lumps, by cell; their number at last
  LumpLobes lobes_;
};

}  // namespace lobelia::transfer
