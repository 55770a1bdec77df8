// Slices of a picture: receivers near each other and turned alike, which few lights can serve
// [Ou11]. A tree of planes cuts space and directions together, so that any receiver, not only those
// of the sample that it was made for, belongs to a slice.
//
// The cell whose points spread most (number times variance) is cut in two at the median of its
// widest extent until there are enough.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "lobelia/path/receivers.h"

namespace lobelia::gather {

class ReceiverSlices {
 public:
  // sample: some receivers, at least one. count: of slices, at most; fewer where points are alike.
  // scale: size of the scene. seed: of the choice of representatives.
  ReceiverSlices(const Receivers& sample, size_t count, float scale, uint64_t seed);

  size_t count() const { return representatives_.size(); }
  uint32_t sliceOf(const ReceiverPoint& point) const;
  // A receiver of the sample that is drawn in the slice.
  uint32_t representative(size_t slice) const { return representatives_[slice]; }
  struct Neighbour {
    uint32_t slice;
    float squaredDistance;  // of the middles
  };
  // The nearest `most` slices, itself first.
  std::vector<Neighbour> neighbours(size_t slice, size_t most) const;

 private:
  // Place and normal; a difference of 1 in either counts alike.
  using Coordinates = std::array<float, 6>;
  // A plane that puts points below `value` to the first child, or a slice.
  struct Node {
    int dim = -1;  // -1: a slice
    float value = 0;
    uint32_t first = 0;  // child, the other behind it; or the slice
  };
  struct Cell;
  Coordinates coordinatesOf(const ReceiverPoint& point) const;
  Cell measure(uint32_t node, size_t begin, size_t end) const;
  bool cut(const Cell& cell, size_t* middle, Node* plane);

  float inverseScale_;
  std::vector<Coordinates> points_;  // of the sample
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> representatives_;
  std::vector<Coordinates> middles_;
};

}  // namespace lobelia::gather
