// Interpolation of lobes of transfer between directions and between vertices
// [P002 section 4, eq. 7; methods.md 3.2].
//
// The paper interpolates axis, kappa and alpha, each by itself; sums of (share, share r) keep
// energy and first moment, but widen sharp lobes: between directions 8 degrees apart a lobe of
// kappa 257 becomes one of about 140, though the true one is as sharp as its neighbours. So the
// axis is that of the sum, and the length of r, which says how wide the lobe is, the mean of the
// lobes' lengths, but at most that of the sum and so much more as the lobes are apart because they
// are seen from different directions: kMagnification^2 times what mirror directions as far apart
// would lose. A lobe that another surface's curvature throws farther apart than that, or that
// comes from another object, is a wider one.
#pragma once

#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {

class LobeSum {
 public:
  // How much farther apart than the mirror directions lobes may be and still count as one that
  // moves.
  static constexpr float kMagnification = 2;

  // weight: >= 0; of all that is added, what is not stored included, they should sum to 1. mirror:
  // unit; where a perfect mirror at the lobe's vertex would take the eye's direction.
  void add(float weight, const TransferLobe& lobe, Vec3f mirror);
  bool empty() const { return energy_ <= 0; }
  // The lobe between those added. r: length below 1.
  TransferLobe lobe() const;

 private:
  Rgb share_{};
  Vec3f moment_{}, mirrors_{};
  float energy_ = 0, lengths_ = 0;
};

// A lobe with energy: what a place reflects. Sums of these are sums of light.
struct LobeMoment {
  Rgb alpha{};    // hemispherical integral of the transfer
  Vec3f first{};  // luminance of alpha times r
};

}  // namespace lobelia::transfer
