#include <gtest/gtest.h>

#include <set>

#include "lobelia/path/path_tracer.h"

namespace lobelia {
namespace {

TEST(SpreadPixels, GivesThatManyDifferentPixelsInOrder) {
  for (const auto& [w, h] : {std::pair{64, 48}, {1, 500}, {500, 1}, {7, 3}, {1, 1}}) {
    for (const size_t count :
         {size_t{0}, size_t{1}, size_t{5}, size_t{21}, size_t{400}, size_t{9999}}) {
      const PixelSet set = spreadPixels(w, h, count, 3);
      EXPECT_EQ(set.pixels.size(),
                std::min(count, static_cast<size_t>(w) * static_cast<size_t>(h)));
      EXPECT_TRUE(std::is_sorted(set.pixels.begin(), set.pixels.end()));
      EXPECT_EQ(std::set<uint32_t>(set.pixels.begin(), set.pixels.end()).size(), set.pixels.size());
      for (const uint32_t p : set.pixels) EXPECT_LT(p, static_cast<uint32_t>(w * h));
    }
  }
}

TEST(SpreadPixels, IsEvenAndDependsOnTheSeed) {
  const PixelSet set = spreadPixels(160, 100, 1000, 1);
  int quadrants[4] = {};
  for (const uint32_t p : set.pixels)
    ++quadrants[(p / 160 >= 50 ? 2 : 0) + (p % 160 >= 80 ? 1 : 0)];
  for (const int q : quadrants) EXPECT_NEAR(q, 250, 25);
  EXPECT_EQ(spreadPixels(160, 100, 1000, 1).pixels, set.pixels);
  EXPECT_NE(spreadPixels(160, 100, 1000, 2).pixels, set.pixels);
}

}  // namespace
}  // namespace lobelia
