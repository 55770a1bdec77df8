// Piecewise-constant density on the unit square, by marginal and conditional inversion.
#include <cassert>
#include <cmath>

#include "lobelia/base/sampling.h"

namespace lobelia {
namespace {

constexpr float kBelowOne = 0x1.fffffep-1f;

// Finds the cell of u in n cells with n+1 cumulatives; `inside` is the place in it, in [0,1).
// Cells without weight have no width and are never found.
int invert(const float* cumulative, int n, float u, float* inside) {
  const float* above = std::upper_bound(cumulative, cumulative + n + 1, u);
  const int i = std::clamp(static_cast<int>(above - cumulative) - 1, 0, n - 1);
  const float width = cumulative[i + 1] - cumulative[i];
  *inside = width > 0 ? std::clamp((u - cumulative[i]) / width, 0.f, kBelowOne) : 0.f;
  return i;
}

}  // namespace

Distribution2D::Distribution2D(std::span<const float> weights, int nx, int ny)
    : nx_(nx), ny_(ny), weights_(weights.begin(), weights.end()) {
  assert(nx > 0 && ny > 0);
  const size_t width = static_cast<size_t>(nx), height = static_cast<size_t>(ny);
  assert(weights_.size() == width * height);
  conditional_.resize(height * (width + 1));
  marginal_.resize(height + 1);
  std::vector<double> rowSums(height), partial(width + 1);
  for (size_t y = 0; y < height; ++y) {
    for (size_t x = 0; x < width; ++x) {
      const float w = weights_[y * width + x];
      assert(w >= 0 && std::isfinite(w));
      partial[x + 1] = partial[x] + static_cast<double>(w);
    }
    rowSums[y] = partial[width];
    for (size_t x = 0; x <= width; ++x) {
      // A row without weight is never chosen.
      conditional_[y * (width + 1) + x] =
          rowSums[y] > 0 ? static_cast<float>(partial[x] / rowSums[y]) : 0.f;
    }
    total_ += rowSums[y];
  }
  double sum = 0;
  for (size_t y = 0; y < height; ++y) {
    sum += rowSums[y];
    marginal_[y + 1] = total_ > 0 ? static_cast<float>(sum / total_) : 0.f;
  }
}

Vec2f Distribution2D::sample(Vec2f u, float* pdf) const {
  if (!(total_ > 0)) {
    *pdf = 0;
    return u;
  }
  Vec2f inside;
  const int y = invert(marginal_.data(), ny_, u.y, &inside.y);
  const size_t row = static_cast<size_t>(y) * static_cast<size_t>(nx_ + 1);
  const int x = invert(conditional_.data() + row, nx_, u.x, &inside.x);
  // Rounding may push a point over its cell's upper edge; the density returned is the one that
  // pdf() gives for the point.
  const Vec2f p{std::min((static_cast<float>(x) + inside.x) / static_cast<float>(nx_), kBelowOne),
                std::min((static_cast<float>(y) + inside.y) / static_cast<float>(ny_), kBelowOne)};
  const size_t cell = static_cast<size_t>(y) * static_cast<size_t>(nx_) + static_cast<size_t>(x);
  const double cells = static_cast<double>(nx_) * static_cast<double>(ny_);
  *pdf = static_cast<float>(static_cast<double>(weights_[cell]) / total_ * cells);
  return p;
}

float Distribution2D::pdf(Vec2f p) const {
  if (!(total_ > 0)) return 0;
  const int x = std::clamp(static_cast<int>(p.x * static_cast<float>(nx_)), 0, nx_ - 1);
  const int y = std::clamp(static_cast<int>(p.y * static_cast<float>(ny_)), 0, ny_ - 1);
  const size_t cell = static_cast<size_t>(y) * static_cast<size_t>(nx_) + static_cast<size_t>(x);
  const double cells = static_cast<double>(nx_) * static_cast<double>(ny_);
  return static_cast<float>(static_cast<double>(weights_[cell]) / total_ * cells);
}

}  // namespace lobelia
