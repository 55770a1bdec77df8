// Integrals of a spherical Gaussian over a hemisphere by quadrature: the oracle of the closed
// forms.
//
// With the hemisphere's normal as the pole, the integral over the azimuth is a Bessel function:
//   2 pi int_0^(pi/2) cos^p t sin t e^(sharpness (cos(t - tc) - 1)) I0e(sharpness sin tc sin t) dt,
// where tc is the angle from the normal to the axis and I0e(x) = e^-x I0(x).
#include <array>
#include <cmath>

#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::lobes {
namespace {

constexpr double kPiD = 3.14159265358979323846;

double besselI0Scaled(double x) {
  if (x < 40) return std::exp(-x) * std::cyl_bessel_i(0.0, x);
  // Asymptotic series [Abramowitz and Stegun 9.7.1]; at x = 40 its smallest term is below 1e-30.
  double term = 1, sum = 1;
  for (int k = 1; k < 20; ++k) {
    term *= (2.0 * k - 1) * (2.0 * k - 1) / (8.0 * k * x);
    sum += term;
  }
  return sum / std::sqrt(2 * kPiD * x);
}

// Gauss-Legendre quadrature with 10 points in each of `panels` equal parts.
template <class Function>
double integrate(double a, double b, int panels, const Function& f) {
  static constexpr std::array<double, 5> kNodes{0.1488743389816312, 0.4333953941292472,
                                                0.6794095682990244, 0.8650633666889845,
                                                0.9739065285171717};
  static constexpr std::array<double, 5> kWeights{0.2955242247147529, 0.2692667193099963,
                                                  0.2190863625159820, 0.1494513491505806,
                                                  0.0666713443086881};
  const double half = 0.5 * (b - a) / panels;
  double sum = 0;
  for (int i = 0; i < panels; ++i) {
    const double centre = a + (2 * i + 1) * half;
    for (size_t k = 0; k < kNodes.size(); ++k) {
      sum += kWeights[k] * half * (f(centre - half * kNodes[k]) + f(centre + half * kNodes[k]));
    }
  }
  return sum;
}

}  // namespace

double hemisphereIntegralExact(double cosine, double sharpness, int cosinePower) {
  const double c = std::min(1.0, std::max(-1.0, cosine));
  const double axisAngle = std::acos(c), axisSine = std::sin(axisAngle);
  const auto integrand = [&](double t) {
    // cos(t - tc) - 1 = -2 sin^2((t - tc)/2)
    const double half = std::sin(0.5 * (t - axisAngle));
    return std::pow(std::cos(t), cosinePower) * std::sin(t) *
           std::exp(-2 * sharpness * half * half) *
           besselI0Scaled(sharpness * axisSine * std::sin(t));
  };
  // Panels fine around the peak, whose width is 1/sqrt(sharpness), and coarse elsewhere. Below the
  // horizon the maximum is at the horizon with a scale of 1/(sharpness |cosine|).
  const double width = 1 / std::sqrt(std::max(sharpness, 1.0));
  double sum = 0, from = 0;
  for (double offset : {-12.0, -6.0, -3.0, -1.0, 0.0, 1.0, 3.0, 6.0, 12.0, 1e9}) {
    const double to = std::min(std::max(axisAngle + offset * width, 0.0), kPiD / 2);
    if (to > from) sum += integrate(from, to, 8, integrand), from = to;
  }
  return 2 * kPiD * sum;
}

}  // namespace lobelia::lobes
