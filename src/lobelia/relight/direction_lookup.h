// Which of many unit directions is nearest to a given one, by a table over a cube.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::relight {

// Answers are those of the centre of the table's cell; at 32,768 directions a cell is a third as
// wide as the directions are apart.
class DirectionLookup {
 public:
  DirectionLookup() = default;
  // directions: at least one, unit. O(cells + directions), in parallel.
  explicit DirectionLookup(std::span<const Vec3f> directions);
  // d: not zero, of any length.
  uint32_t nearest(Vec3f d) const { return cells_[cellOf(d)]; }

 private:
  size_t cellOf(Vec3f d) const;
  Vec3f centreOf(size_t cell) const;

  int side_ = 0;  // cells along an edge of a face
  std::vector<uint32_t> cells_;
};

}  // namespace lobelia::relight
