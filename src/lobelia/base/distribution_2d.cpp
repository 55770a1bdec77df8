// Piecewise-constant density on the unit square, by marginal and conditional inversion.
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "lobelia/base/prefetch.h"
#include "lobelia/base/sampling.h"

namespace lobelia {
namespace {

constexpr float kBelowOne = 0x1.fffffep-1f;

// Cumulatives are searched as trees of 16 children whose upper levels are copies of every 16th
// number of the level below: a row of thousands takes three or four cache lines instead of a dozen
// that lie apart. Levels stand one after another, the widest (all cumulatives) first, each filled
// up with infinity to a multiple of 16.
constexpr size_t kChildren = 16;

size_t paddedSize(size_t n) { return (n + kChildren - 1) / kChildren * kChildren; }

// Of all levels over `count` numbers.
size_t treeSize(size_t count) {
  size_t sum = 0;
  for (;;) {
    sum += paddedSize(count);
    if (count <= kChildren) return sum;
    count = (count + kChildren - 1) / kChildren;
  }
}

// The levels above the first `count` numbers of `tree`, and the padding.
void fillTree(float* tree, size_t count) {
  for (;;) {
    float* const above = tree + paddedSize(count);
    std::fill(tree + count, above, std::numeric_limits<float>::infinity());
    if (count <= kChildren) return;
    const size_t parents = (count + kChildren - 1) / kChildren;
    for (size_t i = 0; i < parents; ++i) above[i] = tree[i * kChildren];
    tree = above, count = parents;
  }
}

// The last of a node's children that is not above u; the first when all are.
size_t chooseChild(const float* children, float u) {
  int below = 0;
  for (size_t i = 0; i < kChildren; ++i) below += children[i] <= u ? 1 : 0;
  return static_cast<size_t>(std::max(below, 1) - 1);
}

// Index of the last of `count` cumulatives that is not above u.
size_t findInTree(const float* tree, size_t count, float u) {
  if (count <= kChildren) return chooseChild(tree, u);
  const size_t parents = (count + kChildren - 1) / kChildren;
  const size_t node = findInTree(tree + paddedSize(count), parents, u);
  return node * kChildren + chooseChild(tree + node * kChildren, u);
}

// Finds the cell of u in n cells with n+1 cumulatives; `inside` is the place in it, in [0,1).
// Cells without weight have no width and are never found.
int invert(const float* cumulative, int n, float u, float* inside) {
  const size_t found = findInTree(cumulative, static_cast<size_t>(n) + 1, u);
  const int i = std::min(static_cast<int>(found), n - 1);
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
  const size_t stride = treeSize(width + 1);
  conditional_.resize(height * stride);
  marginal_.resize(treeSize(height + 1));
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
      conditional_[y * stride + x] =
          rowSums[y] > 0 ? static_cast<float>(partial[x] / rowSums[y]) : 0.f;
    }
    fillTree(conditional_.data() + y * stride, width + 1);
    total_ += rowSums[y];
  }
  double sum = 0;
  for (size_t y = 0; y < height; ++y) {
    sum += rowSums[y];
    marginal_[y + 1] = total_ > 0 ? static_cast<float>(sum / total_) : 0.f;
  }
  fillTree(marginal_.data(), height + 1);
}

Vec2f Distribution2D::sample(Vec2f u, float* pdf) const {
  if (!(total_ > 0)) {
    if (pdf) *pdf = 0;
    return u;
  }
  Vec2f inside;
  const int y = invert(marginal_.data(), ny_, u.y, &inside.y);
  const size_t row = static_cast<size_t>(y) * treeSize(static_cast<size_t>(nx_) + 1);
  const int x = invert(conditional_.data() + row, nx_, u.x, &inside.x);
  // Rounding may push a point over its cell's upper edge; the density returned is the one that
  // pdf() gives for the point.
  const Vec2f p{std::min((static_cast<float>(x) + inside.x) / static_cast<float>(nx_), kBelowOne),
                std::min((static_cast<float>(y) + inside.y) / static_cast<float>(ny_), kBelowOne)};
  if (!pdf) return p;
  const size_t cell = static_cast<size_t>(y) * static_cast<size_t>(nx_) + static_cast<size_t>(x);
  const double cells = static_cast<double>(nx_) * static_cast<double>(ny_);
  *pdf = static_cast<float>(static_cast<double>(weights_[cell]) / total_ * cells);
  return p;
}

// The searches of all rows go down side by side, a level at a time.
void Distribution2D::prefetch(std::span<const Vec2f> u, std::span<size_t> cells) const {
  const size_t width = static_cast<size_t>(nx_), stride = treeSize(width + 1);
  std::array<size_t, 16> levels{};  // offsets, the widest first
  size_t depth = 0, offset = 0;
  for (size_t count = width + 1;; count = (count + kChildren - 1) / kChildren) {
    levels[depth++] = offset;
    offset += paddedSize(count);
    if (count <= kChildren) break;
  }
  std::vector<size_t> nodes(u.size(), 0);
  for (size_t i = 0; i < u.size(); ++i) {
    Vec2f inside;
    cells[i] = static_cast<size_t>(invert(marginal_.data(), ny_, u[i].y, &inside.y));
  }
  while (depth-- > 0) {
    const auto node = [&](size_t i) {
      return conditional_.data() + cells[i] * stride + levels[depth] + nodes[i] * kChildren;
    };
    for (size_t i = 0; i < u.size(); ++i) touch(node(i));
    for (size_t i = 0; i < u.size(); ++i)
      nodes[i] = nodes[i] * kChildren + chooseChild(node(i), u[i].x);
  }
  for (size_t i = 0; i < u.size(); ++i) cells[i] = cells[i] * width + std::min(nodes[i], width - 1);
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
