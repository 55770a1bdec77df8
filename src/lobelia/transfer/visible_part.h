// What is seen of infinity through a surface's own glossy lobe: pass 0 of transfer, told by how it
// differs from the lobe where nothing is in the way, so that an unoccluded lobe moves and widens
// exactly as the material's does between the directions and vertices where slices are.
// [P002 section 5.1 interpolates the visible lobes themselves]
#pragma once

#include "lobelia/transfer/lobe_sum.h"
#include "lobelia/transfer/reflection.h"

namespace lobelia::transfer {

struct VisiblePart {
  bool whole = true;  // nothing is in the way: the rest is not looked at
  Rgb share{1, 1, 1};
  Vec3f own{0, 0, 1};   // unit: mean direction of the unoccluded lobe there,
  Vec3f axis{0, 0, 1};  // of its visible part
  float width = 1;      // of the visible part's 1 / kappa to the unoccluded lobe's
};

// lobe: of a slice that is stored; own: mean r of the unoccluded lobe of the same vertex and
// direction.
VisiblePart visiblePart(const TransferLobe& lobe, Vec3f own);

// Interpolation: parts are turned with the unoccluded lobe from where they are known to where they
// are wanted.
class VisibleSum {
 public:
  // r: mean of the unoccluded lobe where the sum is wanted.
  explicit VisibleSum(Vec3f r);
  // Weights sum to 1.
  void add(float weight, const VisiblePart& part);
  VisiblePart part() const;

 private:
  Vec3f own_{};
  float kappa_ = 0;
  bool whole_ = true;
  Rgb share_{};
  Vec3f axes_{};
  float energy_ = 0, widths_ = 0;
};

// What is left of a lobe of the unoccluded reflection, all of whose lobes are shifted and narrowed
// alike.
ReflectedLobe visibleOf(const ReflectedLobe& lobe, const VisiblePart& part);
// Of all glossy lobes as one.
LobeMoment visibleOf(const Reflection& own, const VisiblePart& part);

}  // namespace lobelia::transfer
