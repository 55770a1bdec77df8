// Expectation maximisation for vMF mixtures (Banerjee et al. 2005, "Clustering on the unit
// hypersphere using von Mises-Fisher distributions", JMLR 6), weighted, and for data cut off at the
// horizon: what the current lobes have below it is added to their moments as missing data, without
// which wide lobes come out too narrow. A lobe left with a single sample would become a needle:
// none gets narrower than the solid angle of its samples.
#include "lobelia/bsdf/gaussian_mixture.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

constexpr float kMinSharpness = 1e-2f, kMaxFitSharpness = 1e6f;
constexpr float kMaxBelow = 0.9f;
constexpr float kMinAxisZ = 0.01f;  // lights need axes on their side of the surface

// What falls to a part: the moments of its directions, and their density weighted likewise.
struct Support {
  lobes::Moment moment;
  float density = 0;
};

// Adds direction w, spread over the parts by their densities: all of `mass` (data), or, with
// area > 0, the mass that the parts themselves have in that solid angle.
void scatter(std::span<const ShapePart> parts, std::span<const float> scales,
             const LobeSample& sample, Vec3f w, float mass, float area,
             std::span<Support> support) {
  std::array<float, kMaxParts> density;
  float sum = 0;
  for (size_t j = 0; j < parts.size(); ++j) {
    sum += density[j] = scales[j] * lobes::gaussian(parts[j].axis, parts[j].sharpness, w);
  }
  if (!(sum > 0)) return;
  const float factor = area > 0 ? area : mass / sum;
  for (size_t j = 0; j < parts.size(); ++j) {
    support[j].moment.add({factor * density[j], w * (factor * density[j])});
    support[j].density += factor * density[j] / sample.solidAngle;
  }
}

void requireFinite(std::span<const LobeSample> samples) {
  for (size_t i = 0; i < samples.size(); ++i) {
    const LobeSample& s = samples[i];
    if (isFinite(s.w) && std::isfinite(s.weight) && std::isfinite(s.solidAngle)) continue;
    throw std::invalid_argument(
        fmt::format("sample {} of a lobe: direction ({}, {}, {}), weight {}, solid angle {}; all "
                    "must be finite",
                    i, s.w.x, s.w.y, s.w.z, s.weight, s.solidAngle));
  }
}

}  // namespace

void fitMixture(std::span<const LobeSample> samples, int iterations, bool cutOff,
                std::span<ShapePart> parts) {
  requireFinite(samples);
  const size_t n = parts.size();
  double total = 0;
  for (const LobeSample& s : samples) total += static_cast<double>(s.weight);
  if (!(total > 0)) return;
  std::array<float, kMaxParts> scales;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    for (size_t j = 0; j < n; ++j) scales[j] = parts[j].share / lobes::integral(parts[j].sharpness);
    std::array<Support, kMaxParts> seen{}, below{};
    for (const LobeSample& s : samples) {
      scatter(parts, std::span(scales).first(n), s, s.w, s.weight / static_cast<float>(total), 0,
              seen);
      if (cutOff) scatter(parts, std::span(scales).first(n), s, flipZ(s.w), 0, s.solidAngle, below);
    }
    float hidden = 0, sum = 0;
    for (size_t j = 0; j < n; ++j) hidden += below[j].moment.weight;
    const float complete = 1 / (1 - std::min(hidden, kMaxBelow));
    const float cap = hidden > kMaxBelow ? kMaxBelow / hidden : 1.f;
    std::array<float, kMaxParts> narrowest;
    for (size_t j = 0; j < n; ++j) {
      lobes::Moment& moment = seen[j].moment;
      narrowest[j] = kTwoPi * seen[j].density / std::max(moment.weight, 1e-30f);
      moment.add(
          {below[j].moment.weight * complete * cap, below[j].moment.first * (complete * cap)});
      sum += moment.weight;
    }
    for (size_t j = 0; j < n; ++j) {
      parts[j].share = seen[j].moment.weight / sum;
      if (!(parts[j].share > 1e-5f)) continue;  // its place no longer matters
      const lobes::SphericalGaussian g =
          lobes::lobeOf(seen[j].moment, std::min(narrowest[j], kMaxFitSharpness));
      parts[j].sharpness = std::max(g.sharpness, kMinSharpness);
      parts[j].axis = normalize(Vec3f(g.axis.x, g.axis.y, std::max(g.axis.z, kMinAxisZ)));
    }
  }
  float sum = 0;
  for (ShapePart& p : parts) {
    p.share *= lobes::hemisphereIntegral(p.axis.z, p.sharpness) / lobes::integral(p.sharpness);
    sum += p.share;
  }
  for (ShapePart& p : parts) p.share /= sum;
}

float mixtureError(std::span<const LobeSample> samples, std::span<const ShapePart> parts) {
  requireFinite(samples);
  std::array<float, kMaxParts> scales;
  for (size_t j = 0; j < parts.size(); ++j) {
    scales[j] = parts[j].share / lobes::hemisphereIntegral(parts[j].axis.z, parts[j].sharpness);
  }
  float total = 0, error = 0, found = 0;
  for (const LobeSample& s : samples) total += s.weight;
  for (const LobeSample& s : samples) {
    float density = 0;
    for (size_t j = 0; j < parts.size(); ++j) {
      density += scales[j] * lobes::gaussian(parts[j].axis, parts[j].sharpness, s.w);
    }
    error += std::abs(s.weight / total - density * s.solidAngle);
    found += density * s.solidAngle;
  }
  // What the parts send where the lobe has no samples.
  return error + std::max(0.f, 1 - found);
}

}  // namespace lobelia
