#include "lobelia/transfer/resultant.h"

#include <array>

#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/interpolation-inl.h"
#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {
namespace {

constexpr auto kCells = static_cast<size_t>(kResultantCells);

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

const float* resultantCorrections() { return kCorrections.data(); }

float kappaOfResultant(float r) {
  return core::kappaByTable(r, kCorrections.data(), kResultantCells, kMostKappa);
}

}  // namespace lobelia::transfer
