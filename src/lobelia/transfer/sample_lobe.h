// A lobe fitted to samples [P002 section 4, eqs. 2, 3; Green06].
#pragma once

#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {

// Sums over samples of where light comes from, each with what of it is reflected.
class SampleLobe {
 public:
  void add(Rgb weight, Vec3f direction);
  bool empty() const { return energy_ <= 0; }
  // total: that of which the shares are parts. single: length of r where there are too few samples
  // to tell how wide the lobe is. The length is that of the mean direction less what of it comes
  // from there being few samples: for n unit vectors E|mean|^2 = |r|^2 + (1 - |r|^2) / n, which
  // [P002 eq. 3] leaves in (kappa 8 % too high at n = 16; methods.md 0.2). n: effective number.
  TransferLobe lobe(float total, float single) const;

 private:
  Rgb sum_{};
  Vec3f first_{};
  float energy_ = 0, squares_ = 0;
};

}  // namespace lobelia::transfer
