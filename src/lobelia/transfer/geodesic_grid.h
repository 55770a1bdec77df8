// Directions that subdividing an icosahedron gives [P002 sections 4, 6.1]: of slices (642: level 3,
// 2,562: level 4), of rays and of visibility masks (163,842: level 7).
//
// Directions follow one another along a curve over the sphere: what lies together in a row is
// close, so that rays are coherent and blocked parts of the sphere are runs. A grid contains the
// directions of all coarser ones, and with each direction its opposite.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::transfer {

inline constexpr int kMostGridLevel = 7;

// The corners of a triangle of the grid around a direction; weights >= 0, sum 1.
struct GridPlace {
  std::array<uint32_t, 3> index{};
  std::array<float, 3> weight{};
};

class GeodesicGrid {
 public:
  // 10 * 4^level + 2 directions. Throws std::invalid_argument unless 0 <= level <= kMostGridLevel.
  explicit GeodesicGrid(int level);

  int level() const { return level_; }
  size_t count() const { return directions_.size(); }
  std::span<const Vec3f> directions() const { return directions_; }  // unit
  // Solid angle nearer to each direction than to others, about: a third of the triangles around it.
  // Sums to 4 pi.
  std::span<const float> solidAngles() const { return solidAngles_; }
  // d: not zero, of any length.
  GridPlace locate(Vec3f d) const;
  // Of a level from 0 to level(): 20 * 4^level triangles, corners by number. The children of
  // triangle t are 4 t to 4 t + 3 of the next; 4 t + 1 has the middles of its edges, from corner 0
  // on.
  std::span<const std::array<uint32_t, 3>> triangles(int level) const {
    return triangles_[static_cast<size_t>(level)];
  }
  // The grid's number of each direction of a coarser or equal grid.
  std::vector<uint32_t> indicesOf(const GeodesicGrid& coarser) const;

 private:
  int level_;
  std::vector<Vec3f> directions_;
  std::vector<float> solidAngles_;
  // By number in the order of subdivision, in which coarser grids come first: the number here.
  std::vector<uint32_t> ofSubdivision_;
  std::vector<std::vector<std::array<uint32_t, 3>>> triangles_;
};

}  // namespace lobelia::transfer
