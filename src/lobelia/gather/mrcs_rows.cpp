#include "lobelia/gather/mrcs_rows.h"

#include <algorithm>
#include <numeric>

#include "lobelia/base/morton.h"
#include "lobelia/base/random.h"

namespace lobelia::gather {
namespace {

// One pixel of each of `count` runs of the sorted set.
PixelSet spreadAmong(const PixelSet& allowed, size_t count, uint64_t seed) {
  PixelSet set;
  const size_t all = allowed.pixels.size();
  for (size_t i = 0; i < count; ++i) {
    const size_t begin = i * all / count, end = (i + 1) * all / count;
    set.pixels.push_back(allowed.pixels[begin + hashCombine(seed, i) % (end - begin)]);
  }
  return set;
}

}  // namespace

RowPixels chooseRowPixels(int width, int height, const PixelSet& allowed, size_t rows,
                          uint64_t seed) {
  const size_t window = static_cast<size_t>(width) * static_cast<size_t>(height);
  const size_t all = allowed.pixels.empty() ? window : allowed.pixels.size();
  const size_t checks = std::max<size_t>(rows / 8, 64), total = rows + checks;
  RowPixels chosen;
  if (all <= total) {
    chosen.pixels = allowed;
    if (allowed.pixels.empty()) {
      chosen.pixels.pixels.resize(window);
      std::iota(chosen.pixels.pixels.begin(), chosen.pixels.pixels.end(), 0u);
    }
    chosen.rowCount = chosen.checkCount = all;
    chosen.row.resize(all);
    std::iota(chosen.row.begin(), chosen.row.end(), 0u);
    chosen.check = chosen.row;
    return chosen;
  }
  chosen.pixels = allowed.pixels.empty() ? spreadPixels(width, height, total, seed)
                                         : spreadAmong(allowed, total, seed);
  for (size_t i = 0; i < total; ++i) {
    const bool isCheck = (i + 1) * checks / total > i * checks / total;
    chosen.row.push_back(isCheck ? RowPixels::kNone : static_cast<uint32_t>(chosen.rowCount++));
    chosen.check.push_back(isCheck ? static_cast<uint32_t>(chosen.checkCount++) : RowPixels::kNone);
  }
  return chosen;
}

Rows makeRows(const RowPixels& chosen, Receivers receivers, int width) {
  Rows rows;
  rows.rowCount = chosen.rowCount;
  rows.checkCount = chosen.checkCount;
  rows.receivers = std::move(receivers);
  const auto place = [&](const ReceiverPoint& point) {
    const uint32_t w = static_cast<uint32_t>(width);
    return morton(point.pixel % w, point.pixel / w);
  };
  // Directly seen points first, as traceReceivers() has it within its tiles.
  std::stable_sort(rows.receivers.points.begin(), rows.receivers.points.end(),
                   [&](const ReceiverPoint& a, const ReceiverPoint& b) {
                     return a.depth != b.depth ? a.depth < b.depth : place(a) < place(b);
                   });
  for (const ReceiverPoint& point : rows.receivers.points) {
    const auto& pixels = chosen.pixels.pixels;
    const auto i = static_cast<size_t>(std::lower_bound(pixels.begin(), pixels.end(), point.pixel) -
                                       pixels.begin());
    rows.row.push_back(chosen.row.at(i));
    rows.check.push_back(chosen.check.at(i));
  }
  return rows;
}

}  // namespace lobelia::gather
