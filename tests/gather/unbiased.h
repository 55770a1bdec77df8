// Is the mean over draws the light of all?
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::test {

// Sums over groups of neighbours in the array, then over all; each a mean over draws must equal.
inline std::vector<double> groupSums(const std::vector<Rgb>& light) {
  std::vector<double> sums(13, 0.0);
  for (size_t i = 0; i < light.size(); ++i) {
    const double value = double{light[i].x} + double{light[i].y} + double{light[i].z};
    sums[i * 12 / light.size()] += value;
    sums[12] += value;
  }
  return sums;
}

// draw(i): light of draw i at every receiver.
template <class Draw>
void expectUnbiased(const std::vector<Rgb>& all, int draws, const Draw& draw) {
  const std::vector<double> exact = groupSums(all);
  std::vector<double> mean(exact.size(), 0.0), squares(exact.size(), 0.0);
  for (int i = 0; i < draws; ++i) {
    const std::vector<double> sums = groupSums(draw(static_cast<uint64_t>(i)));
    for (size_t g = 0; g < sums.size(); ++g)
      mean[g] += sums[g] / draws, squares[g] += sums[g] * sums[g] / draws;
  }
  for (size_t g = 0; g < exact.size(); ++g) {
    const double error = std::sqrt((squares[g] - mean[g] * mean[g]) / draws);
    EXPECT_GT(error, 0) << "group " << g;
    EXPECT_NEAR(mean[g], exact[g], 4 * error) << "group " << g;
    EXPECT_LT(error, 0.1 * exact[g]) << "group " << g << ": says too little";
  }
}

}  // namespace lobelia::test
