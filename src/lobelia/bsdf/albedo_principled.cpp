// The lobe is a polynomial in roughness whose coefficients are integrals over wi of powers of
// cos_d^2 (cos_d: half angle) and of Schlick's weight F_i, with and without 1 / (cos_i + cos_o):
// tabulated over cos_o, the albedo is exact for every roughness, flatness and sheen.
#include "lobelia/bsdf/albedo_principled.h"

#include <array>
#include <cmath>

#include "lobelia/bsdf/quadrature.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

// plain[p][q]: integral of cos_d^(2p) F_i^q cos_i / pi; flat: the same over (cos_i + cos_o);
// sheen: of Schlick's weight at cos_d, times cos_i.
struct Moments {
  double plain[3][2] = {}, flat[3][2] = {}, sheen = 0;
};
constexpr int kCosines = 65;

std::array<Moments, kCosines> integrateMoments() {
  const GaussRule rule = gaussLegendre(24);
  std::array<Moments, kCosines> table;
  for (int n = 0; n < kCosines; ++n) {
    const double co = std::max(static_cast<double>(n) / (kCosines - 1), 1e-4);
    const double so = std::sqrt(1 - co * co);
    Moments& m = table[static_cast<size_t>(n)];
    for (size_t a = 0; a < rule.nodes.size(); ++a) {
      // cos_i dcos_i = d(cos_i^2) / 2: nodes uniform in cos_i, weight 2 cos_i.
      const double ci = rule.nodes[a], si = std::sqrt(1 - ci * ci);
      const double fi = static_cast<double>(core::schlickWeight(static_cast<float>(ci)));
      for (size_t b = 0; b < rule.nodes.size(); ++b) {
        const double cosPhi = std::cos(3.14159265358979323846 * rule.nodes[b]);
        const double cd2 = std::max(0.0, 0.5 * (1 + co * ci + so * si * cosPhi));
        const double w = rule.weights[a] * rule.weights[b] * 2 * ci;
        double power = w;
        for (int p = 0; p < 3; ++p, power *= cd2) {
          for (int q = 0; q < 2; ++q) {
            const double value = q == 0 ? power : power * fi;
            m.plain[p][q] += value;
            m.flat[p][q] += value / (ci + co);
          }
        }
        m.sheen += w * 3.14159265358979323846 *
                   static_cast<double>(core::schlickWeight(static_cast<float>(std::sqrt(cd2))));
      }
    }
  }
  return table;
}

// Albedo of the base without its colour, and of the sheen without colour.
struct Parts {
  double base, sheen;
};
Parts partsAt(const Moments& m, double fo, double roughness, double flatness) {
  const double r = roughness;
  const double diffuse = (1 - 0.5 * fo) * (m.plain[0][0] - 0.5 * m.plain[0][1]);
  const double retro =
      2 * r * (fo * m.plain[1][0] + (1 - fo) * m.plain[1][1]) + 4 * r * r * fo * m.plain[2][1];
  const auto subsurface = [&](const double(&t)[3][2]) {
    return (1 - fo) * (t[0][0] - t[0][1]) + r * (fo * t[1][0] + (1 - 2 * fo) * t[1][1]) +
           r * r * fo * t[2][1];
  };
  const double flat = 1.25 * (subsurface(m.flat) - 0.5 * subsurface(m.plain) + 0.5 * m.plain[0][0]);
  return {(diffuse + retro) * (1 - flatness) + flat * flatness, m.sheen};
}

}  // namespace

Rgb principledDiffuseAlbedo(const Lobe& lobe, float cosine) {
  static const std::array<Moments, kCosines> table = integrateMoments();
  const float x = std::clamp(cosine, 0.f, 1.f) * static_cast<float>(kCosines - 1);
  const int i = std::min(static_cast<int>(x), kCosines - 2);
  const double t = static_cast<double>(x - static_cast<float>(i));
  const double fo = static_cast<double>(core::schlickWeight(cosine));
  const auto at = [&](int node) {
    return partsAt(table[static_cast<size_t>(node)], fo, static_cast<double>(lobe.parameters.x),
                   static_cast<double>(lobe.parameters.y));
  };
  const Parts a = at(i), b = at(i + 1);
  return lobe.weight *
         (lobe.k * static_cast<float>(a.base * (1 - t) + b.base * t) +
          lobe.tint * (lobe.parameters.z * static_cast<float>(a.sheen * (1 - t) + b.sheen * t)));
}

}  // namespace lobelia
