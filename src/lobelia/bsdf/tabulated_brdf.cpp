#include "lobelia/bsdf/tabulated_brdf.h"

#include <algorithm>
#include <cmath>

namespace lobelia {
namespace {

int entryOf(float x, int count) {
  return std::clamp(static_cast<int>(x * static_cast<float>(count)), 0, count - 1);
}
float middleOf(int i, int count) {
  return (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
}

}  // namespace

HalfDifference toHalfDifference(Vec3f wo, Vec3f wi) {
  const Vec3f h = normalize(wo + wi);
  const float sine = std::sqrt(h.x * h.x + h.y * h.y);
  HalfDifference angles;
  angles.thetaH = std::atan2(sine, h.z);
  // wi in the frame of h: turned about z until h.y = 0, then about y until h = z.
  const float c = sine > 0 ? h.x / sine : 1, s = sine > 0 ? h.y / sine : 0;
  const float along = c * wi.x + s * wi.y;
  const Vec3f d(h.z * along - sine * wi.z, c * wi.y - s * wi.x, sine * along + h.z * wi.z);
  angles.thetaD = std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z);
  angles.phiD = std::atan2(d.y, d.x);
  // Exchanging wo and wi turns phi by pi.
  if (angles.phiD < 0) angles.phiD += kPi;
  if (angles.phiD >= kPi) angles.phiD -= kPi;
  return angles;
}

DirectionPair toDirections(const HalfDifference& angles) {
  const float sh = std::sin(angles.thetaH), ch = std::cos(angles.thetaH);
  const float sd = std::sin(angles.thetaD), cd = std::cos(angles.thetaD);
  const float x = sd * std::cos(angles.phiD), y = sd * std::sin(angles.phiD);
  // The difference vector turned about y from z to h; its mirror image at h has x, y negated.
  return {{sh * cd - ch * x, -y, ch * cd + sh * x}, {sh * cd + ch * x, y, ch * cd - sh * x}};
}

size_t TabulatedBrdf::index(const HalfDifference& angles) {
  return index(entryOf(std::sqrt(std::max(angles.thetaH, 0.f) / (kPi / 2)), kThetaH),
               entryOf(angles.thetaD / (kPi / 2), kThetaD), entryOf(angles.phiD / kPi, kPhiD));
}

HalfDifference TabulatedBrdf::centre(int thetaH, int thetaD, int phiD) {
  return {sqr(middleOf(thetaH, kThetaH)) * (kPi / 2), middleOf(thetaD, kThetaD) * (kPi / 2),
          middleOf(phiD, kPhiD) * kPi};
}

Rgb evaluate(const TabulatedBrdf& table, Vec3f wo, Vec3f wi) {
  if (!(wo.z > 0 && wi.z > 0)) return {};
  const Rgb value = table.values[TabulatedBrdf::index(toHalfDifference(wo, wi))];
  return isMeasured(value) ? value : Rgb{};
}

void countInvalid(TabulatedBrdf& table) {
  table.invalidCount = table.aboveCount = 0;
  for (int h = 0; h < TabulatedBrdf::kThetaH; ++h) {
    for (int d = 0; d < TabulatedBrdf::kThetaD; ++d) {
      for (int p = 0; p < TabulatedBrdf::kPhiD; ++p) {
        const DirectionPair pair = toDirections(TabulatedBrdf::centre(h, d, p));
        if (!(pair.wo.z > 0 && pair.wi.z > 0)) continue;
        ++table.aboveCount;
        if (!isMeasured(table.values[TabulatedBrdf::index(h, d, p)])) ++table.invalidCount;
      }
    }
  }
}

}  // namespace lobelia
