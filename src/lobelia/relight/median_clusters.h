// Even clusters of items with features, halved again and again [P004 section 3.4].
//
// The paper sorts a node's items by d(s, c1) - d(s, c2) and splits in the middle. All of its
// metrics are squared Euclidean distances (eqs. 11 to 13), so this difference is, but for a
// constant, the item's coordinate along c2 - c1: each split is at the median along the line of two
// means.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::relight {

// What items are told apart by: p and n (n may be empty), and rows of `rowLength` small numbers
// (may be none), each with the weight of its squared differences. A cluster's distance is
// placeWeight |p - <p>|^2 + normalWeight |n - <n>|^2 + rowWeight |row - <row>|^2.
struct Features {
  std::span<const Vec3f> p, n;
  std::span<const uint8_t> rows;
  size_t rowLength = 0;
  float placeWeight = 1, normalWeight = 0, rowWeight = 0;
};

// The items in an order in which halves, their halves, and so on `levels` times are clusters; the
// first half of `count` items has count / 2. The same for any number of threads.
std::vector<uint32_t> clusterOrder(const Features& features, int levels);
// Where its clusters begin, and the end: 2^levels + 1 numbers.
std::vector<size_t> clusterBegins(size_t count, int levels);

}  // namespace lobelia::relight
