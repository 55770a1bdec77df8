// As bsdf/gaussian_mixture.cpp, but for whole lobes: what they have below the horizon is light that
// is looked up there, so that it has to come off what is above. In doubles and by differences of
// logarithms: points far out in a tail are farther from all lobes than floats reach.
#include "lobelia/transfer/lobe_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/reflection.h"
#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {
namespace {

constexpr size_t kMost = Reflection::kFewLobes;
constexpr double kLeastKappa = 1e-2, kLeastShare = 1e-6;

struct Moment {
  double mass = 0, x = 0, z = 0;
};

// Logarithm of share times density where w is the axis.
double logPeak(const FitLobe& lobe) {
  const double k = lobe.kappa;
  return std::log(std::max(lobe.share, 1e-300) * k / -std::expm1(-2 * k));
}

// The masses and directions of the points, shared out by the lobes' densities there.
std::array<Moment, kMost> shareOut(std::span<const FitPoint> points,
                                   std::span<const FitLobe> lobes) {
  std::array<Moment, kMost> moments{};
  std::array<double, kMost> peak, density;
  for (size_t j = 0; j < lobes.size(); ++j) peak[j] = logPeak(lobes[j]);
  for (const FitPoint& point : points) {
    double most = -1e300, sum = 0;
    for (size_t j = 0; j < lobes.size(); ++j) {
      density[j] = peak[j] + lobes[j].kappa * (dot(lobes[j].axis, point.w) - 1);
      most = std::max(most, density[j]);
    }
    for (size_t j = 0; j < lobes.size(); ++j) sum += density[j] = std::exp(density[j] - most);
    for (size_t j = 0; j < lobes.size(); ++j) {
      const double mass = point.mass * density[j] / sum;
      moments[j].mass += mass;
      moments[j].x += mass * point.w.x;
      moments[j].z += mass * point.w.z;
    }
  }
  return moments;
}

}  // namespace

void fitLobes(std::span<const FitPoint> points, int iterations, std::span<FitLobe> lobes) {
  double total = 0;
  for (const FitPoint& point : points) total += point.mass;
  if (!(total > 0)) return;
  for (int i = 0; i < iterations; ++i) {
    const std::array<Moment, kMost> moments = shareOut(points, lobes);
    for (size_t j = 0; j < lobes.size(); ++j) {
      const Moment& m = moments[j];
      lobes[j].share = m.mass / total;
      const double length = std::hypot(m.x, m.z);
      if (!(lobes[j].share > kLeastShare) || !(length > 0)) continue;  // nothing depends on it
      lobes[j].axis = {m.x / length, 0, m.z / length};
      lobes[j].kappa = std::clamp(lobes::inverseMeanResultant(std::min(length / m.mass, 1 - 1e-9)),
                                  kLeastKappa, static_cast<double>(kMostKappa));
    }
  }
}

}  // namespace lobelia::transfer
