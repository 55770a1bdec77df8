#include "lobelia/base/random.h"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <vector>

#include "base/chi_squared.h"

namespace lobelia {
namespace {

// The first 2^k points of an Owen-scrambled Sobol' sequence have exactly one point in every
// elementary interval of 2^k: the property that every stratified estimate rests on.
TEST(Sampler, OneDimensionIsStratified) {
  for (uint32_t dimension : {0u, 1u, 2u, 17u}) {
    for (uint32_t k : {4u, 8u, 12u}) {
      const uint32_t n = 1u << k;
      std::set<uint32_t> strata;
      for (uint32_t i = 0; i < n; ++i) {
        Sampler sampler(7, 1234, i);
        sampler.setDimension(dimension);
        const float u = sampler.next1D();
        ASSERT_GE(u, 0.f);
        ASSERT_LT(u, 1.f);
        strata.insert(static_cast<uint32_t>(u * static_cast<float>(n)));
      }
      EXPECT_EQ(strata.size(), n) << "dimension " << dimension;
    }
  }
}

TEST(Sampler, TwoDimensionsFillEveryElementaryInterval) {
  for (uint64_t stream : {0ull, 5ull, 99ull}) {
    const uint32_t k = 8, n = 1u << k;
    std::vector<Vec2f> points;
    for (uint32_t i = 0; i < n; ++i) {
      Sampler sampler(1, stream, i);
      sampler.next1D();
      points.push_back(sampler.next2D());
    }
    for (uint32_t a = 0; a <= k; ++a) {
      std::set<std::pair<int, int>> cells;
      for (Vec2f p : points) {
        cells.insert({static_cast<int>(p.x * static_cast<float>(1u << a)),
                      static_cast<int>(p.y * static_cast<float>(1u << (k - a)))});
      }
      EXPECT_EQ(cells.size(), n) << "cells " << (1u << a) << " x " << (1u << (k - a));
    }
  }
}

// Every aligned block of 2^k samples is stratified too, so passes may be split anywhere.
TEST(Sampler, LaterBlocksAreStratified) {
  std::set<std::pair<int, int>> cells;
  for (uint32_t i = 768; i < 1024; ++i) {
    Sampler sampler(3, 8, i);
    const Vec2f p = sampler.next2D();
    cells.insert({static_cast<int>(p.x * 16), static_cast<int>(p.y * 16)});
  }
  EXPECT_EQ(cells.size(), 256u);
}

TEST(Sampler, IsAFunctionOfItsKeys) {
  const auto first = [](uint64_t seed, uint64_t stream, uint32_t index) {
    return Sampler(seed, stream, index).next2D();
  };
  EXPECT_EQ(first(1, 2, 3), first(1, 2, 3));
  EXPECT_NE(first(1, 2, 3), first(2, 2, 3));
  EXPECT_NE(first(1, 2, 3), first(1, 3, 3));
  EXPECT_NE(first(1, 2, 3), first(1, 2, 4));
  Sampler a(1, 2, 3), b(1, 2, 3);
  a.next2D(), a.next1D();
  b.setDimension(a.dimension());
  EXPECT_EQ(a.next1D(), b.next1D());
}

// Padded dimensions must not be correlated with each other, nor neighbouring streams.
TEST(Sampler, PairsOfDimensionsAndStreamsAreIndependent) {
  constexpr uint32_t kCount = 1u << 14;
  std::array<double, 64> dimensions{}, streams{}, expected{};
  expected.fill(kCount / 64.0);
  for (uint32_t i = 0; i < kCount; ++i) {
    Sampler s(11, i, 0);  // first samples of many streams: plain random numbers
    const float x = s.next1D(), y = s.next2D().y;
    const float z = Sampler(11, i + 1, 0).next1D();
    dimensions[static_cast<size_t>(x * 8) * 8 + static_cast<size_t>(y * 8)] += 1;
    streams[static_cast<size_t>(x * 8) * 8 + static_cast<size_t>(z * 8)] += 1;
  }
  EXPECT_GT(test::chiSquaredPValue(dimensions, expected), 1e-3);
  EXPECT_GT(test::chiSquaredPValue(streams, expected), 1e-3);
}

TEST(Rng, IsUniform) {
  Rng rng(5, 6);
  std::array<double, 256> counts{}, expected{};
  constexpr int kCount = 1 << 16;
  expected.fill(kCount / 256.0);
  for (int i = 0; i < kCount; ++i) {
    const Vec2f p = rng.next2D();
    counts[static_cast<size_t>(p.x * 16) * 16 + static_cast<size_t>(p.y * 16)] += 1;
  }
  EXPECT_GT(test::chiSquaredPValue(counts, expected), 1e-3);
  EXPECT_NE(Rng(5, 6).nextUint(), Rng(5, 7).nextUint());
}

}  // namespace
}  // namespace lobelia
