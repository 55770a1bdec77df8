// The mean of passes over a picture, each of some samples per pixel, and how far it is from where
// it goes.
//
// The error is estimated from how much passes differ: with weights w (samples) and luminances y, a
// sample's variance is (sum w y^2 - (sum w y)^2 / sum w) / (n - 1), the mean's that over sum w.
#pragma once

#include <vector>

#include "lobelia/film/film.h"

namespace lobelia::app {

class PassMean {
 public:
  // Of the same size as the passes before. Pixels that are not finite count as black and are
  // counted.
  void add(const Film& pass, int samples);
  void clear() { *this = PassMean(); }

  int passes() const { return passes_; }
  int samples() const { return samples_; }
  uint64_t nonFinite() const { return nonFinite_; }
  // sqrt(sum of variances / sum of squared means) over all pixels: about what `compare` calls l2;
  // 0 before there are two passes.
  double relativeError() const;
  // The picture with the layers that passes have, all means; "samples" (1 channel) and, of two
  // passes or more, "error" (1 channel: the standard error of the luminance).
  Film film() const;

 private:
  double variance(size_t pixel) const;  // of the mean

  Film shape_;  // of the first pass
  std::vector<double> picture_, squares_;
  std::vector<double> cost_;
  int passes_ = 0, samples_ = 0;
  uint64_t nonFinite_ = 0;
};

}  // namespace lobelia::app
