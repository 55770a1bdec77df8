#include "lobelia/transfer/lobe_sum.h"

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
  const float mean = lengths_ / energy_;
  const float apart = std::max(0.f, 1 - length(mirrors_) / energy_);
  const float allowed = moment / energy_ + mean * sqr(kMagnification) * apart;
  return {share_, moment_ * (std::min(mean, allowed) / moment)};
}

}  // namespace lobelia::transfer
