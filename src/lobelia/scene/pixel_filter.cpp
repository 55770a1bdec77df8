// Reconstruction filters and sampling in proportion to their absolute value (filter importance
// sampling, Ernst et al. 2006, "Filter Importance Sampling", RT06). Shapes and default radii are
// Mitsuba's; all are separable. Negative lobes carry a negative weight.
//
// Each axis inverts a table of the cumulative of |f| (piecewise constant over kCells cells of
// half the filter; the mean of f over a cell is exact to 1e-7). The tables depend on nothing but
// the filter and, for Lanczos, on the number of lobes.
#include <array>
#include <cmath>
#include <vector>

#include "lobelia/scene/camera.h"

namespace lobelia {
namespace {

constexpr int kCells = 1024;
constexpr int kMaxLobes = 16;
constexpr size_t kStarts = 256;  // of searches

double gaussian(double x) {  // x in units of the radius, which is 4 standard deviations
  const double z = 4 * x;
  return std::exp(-0.5 * z * z) - std::exp(-8.0);
}

// Mitchell and Netravali 1988; x in units of half the radius.
double cubic(double x, double b, double c) {
  const double x2 = x * x, x3 = x2 * x;
  if (x < 1) {
    return ((12 - 9 * b - 6 * c) * x3 + (-18 + 12 * b + 6 * c) * x2 + (6 - 2 * b)) / 6;
  }
  return ((-b - 6 * c) * x3 + (6 * b + 30 * c) * x2 + (-12 * b - 48 * c) * x + (8 * b + 24 * c)) /
         6;
}

double lanczos(double x, double lobes) {  // x in pixels
  if (x < 1e-6) return 1;
  const double a = 3.14159265358979323846 * x, b = a / lobes;
  return std::sin(a) * std::sin(b) / (a * b);
}

int lobeCount(float radius) {
  return std::clamp(static_cast<int>(std::lround(radius)), 1, kMaxLobes);
}

// f at |x| in units of the radius, [0, 1).
double shape(PixelFilter filter, double x, int lobes) {
  switch (filter) {
    case PixelFilter::box:
      return 1;
    case PixelFilter::tent:
      return 1 - x;
    case PixelFilter::gaussian:
      return gaussian(x);
    case PixelFilter::mitchell:
      return cubic(2 * x, 1. / 3, 1. / 3);
    case PixelFilter::catmullRom:
      return cubic(2 * x, 0, 0.5);
    case PixelFilter::lanczos:
      return lanczos(x * lobes, lobes);
  }
  return 0;
}

struct Table {
  std::vector<float> cumulative;              // kCells + 1 values, 0 to 1
  std::vector<bool> negative;                 // by cell
  std::array<uint16_t, kStarts + 1> start{};  // by value / kStarts: the cell that it is in
  float weight = 1;                           // integral of |f| over integral of f
};

Table makeTable(PixelFilter filter, int lobes) {
  Table table;
  std::vector<double> sums{0};
  double integral = 0;
  for (int i = 0; i < kCells; ++i) {
    const double h = 1. / kCells, x = i * h;
    const double cell = (shape(filter, x, lobes) + 4 * shape(filter, x + 0.5 * h, lobes) +
                         shape(filter, std::min(x + h, 1 - 1e-12), lobes)) *
                        h / 6;  // Simpson
    integral += cell;
    sums.push_back(sums.back() + std::abs(cell));
    table.negative.push_back(cell < 0);
  }
  for (double s : sums) table.cumulative.push_back(static_cast<float>(s / sums.back()));
  table.weight = static_cast<float>(sums.back() / integral);
  size_t cell = 0;
  for (size_t s = 0; s <= kStarts; ++s) {
    const float value = static_cast<float>(s) / kStarts;
    while (cell + 1 < kCells && table.cumulative[cell + 1] <= value) ++cell;
    table.start[s] = static_cast<uint16_t>(cell);
  }
  return table;
}

// Constants, computed when first used.
const Table& tableOf(PixelFilter filter, int lobes) {
  if (filter == PixelFilter::lanczos) {
    static const std::vector<Table> tables = [] {
      std::vector<Table> t;
      for (int l = 1; l <= kMaxLobes; ++l) t.push_back(makeTable(PixelFilter::lanczos, l));
      return t;
    }();
    return tables[static_cast<size_t>(lobes - 1)];
  }
  static const std::array<Table, 3> tables{makeTable(PixelFilter::gaussian, 0),
                                           makeTable(PixelFilter::mitchell, 0),
                                           makeTable(PixelFilter::catmullRom, 0)};
  return tables[filter == PixelFilter::gaussian ? 0 : filter == PixelFilter::mitchell ? 1 : 2];
}

// One axis: offset in units of the radius; weight is multiplied.
float sampleTable(const Table& table, float u, float* weight) {
  const bool left = u < 0.5f;
  const float v = std::min(left ? 1 - 2 * u : 2 * u - 1, 0x1.fffffep-1f);
  const auto& c = table.cumulative;
  size_t cell = table.start[static_cast<size_t>(v * kStarts)];
  while (cell + 1 < kCells && c[cell + 1] <= v) ++cell;
  const float width = c[cell + 1] - c[cell];
  const float inside = width > 0 ? std::clamp((v - c[cell]) / width, 0.f, 1.f) : 0.5f;
  const float x = (static_cast<float>(cell) + inside) / kCells;
  *weight *= table.negative[cell] ? -table.weight : table.weight;
  return left ? -x : x;
}

float sampleTent(float u) {
  return u < 0.5f ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(std::max(0.f, 2 - 2 * u));
}

}  // namespace

float defaultRadius(PixelFilter filter) {
  switch (filter) {
    case PixelFilter::box:
      return 0.5f;
    case PixelFilter::tent:
      return 1;
    case PixelFilter::gaussian:
    case PixelFilter::mitchell:
    case PixelFilter::catmullRom:
      return 2;
    case PixelFilter::lanczos:
      return 3;
  }
  return 0.5f;
}

float evaluateFilter(PixelFilter filter, float radius, float x) {
  const float r = radius > 0 ? radius : defaultRadius(filter);
  const int lobes = lobeCount(r);
  const float reach = filter == PixelFilter::lanczos ? static_cast<float>(lobes) : r;
  const float t = std::abs(x) / reach;
  return t < 1 ? static_cast<float>(shape(filter, double{t}, lobes)) : 0.f;
}

Vec2f sampleFilter(PixelFilter filter, float radius, Vec2f u, float* weight) {
  *weight = 1;
  const float r = radius > 0 ? radius : defaultRadius(filter);
  if (filter == PixelFilter::box) return Vec2f{2 * u.x - 1, 2 * u.y - 1} * r;
  if (filter == PixelFilter::tent) return Vec2f{sampleTent(u.x), sampleTent(u.y)} * r;
  const int lobes = lobeCount(r);
  const float reach = filter == PixelFilter::lanczos ? static_cast<float>(lobes) : r;
  const Table& table = tableOf(filter, lobes);
  const float x = sampleTable(table, u.x, weight), y = sampleTable(table, u.y, weight);
  return Vec2f{x, y} * reach;
}

}  // namespace lobelia
