#include "lobelia/transfer/lobe_sum.h"

#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/transfer/interpolation-inl.h"

namespace lobelia::transfer {

void LobeSum::add(float weight, const TransferLobe& lobe, Vec3f mirror) {
  const float energy = weight * luminance(lobe.share);
  share_ += lobe.share * weight;
  moment_ += lobe.r * energy;
  mirrors_ += mirror * energy;
  lengths_ += length(lobe.r) * energy;
  energy_ += energy;
}

TransferLobe LobeSum::lobe() const {
  if (empty()) return {};
  const float moment = length(moment_);
  if (moment <= 0) return {share_, {}};
  const core::LobeTotals<float> totals{toCore(moment_), toCore(mirrors_), lengths_, energy_};
  const float size = core::resultantBetween(totals, moment, sqr(kMagnification));
  return {share_, moment_ * (size / moment)};
}

}  // namespace lobelia::transfer
