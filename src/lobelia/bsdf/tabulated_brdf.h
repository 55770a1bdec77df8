// Isotropic reflectance as a table over the angles of the half and difference vectors
// [Rusinkiewicz98], at the resolution of the MERL measurements [Matusik03].
#pragma once

#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia {

// theta of the half vector to the normal; theta and phi of a direction to the half vector.
// Isotropic and reciprocal reflectance needs phi only up to pi.
struct HalfDifference {
  float thetaH = 0, thetaD = 0, phiD = 0;
};
HalfDifference toHalfDifference(Vec3f wo, Vec3f wi);  // n = +z
struct DirectionPair {
  Vec3f wo, wi;
};
DirectionPair toDirections(const HalfDifference& angles);

struct TabulatedBrdf {
  static constexpr int kThetaH = 90, kThetaD = 90, kPhiD = 180;
  static constexpr size_t kSize = size_t{kThetaH} * kThetaD * kPhiD;

  // f (no cosine), [thetaH][thetaD][phiD]; a negative channel: not measured. thetaH is stored by
  // its square root, which gives highlights more entries.
  std::vector<Rgb> values = std::vector<Rgb>(kSize, Rgb(-1.f));
  // Entries with a negative channel, of those with both directions above the horizon.
  size_t invalidCount = 0, aboveCount = 0;

  static size_t index(int thetaH, int thetaD, int phiD) {
    return (static_cast<size_t>(thetaH) * kThetaD + static_cast<size_t>(thetaD)) * kPhiD +
           static_cast<size_t>(phiD);
  }
  // The entry that these angles fall into.
  static size_t index(const HalfDifference& angles);
  // Angles in the middle of an entry.
  static HalfDifference centre(int thetaH, int thetaD, int phiD);
};

inline bool isMeasured(Rgb value) { return minComponent(value) >= 0; }
// f at the entry that the directions fall into, without interpolation (as MERL's own reader);
// black where nothing was measured or a direction is below the horizon.
Rgb evaluate(const TabulatedBrdf& table, Vec3f wo, Vec3f wi);
// Sets invalidCount and aboveCount.
void countInvalid(TabulatedBrdf& table);

}  // namespace lobelia
