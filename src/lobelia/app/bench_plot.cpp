#include "lobelia/app/bench_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobelia::app {
namespace {

constexpr double kWidth = 640, kHeight = 400, kLeft = 80, kTop = 30, kBottom = 50, kLegend = 170;
constexpr const char* kColors[] = {"#1b6ca8", "#c44536", "#2a9d5c", "#7b4fa3",
                                   "#b07d12", "#444444", "#d0568f", "#188a8d"};

bool drawable(const std::pair<double, double>& p) {
  return std::isfinite(p.first) && std::isfinite(p.second) && p.first > 0 && p.second > 0;
}

// 1, 2 and 5 times the powers of ten.
double step(int i) {
  constexpr double kSteps[] = {1, 2, 5};
  const int decade = static_cast<int>(std::floor(i / 3.0));
  return kSteps[i - 3 * decade] * std::pow(10, decade);
}

struct Axis {
  int first = 0, last = 0;  // steps
  double from = 0, to = 0;  // on the page

  Axis(double least, double most, double begin, double end) : from(begin), to(end) {
    first = 3 * static_cast<int>(std::floor(std::log10(least)));
    while (step(first + 1) <= least) ++first;
    last = first + 1;
    while (step(last) < most) ++last;
  }
  double at(double v) const {
    const double a = std::log(step(first)), b = std::log(step(last));
    return from + (to - from) * (std::log(v) - a) / (b - a);
  }
  // Of a wide axis the powers of ten alone.
  bool marks(int i) const { return last - first <= 9 || i % 3 == 0; }
};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else
      out += c;
  }
  return out;
}

std::string text(double x, double y, const char* anchor, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     escaped(words));
}
std::string line(double x0, double y0, double x1, double y1) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" stroke=\"#ddd\"/>\n", x0, y0, x1,
                     y1);
}

std::string grid(const Axis& x, const Axis& y, const std::string& xLabel,
                 const std::string& yLabel) {
  std::string out;
  for (int i = x.first; i <= x.last; ++i) {
    if (!x.marks(i)) continue;
    out += line(x.at(step(i)), y.from, x.at(step(i)), y.to);
    out += text(x.at(step(i)), y.from + 16, "middle", fmt::format("{:g}", step(i)));
  }
  for (int i = y.first; i <= y.last; ++i) {
    if (!y.marks(i)) continue;
    out += line(x.from, y.at(step(i)), x.to, y.at(step(i)));
    out += text(x.from - 6, y.at(step(i)) + 4, "end", fmt::format("{:g}", step(i)));
  }
  out += text(0.5 * (x.from + x.to), kHeight - 12, "middle", xLabel);
  out += text(x.from, y.to - 12, "middle", yLabel);
  return out;
}

std::string drawn(const PlotCurve& curve, const Axis& x, const Axis& y, const char* color,
                  double legendY) {
  std::string path, dots;
  for (const auto& p : curve.points) {
    if (!drawable(p)) continue;
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x.at(p.first), y.at(p.second));
    dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>\n",
                        x.at(p.first), y.at(p.second), color);
  }
  if (path.empty()) return "";
  const double legendX = kWidth - kLegend + 12;
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\"/>\n", path,
                     color) +
         dots +
         fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"10\" height=\"10\" fill=\"{}\"/>\n",
                     legendX, legendY - 9, color) +
         text(legendX + 15, legendY, "start", curve.label);
}

}  // namespace

std::string logLogPlot(const std::string& xLabel, const std::string& yLabel,
                       const std::vector<PlotCurve>& curves) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double least[2] = {kInfinity, kInfinity}, most[2] = {0, 0};
  for (const PlotCurve& curve : curves) {
    for (const auto& p : curve.points) {
      if (!drawable(p)) continue;
      least[0] = std::min(least[0], p.first), most[0] = std::max(most[0], p.first);
      least[1] = std::min(least[1], p.second), most[1] = std::max(most[1], p.second);
    }
  }
  if (most[0] == 0) return "";
  const Axis x(least[0], most[0], kLeft, kWidth - kLegend);
  const Axis y(least[1], most[1], kHeight - kBottom, kTop);
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} "
      "{1}\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"{0}\" height=\"{1}\" "
      "fill=\"white\"/>\n",
      kWidth, kHeight);
  out += grid(x, y, xLabel, yLabel);
  for (size_t i = 0; i < curves.size(); ++i)
    out += drawn(curves[i], x, y, kColors[i % std::size(kColors)],
                 kTop + 14 + 18 * static_cast<double>(i));
  return out + "</svg>\n";
}

double interpolated(std::vector<std::pair<double, double>> points, double x) {
  std::erase_if(points, [](const auto& p) { return !drawable(p); });
  std::sort(points.begin(), points.end());
  for (const auto& [px, py] : points)
    if (px == x) return py;
  for (size_t i = 1; i < points.size(); ++i) {
    const auto [x0, y0] = points[i - 1];
    const auto [x1, y1] = points[i];
    if (x0 >= x || x1 <= x) continue;
    const double t = std::log(x / x0) / std::log(x1 / x0);
    return y0 * std::pow(y1 / y0, t);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double growthExponent(const std::vector<std::pair<double, double>>& points) {
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const auto& p : points) {
    if (!drawable(p)) continue;
    const double x = std::log(p.first), y = std::log(p.second);
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  if (n < 2) return std::numeric_limits<double>::quiet_NaN();
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace lobelia::app
