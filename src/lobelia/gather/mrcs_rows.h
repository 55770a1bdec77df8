// The rows of matrix row-column sampling: some pixels, one drawn in each of as many blocks of the
// image [Hasan07 section 4; Hasan09 section 3.3].
//
// Past the papers, an eighth of further pixels are drawn to check: clustering and the choice of
// representatives do not see them, so that the error predicted from them is neither flattered by
// clusters that fit the rows nor by lights that the rows do not see.
#pragma once

#include <vector>

#include "lobelia/path/receivers.h"

namespace lobelia::gather {

struct RowPixels {
  static constexpr uint32_t kNone = 0xffffffffu;
  PixelSet pixels;                   // of rows and checks
  std::vector<uint32_t> row, check;  // of each pixel its number among them, or kNone
  size_t rowCount = 0, checkCount = 0;
};

// allowed: the pixels that are rendered; empty: all of the window. Where these are no more than
// rows and checks together, all of them are both.
RowPixels chooseRowPixels(int width, int height, const PixelSet& allowed, size_t rows,
                          uint64_t seed);

struct Rows {
  Receivers receivers;  // of all those pixels, neighbours near one another
  // Of each receiver point; a row is the sum over the points of its pixel.
  std::vector<uint32_t> row, check;
  size_t rowCount = 0, checkCount = 0;
};

// receivers: what traceReceivers() gives for those pixels.
Rows makeRows(const RowPixels& chosen, Receivers receivers, int width);

}  // namespace lobelia::gather
