// The lights that stand for all in one slice of a picture [Ou11]: clusters of all lights by all
// slices' rows are split further by the rows of the slice and its neighbours, and one light is
// drawn of each, with probability nearly in proportion to its weight there.
//
// The costs of clusters, the splitting phase, the drawing and the unseen part of a light are those
// of matrix row-column sampling (mrcs_clusters.h, mrcs_columns.h), over fewer rows. Deviations:
// those of these files, and the rows' factors: 1 / (1 + d^2 / m), d the distance of their slices,
// m the mean of d^2 over the neighbours. Past
// the paper, the length of a light's whole column is one more value: lights that matter elsewhere
// and that none of the few rows happens to see would else be drawn so seldom, and scaled so much,
// that whole slices flare up.
#pragma once

#include "lobelia/gather/mrcs.h"
#include "lobelia/gather/receiver_slices.h"

namespace lobelia::gather {

struct RowFactor {
  uint32_t row;
  float factor;
};
// Of the root mean square of the values of all rows, as one more value of a column.
inline constexpr float kElsewhereFactor = 0.3f;
// The columns of some rows, each times its factor, and that value. columns: kept whole, row r that
// of slice r's representative.
LightColumns columnsOfRows(const LightColumns& columns, std::span<const RowFactor> rows);

// Bytes per light that chooseForSlice() takes, with so many rows.
size_t sliceBytes(size_t rows);

// Rows that tell about a slice, its own first.
std::vector<RowFactor> rowsOfSlice(const ReceiverSlices& slices, size_t slice, size_t rows);

// global: clusters by all rows; they are split until there are `count`. Sorted by light.
std::vector<Representative> chooseForSlice(const LightColumns& columns, const Clustering& global,
                                           std::span<const RowFactor> rows, size_t count,
                                           uint64_t seed);

}  // namespace lobelia::gather
