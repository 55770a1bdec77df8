// Fits, interpolation and drawings of studies' curves.
#include "lobelia/app/bench_plot.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lobelia::app {
namespace {

using Points = std::vector<std::pair<double, double>>;

TEST(BenchPlot, ExponentsOfPowerLaws) {
  Points points;
  for (const double x : {1e4, 3e4, 1e5, 2e6}) points.emplace_back(x, 7 * std::pow(x, 0.35));
  EXPECT_NEAR(growthExponent(points), 0.35, 1e-9);
  points.emplace_back(3e6, std::nan(""));
  EXPECT_NEAR(growthExponent(points), 0.35, 1e-9) << "what was not measured does not count";
  EXPECT_TRUE(std::isnan(growthExponent({{10, 3}})));
}

TEST(BenchPlot, InterpolatesInLogarithmsWithinThePoints) {
  const Points points{{8, 1.0 / 8}, {2, 1.0 / 2}, {0.5, 2}};  // 1 / x, in any order
  EXPECT_NEAR(interpolated(points, 4), 0.25, 1e-12);
  EXPECT_NEAR(interpolated(points, 1), 1, 1e-12);
  EXPECT_EQ(interpolated(points, 8), 1.0 / 8);
  EXPECT_TRUE(std::isnan(interpolated(points, 8.1)));
  EXPECT_TRUE(std::isnan(interpolated(points, 0.4)));
  EXPECT_EQ(interpolated({{3, 5}}, 3), 5);
  EXPECT_TRUE(std::isnan(interpolated({}, 3)));
}

size_t countOf(const std::string& text, const std::string& part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

TEST(BenchPlot, DrawsEveryPointWithinTheAxes) {
  const std::string svg =
      logLogPlot("x", "y", {{"a < b", {{1, 1}, {10, 100}}}, {"pointless", {{0, 1}, {-1, 2}}}});
  EXPECT_EQ(countOf(svg, "<circle"), 2u) << svg;
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos) << svg;
  EXPECT_EQ(svg.find("pointless"), std::string::npos)
      << "a curve without points is not in the legend";
  // Axes end at the outermost points, which are powers of ten.
  EXPECT_NE(svg.find("cx=\"80.0\" cy=\"350.0\""), std::string::npos) << svg;
  EXPECT_NE(svg.find("cx=\"470.0\" cy=\"30.0\""), std::string::npos) << svg;
  EXPECT_EQ(logLogPlot("x", "y", {{"none", {}}}), "");
}

}  // namespace
}  // namespace lobelia::app
