#include "lobelia/transfer/resultant.h"

#include <algorithm>
#include <array>

#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {
namespace {

constexpr size_t kCells = 256;

double banerjee(double r) { return r * (3 - r * r) / ((1 - r) * (1 + r)); }

// At both ends the formula is right.
std::array<float, kCells + 2> corrections() {
  std::array<float, kCells + 2> out;
  out.fill(1);
  for (size_t i = 1; i < kCells; ++i) {
    const double r = static_cast<double>(i) / kCells;
    out[i] = static_cast<float>(lobes::inverseMeanResultant(r) / banerjee(r));
  }
  return out;
}
const std::array<float, kCells + 2> kCorrections = corrections();

}  // namespace

float kappaOfResultant(float r) {
  r = std::clamp(r, 0.f, 1.f);
  const float at = r * kCells;
  const auto cell = static_cast<size_t>(at);
  const float share = at - static_cast<float>(cell);
  const float correction = kCorrections[cell] * (1 - share) + kCorrections[cell + 1] * share;
  return std::min(correction * r * (3 - r * r) / std::max((1 - r) * (1 + r), 1e-7f), kMostKappa);
}

}  // namespace lobelia::transfer
