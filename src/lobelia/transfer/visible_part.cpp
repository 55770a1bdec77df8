#include "lobelia/transfer/visible_part.h"

#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/interpolation-inl.h"
#include "lobelia/transfer/resultant.h"

namespace lobelia::transfer {

VisiblePart visiblePart(const TransferLobe& lobe, Vec3f own) {
  VisiblePart part{false, lobe.share, own, own, 1};
  const float ownLength = length(own), seen = length(lobe.r);
  if (ownLength > 0) part.own = part.axis = own / ownLength;
  if (ownLength <= 0 || seen <= 0) return part;
  part.axis = lobe.r / seen;
  part.width = kappaOfResultant(ownLength) / kappaOfResultant(seen);
  return part;
}

VisibleSum::VisibleSum(Vec3f r) {
  const float size = length(r);
  own_ = size > 0 ? r / size : Vec3f(0, 0, 1);
  kappa_ = kappaOfResultant(size);
}

void VisibleSum::add(float weight, const VisiblePart& part) {
  whole_ = whole_ && part.whole;
  const float energy = weight * (part.whole ? 1 : luminance(part.share));
  share_ += (part.whole ? Rgb(1) : part.share) * weight;
  if (energy <= 0) return;
  axes_ += (part.whole ? own_ : turned(part.axis, part.own, own_)) * energy;
  widths_ += (part.whole ? 1 : part.width) * energy;
  energy_ += energy;
}

VisiblePart VisibleSum::part() const {
  if (whole_) return {};
  VisiblePart part{false, share_, own_, own_, 1};
  const float size = length(axes_);
  if (energy_ <= 0 || size <= 0) return part;
  part.axis = axes_ / size;
  part.width = core::widthBetween(widths_, size, energy_, kappa_);
  return part;
}

ReflectedLobe visibleOf(const ReflectedLobe& lobe, const VisiblePart& part) {
  if (part.whole) return lobe;
  return {turned(lobe.axis, part.own, part.axis), lobe.kappa / part.width, lobe.alpha * part.share};
}

LobeMoment visibleOf(const Reflection& own, const VisiblePart& part) {
  if (part.whole) return {own.glossy, own.r * luminance(own.glossy)};
  const Rgb alpha = own.glossy * part.share;
  const float kappa = kappaOfResultant(length(own.r)) / part.width;
  return {alpha, part.axis * (luminance(alpha) * lobes::meanResultant(kappa))};
}

}  // namespace lobelia::transfer
