// The reduced matrix of matrix row-column sampling: for every light its column, what it adds to the
// sampled rows (three channels stacked) [Hasan07 section 4], kept whole as in the paper or, past
// it, as a sketch.
//
// A sketch of d numbers is the column times a matrix of random signs over sqrt(d): lengths and
// distances of columns keep their values in the mean, with a relative deviation of sqrt(2/d) of
// their squares (Johnson and Lindenstrauss 1984; signs: Achlioptas 2003). Columns are made in
// blocks of lights and sketched at once, so that memory is d half floats per light whatever the
// number of rows.
//
// What the rows do not see. A light that no row sees may matter elsewhere, so every light has, at
// right angles to all that the rows show, an unseen part of length u: weight^2 = |column|^2 + u^2.
// u is a twentieth (kUnseenShare) of the mean length of the columns of the lights that at most one
// row sees: what a light that the rows miss might have added to its one row (as Good and Turing
// reckon with species not seen yet). So no light is dropped, and lights hardly seen are spread over
// clusters of their own by their number. The share is by experiment, 51,000 spherical lights in the
// kitchen and 4,000 columns: with u whole, errors are twice as great (too many columns go to lights
// that matter nowhere); that lights hardly seen get drawn often enough is seen to when they are
// drawn (drawProbability()).
#pragma once

#include "lobelia/gather/light_choice.h"
#include "lobelia/gather/mrcs_kernels.h"
#include "lobelia/gather/mrcs_rows.h"

namespace lobelia::gather {

struct ColumnSettings {
  GatherSettings gather;
  size_t dims = 64;  // of sketches; 0: whole columns
  uint64_t seed = 0;
  bool channels = false;  // lengths per channel, too
};
inline constexpr double kUnseenShare = 0.05;
inline constexpr size_t kCheckDims = 16;  // of sketches of the check rows

struct LightColumns {
  size_t count = 0;
  size_t dims = 0, checkDims = 0;     // of the part that rows give and of that from check rows
  std::vector<uint16_t> halves;       // sketches, [light][dims + checkDims]
  AlignedFloats whole;                // or whole columns
  std::vector<float> scale, weight;   // of each light
  double unseen = 0;                  // u^2
  double rowNorm = 0, checkNorm = 0;  // |sum of all columns| in the rows, in the check rows
  std::vector<Rgb> channels;          // |column| per channel

  size_t stride() const { return dims + checkDims; }
  size_t bytes() const;
  // Column over weight: dims values from rows, checkDims from check rows.
  void load(size_t i, float* out) const;
  // (unseen part over weight)^2
  double unseenOf(size_t i) const { return unseen / (double{weight[i]} * double{weight[i]}); }
};

// u^2 by the sum of lengths of the columns that at most one row sees, their number, and the least
// length of those that are seen (above kNoneSeen: none is).
inline constexpr float kNoneSeen = 2e38f;
double squaredUnseen(double hardlySeen, size_t hardlySeenCount, float leastSeen);

// Bytes per light.
size_t columnBytes(const Rows& rows, size_t dims);
// Counts "shadow_rays", "node_pairs_shaded" and "nonfinite"; books seconds to "rows". When
// cancelled, what it returns is of no use.
LightColumns computeColumns(const Tracer& tracer, const Rows& rows, const VirtualLights& lights,
                            const LightNumbers& numbers, const ColumnSettings& settings,
                            Context& context);

}  // namespace lobelia::gather
