#include "lobelia/transfer/slice_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::transfer {
namespace {

// Shares: 9 bits for each colour, times 2^(exponent - 31).
constexpr int kColourBits = 9, kExponentBias = 22;
constexpr uint32_t kColourMask = (1u << kColourBits) - 1;

uint32_t packShare(Rgb share) {
  const float most = std::min(maxComponent(share), 1e4f);
  if (!(most > 0)) return 0;
  // The largest colour fills its bits; what would round up to a bit more has the next exponent.
  int exponent = std::clamp(std::ilogb(most) + 1 - kColourBits + kExponentBias, 0, 31);
  const auto mantissa = [&](float v) {
    return std::lround(std::ldexp(std::clamp(v, 0.f, most), kExponentBias - exponent));
  };
  if (mantissa(most) > static_cast<long>(kColourMask)) exponent = std::min(exponent + 1, 31);
  const auto bits = [&](float v) {
    return static_cast<uint32_t>(std::min(mantissa(v), static_cast<long>(kColourMask)));
  };
  const uint32_t colours =
      bits(share.x) | bits(share.y) << kColourBits | bits(share.z) << 2 * kColourBits;
  return colours == 0 ? 0 : colours | static_cast<uint32_t>(exponent) << 3 * kColourBits;
}

// Scales by exponent, and |r| by the code of kappa: reading is a look-up.
struct Tables {
  std::array<float, 32> scale;
  std::array<float, 1024> resultant;
};
constexpr float kLeastKappa = 1.f / 64;
constexpr int kKappaCodes = 1024;

float kappaOfCode(int code) {
  return kLeastKappa * std::pow(kMostKappa / kLeastKappa,
                                static_cast<float>(code) / static_cast<float>(kKappaCodes - 1));
}

const Tables& tables() {
  static const Tables made = [] {
    Tables t{};
    for (int e = 0; e < 32; ++e)
      t.scale[static_cast<size_t>(e)] = std::ldexp(1.f, e - kExponentBias);
    for (int c = 0; c < kKappaCodes; ++c)
      t.resultant[static_cast<size_t>(c)] =
          static_cast<float>(lobes::meanResultant(static_cast<double>(kappaOfCode(c))));
    return t;
  }();
  return made;
}

uint32_t codeOfLength(float r) {
  const double kappa =
      lobes::inverseMeanResultant(static_cast<double>(std::clamp(r, 0.f, 1 - 0x1p-20f)));
  const double place = std::log(std::max(kappa / static_cast<double>(kLeastKappa), 1e-9)) /
                       std::log(static_cast<double>(kMostKappa / kLeastKappa));
  return static_cast<uint32_t>(
      std::clamp(std::lround(place * (kKappaCodes - 1)), 0l, long{kKappaCodes - 1}));
}

// Octahedral [Cigolle14]: 11 bits each, [-1, 1] in 2,046 steps, so that 0 and both ends are exact.
constexpr int kAxisBits = 11, kAxisSteps = 2046;

Vec3f unpackAxis(uint32_t code) {
  constexpr uint32_t kMask = (1u << kAxisBits) - 1;
  float u = static_cast<float>(code & kMask) * (2.f / kAxisSteps) - 1;
  float v = static_cast<float>(code >> kAxisBits & kMask) * (2.f / kAxisSteps) - 1;
  const float z = 1 - std::abs(u) - std::abs(v);
  const float t = std::max(-z, 0.f);
  u += u >= 0 ? -t : t, v += v >= 0 ? -t : t;
  return normalize(Vec3f(u, v, z));
}

// The nearest of the four codes around the direction [Cigolle14]: rounding u and v each for itself
// is wrong by up to .12 degrees where the octahedron's faces lie slanted, this by less than .08.
uint32_t packAxis(Vec3f d) {
  const float sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  if (!(sum > 0)) d = {0, 0, 1};
  const float scale = sum > 0 ? 1 / sum : 1;
  float u = d.x * scale, v = d.y * scale;
  if (d.z < 0) {
    const float folded = (1 - std::abs(v)) * std::copysign(1.f, u);
    v = (1 - std::abs(u)) * std::copysign(1.f, v), u = folded;
  }
  const auto below = [](float x) {
    const float place = (std::clamp(x, -1.f, 1.f) + 1) * (kAxisSteps / 2);
    return std::min(static_cast<uint32_t>(place), static_cast<uint32_t>(kAxisSteps - 1));
  };
  const uint32_t first = below(u) | below(v) << kAxisBits;
  uint32_t best = first;
  float most = -std::numeric_limits<float>::infinity();
  for (const uint32_t step : {0u, 1u, 1u << kAxisBits, 1u | 1u << kAxisBits}) {
    const float cosine = dot(unpackAxis(first + step), d);
    if (cosine > most) most = cosine, best = first + step;
  }
  return best;
}

}  // namespace

SliceRecord pack(const TransferLobe& lobe) {
  return {packShare(lobe.share), packAxis(lobe.r) | codeOfLength(length(lobe.r)) << 2 * kAxisBits};
}

TransferLobe unpack(SliceRecord record) {
  const Tables& t = tables();
  const float scale = t.scale[record.share >> 3 * kColourBits];
  const auto colour = [&](int c) {
    return static_cast<float>(record.share >> c * kColourBits & kColourMask) * scale;
  };
  return {{colour(0), colour(1), colour(2)},
          unpackAxis(record.lobe) * t.resultant[record.lobe >> 2 * kAxisBits]};
}

}  // namespace lobelia::transfer
