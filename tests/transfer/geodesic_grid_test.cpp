#include "lobelia/transfer/geodesic_grid.h"

#include <gtest/gtest.h>

#include <numeric>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"

namespace lobelia::transfer {
namespace {

TEST(GeodesicGrid, HasThePapersNumbersOfDirections) {
  for (const auto& [level, count] :
       {std::pair{0, 12}, {3, 642}, {4, 2562}, {5, 10242}, {7, 163842}})
    EXPECT_EQ(GeodesicGrid(level).count(), static_cast<size_t>(count));
  EXPECT_THROW(GeodesicGrid(-1), std::invalid_argument);
  EXPECT_THROW(GeodesicGrid(8), std::invalid_argument);
}

TEST(GeodesicGrid, SolidAnglesShareOutTheSphere) {
  const GeodesicGrid grid(4);
  const auto angles = grid.solidAngles();
  EXPECT_NEAR(std::accumulate(angles.begin(), angles.end(), 0.0), 4 * kPi, 1e-4);
  const double mean = 4 * kPi / static_cast<double>(grid.count());
  for (const float a : angles) EXPECT_NEAR(a / mean, 1, 0.35);
  Vec3f sum{};
  for (size_t i = 0; i < grid.count(); ++i) sum += grid.directions()[i] * angles[i];
  EXPECT_LT(length(sum), 1e-4f);
}

TEST(GeodesicGrid, DirectionsInARowAreClose) {
  const GeodesicGrid grid(5);
  float sum = 0;
  for (size_t i = 1; i < grid.count(); ++i)
    sum += std::acos(std::min(1.f, dot(grid.directions()[i - 1], grid.directions()[i])));
  EXPECT_LT(sum / static_cast<float>(grid.count()), 0.09f);  // 2.2 degrees between neighbours
}

TEST(GeodesicGrid, LocatesEveryDirectionInItsTriangle) {
  const GeodesicGrid grid(3);
  Rng rng(7);
  for (int i = 0; i < 20000; ++i) {
    const Vec3f d = sampleSphereUniform(rng.next2D());
    const GridPlace place = grid.locate(d * 3.f);
    Vec3f at{};
    float sum = 0;
    for (size_t k = 0; k < 3; ++k) {
      EXPECT_GT(dot(grid.directions()[place.index[k]], d), 0.98f);
      at += grid.directions()[place.index[k]] * place.weight[k];
      sum += place.weight[k];
    }
    EXPECT_NEAR(sum, 1, 1e-5);
    EXPECT_LT(length(normalize(at) - d), 2e-5f);
  }
  for (uint32_t i = 0; i < grid.count(); ++i) {
    const GridPlace place = grid.locate(grid.directions()[i]);
    float weight = 0;
    for (size_t k = 0; k < 3; ++k)
      if (place.index[k] == i) weight = place.weight[k];
    EXPECT_NEAR(weight, 1, 1e-4) << i;
  }
}

TEST(GeodesicGrid, HoldsCoarserGridsAndOppositeDirections) {
  const GeodesicGrid coarse(2), fine(4);
  const std::vector<uint32_t> indices = fine.indicesOf(coarse);
  for (size_t i = 0; i < coarse.count(); ++i)
    EXPECT_EQ(fine.directions()[indices[i]], coarse.directions()[i]);
  EXPECT_THROW(coarse.indicesOf(fine), std::invalid_argument);
  for (size_t i = 0; i < fine.count(); ++i) {
    const GridPlace place = fine.locate(-fine.directions()[i]);
    EXPECT_GT(*std::max_element(place.weight.begin(), place.weight.end()), 0.9999f);
  }
}

}  // namespace
}  // namespace lobelia::transfer
