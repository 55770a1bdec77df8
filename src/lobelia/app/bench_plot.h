// Curves on logarithmic axes as a drawing (SVG), for figures of studies.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace lobelia::app {

struct PlotCurve {
  std::string label;
  std::vector<std::pair<double, double>> points;  // others than positive ones are left out
};

// Axes end at powers of ten or at twice or five times those; "" where there is no point.
std::string logLogPlot(const std::string& xLabel, const std::string& yLabel,
                       const std::vector<PlotCurve>& curves);

// y at x on the polyline through the points, straight in logarithms; NaN outside of them.
double interpolated(std::vector<std::pair<double, double>> points, double x);
// Slope of the least-squares line in logarithms; NaN for fewer than two points.
double growthExponent(const std::vector<std::pair<double, double>>& points);

}  // namespace lobelia::app
