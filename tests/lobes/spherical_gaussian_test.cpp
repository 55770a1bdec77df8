#include "lobelia/lobes/spherical_gaussian.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "base/chi_squared.h"
#include "lobelia/base/frame.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobes/sphere_quadrature.h"

namespace lobelia::lobes {
namespace {

constexpr double kPiD = 3.14159265358979323846;
const Vec3f kAxis = normalize(Vec3f(0.3f, -0.5f, 0.7f));

double exactIntegral(double sharpness) {
  return sharpness == 0 ? 4 * kPiD : -2 * kPiD * std::expm1(-2 * sharpness) / sharpness;
}

Vec3f tilted(Vec3f axis, float degrees) {
  const Frame f = frameFromNormal(axis);
  const float a = degrees * kPi / 180;
  return f.toWorld({std::sin(a) * 0.6f, std::sin(a) * 0.8f, std::cos(a)});
}

TEST(SphericalGaussian, IntegralIsStable) {
  for (double l = 1e-8; l < 1e8; l *= 1.7) {
    const float f = static_cast<float>(l);
    const double exact = exactIntegral(static_cast<double>(f));
    EXPECT_NEAR(static_cast<double>(integral(f)) / exact, 1, 5e-7) << l;
  }
  EXPECT_FLOAT_EQ(integral(0), 4 * kPi);
}

TEST(SphericalGaussian, IntegralIsTheIntegral) {
  for (float l : {0.f, 0.5f, 3.f, 50.f, 2000.f}) {
    const double sum =
        test::integrateSphere(kAxis, 3000, 16, [&](Vec3f w) { return gaussian(kAxis, l, w); });
    EXPECT_NEAR(static_cast<double>(integral(l)) / sum, 1, 1e-5) << l;
  }
}

TEST(SphericalGaussian, ValueNearTheAxisOfASharpLobe) {
  // 1e-3 rad off the axis of sharpness 1e6: e^(-0.5 (1 - 1e-6/12..)) exactly; the plain dot product
  // has lost all its digits here.
  const float angle = 1e-3f;
  const Vec3f w = frameFromNormal(kAxis).toWorld({std::sin(angle), 0, std::cos(angle)});
  EXPECT_NEAR(gaussian(kAxis, 1e6f, w), std::exp(1e6 * (std::cos(1e-3) - 1)), 1e-3);
  EXPECT_FLOAT_EQ(evaluate({kAxis, 5, 3}, kAxis), 3);
}

TEST(SphericalGaussian, ProductIsTheProduct) {
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const SphericalGaussian a{sampleSphereUniform(rng.next2D()), 20 * rng.next1D(), 2},
        b{sampleSphereUniform(rng.next2D()), 20 * rng.next1D(), 0.5f};
    const SphericalGaussian ab = product(a, b), ba = product(b, a);
    const Vec3f w = sampleSphereUniform(rng.next2D());
    const float expected = evaluate(a, w) * evaluate(b, w);
    EXPECT_NEAR(evaluate(ab, w), expected, 2e-5f * expected + 1e-30f);
    EXPECT_NEAR(evaluate(ba, w), expected, 2e-5f * expected + 1e-30f);
    EXPECT_LE(productIntegral(a, b), std::min(a.amplitude * integral(a.sharpness) * b.amplitude,
                                              b.amplitude * integral(b.sharpness) * a.amplitude) *
                                         1.00001f);
  }
}

TEST(SphericalGaussian, ProductOfSharpLobesKeepsItsAmplitude) {
  // Against double precision, 0.1 degrees apart.
  for (float l : {1e3f, 1e4f, 1e5f, 1e6f}) {
    const Vec3f other = tilted(kAxis, 0.1f);
    const SphericalGaussian p = product({kAxis, l, 1}, {other, 0.5f * l, 1});
    const Vec3d a(kAxis.x, kAxis.y, kAxis.z), b(other.x, other.y, other.z);
    const Vec3d v =
        a / length(a) * static_cast<double>(l) + b / length(b) * (0.5 * static_cast<double>(l));
    const double g = length(v) - 1.5 * static_cast<double>(l);
    EXPECT_NEAR(std::log(static_cast<double>(p.amplitude)) - g, 0, 2e-4 * std::max(1.0, -g)) << l;
  }
}

TEST(SphericalGaussian, OppositeLobesMultiplyToAConstant) {
  const SphericalGaussian p = product({kAxis, 3, 1}, {-kAxis, 3, 1});
  EXPECT_NEAR(p.amplitude, std::exp(-6.f), 1e-6f);
  EXPECT_NEAR(evaluate(p, tilted(kAxis, 70)), std::exp(-6.f), 1e-6f);
  EXPECT_NEAR(productIntegral({kAxis, 3, 1}, {-kAxis, 3, 1}) / (4 * kPi * std::exp(-6.f)), 1,
              1e-5f);
  EXPECT_FLOAT_EQ(productIntegral({kAxis, 0, 1}, {-kAxis, 0, 1}), 4 * kPi);
}

TEST(SphericalGaussian, ProductIntegralByQuadrature) {
  for (float degrees : {0.f, 5.f, 40.f, 120.f}) {
    for (const auto& [l1, l2] : {std::pair(1.f, 2.f), {50.f, 3.f}, {60.f, 40.f}}) {
      const SphericalGaussian a{kAxis, l1, 2}, b{tilted(kAxis, degrees), l2, 3};
      const Vec3f pole = product(a, b).axis;
      const double sum = test::integrateSphere(
          pole, 1500, 256, [&](Vec3f w) { return evaluate(a, w) * evaluate(b, w); });
      EXPECT_NEAR(static_cast<double>(productIntegral(a, b)) / sum, 1, 3e-5)
          << degrees << " " << l1 << " " << l2;
    }
  }
}

TEST(MeanResultant, RoundTrip) {
  for (double k = 1e-3; k < 1e5; k *= 1.3) {
    const float kappa = static_cast<float>(k);
    const float r = meanResultant(kappa);
    // r near 1 holds kappa only to kappa times the float's rounding.
    const double tolerance = 1e-5 + 1.2e-7 * k;
    EXPECT_NEAR(static_cast<double>(inverseMeanResultant(r)) / k, 1, tolerance) << k;
  }
  EXPECT_EQ(inverseMeanResultant(0.f), 0.f);
  EXPECT_EQ(meanResultant(0.f), 0.f);
  EXPECT_TRUE(std::isinf(inverseMeanResultant(1.f)));
  for (const double kappa : {1e-3, 1.0, 1e3, 1e5, 1e7})
    EXPECT_NEAR(inverseMeanResultant(meanResultant(kappa)) / kappa, 1, 1e-6) << kappa;
}

TEST(MeanResultant, IsTheMeanCosine) {
  for (float kappa : {0.01f, 0.09f, 0.11f, 1.f, 2.954f, 20.f, 500.f}) {
    const double mean = test::integrateSphere(kAxis, 3000, 8, [&](Vec3f w) {
      const Vec3f d = w - kAxis;
      return vmfPdf(kAxis, kappa, w) * (1 - 0.5f * dot(d, d));
    });
    EXPECT_NEAR(static_cast<double>(meanResultant(kappa)) / mean, 1, 2e-4) << kappa;
  }
  // Lambert's mean cosine of 2/3 is the lobe of kappa 2.9515 (docs/lobes.md).
  EXPECT_NEAR(inverseMeanResultant(2 / 3.f), 2.9515f, 0.001f);
}

TEST(Hemisphere, QuadratureOracleAgreesWithTheSphereSum) {
  for (double l : {0.0, 2.0, 30.0, 400.0}) {
    for (float degrees : {0.f, 60.f, 90.f, 110.f}) {
      const Vec3f normal = tilted(kAxis, degrees);
      const double cosine = std::cos(static_cast<double>(degrees) * kPiD / 180);
      for (int power : {0, 1}) {
        // The pole at the normal: the clipping falls between rows, not across them.
        const Frame frame = frameFromNormal(normal);
        const Vec3f axis = frame.toLocal(kAxis);
        double sum = 0;
        constexpr int kRows = 6000, kColumns = 160;
        for (int i = 0; i < kRows; ++i) {
          const double z = (i + 0.5) / kRows, r = std::sqrt(1 - z * z);
          for (int j = 0; j < kColumns; ++j) {
            const double phi = 2 * kPiD * (j + 0.5) / kColumns;
            const double dot = static_cast<double>(axis.x) * r * std::cos(phi) +
                               static_cast<double>(axis.y) * r * std::sin(phi) +
                               static_cast<double>(axis.z) * z;
            sum += (power ? z : 1) * std::exp(l * (dot - 1));
          }
        }
        sum *= 2 * kPiD / kRows / kColumns;
        const double exact = hemisphereIntegralExact(cosine, l, power);
        EXPECT_NEAR(exact, sum, 3e-4 * sum + 1e-9) << l << " " << degrees << " " << power;
      }
    }
  }
}

TEST(Hemisphere, ClosedFormsStayWithinTheirErrors) {
  double worst = 0, worstCosine = 0;
  for (double l = 1e-4; l < 1e6; l *= 2.1) {
    for (int i = -40; i <= 40; ++i) {
      const double c = i / 40.0;
      const double area = exactIntegral(l);
      const auto cf = static_cast<float>(c), lf = static_cast<float>(l);
      const double h0 = static_cast<double>(hemisphereIntegral(cf, lf));
      const double h1 = static_cast<double>(cosineIntegral(cf, lf));
      worst = std::max(worst, std::abs(h0 - hemisphereIntegralExact(c, l, 0)) / area);
      worstCosine = std::max(worstCosine, std::abs(h1 - hemisphereIntegralExact(c, l, 1)) / area);
    }
  }
  EXPECT_LE(worst, 0.005);
  EXPECT_LE(worstCosine, 0.0015);
  EXPECT_NEAR(hemisphereIntegral(0.3f, 0), 2 * kPi, 1e-5f);
  EXPECT_NEAR(cosineIntegral(0.3f, 0), kPi, 1e-5f);
}

TEST(Vmf, DensityIntegratesToOne) {
  for (float kappa : {0.f, 0.1f, 5.f, 100.f, 5000.f}) {
    const double sum =
        test::integrateSphere(kAxis, 3000, 8, [&](Vec3f w) { return vmfPdf(kAxis, kappa, w); });
    EXPECT_NEAR(sum, 1, 2e-5) << kappa;
  }
}

TEST(Vmf, SamplerHasItsMeanAndItsDensity) {
  constexpr int kCount = 1 << 16, kCells = 32;
  for (float kappa : {0.f, 0.1f, 1.f, 10.f, 1000.f, 1e6f}) {
    Rng rng(21);
    double mean = 0, square = 0;
    std::array<double, kCells * 8> counts{}, expected{};
    expected.fill(kCount / static_cast<double>(kCells * 8));
    const Frame frame = frameFromNormal(kAxis);
    const double k = std::max(static_cast<double>(kappa), 1e-9);
    for (int i = 0; i < kCount; ++i) {
      const Vec3f w = sampleVmf(kAxis, kappa, rng.next2D());
      ASSERT_NEAR(length(w), 1, 1e-5f);
      const Vec3f d = w - kAxis, local = frame.toLocal(w);
      const double t = 0.5 * static_cast<double>(dot(d, d));
      mean += t, square += t * t;
      // The cumulative of t = 1 - cos is (1 - e^(-k t))/(1 - e^(-2 k)).
      const double u = std::expm1(-k * t) / std::expm1(-2 * k);
      const double phi = std::atan2(static_cast<double>(local.y), static_cast<double>(local.x));
      const auto row = std::min<size_t>(kCells - 1, static_cast<size_t>(u * kCells));
      const auto column = std::min<size_t>(7, static_cast<size_t>((phi / (2 * kPiD) + 0.5) * 8));
      counts[row * 8 + column] += 1;
    }
    mean /= kCount;
    const double error = std::sqrt((square / kCount - mean * mean) / kCount);
    const double exact = kappa > 0 ? 1 - (1 / std::tanh(k) - 1 / k) : 1;
    EXPECT_NEAR(mean, kappa < 0.01f ? 1 : exact, 4 * error) << kappa;
    if (kappa < 1e5f) {  // beyond, a float direction cannot resolve the cells
      EXPECT_GT(test::chiSquaredPValue(counts, expected), 1e-3) << kappa;
    }
  }
}

TEST(Moment, MergingALobeWithItselfChangesNothing) {
  for (float kappa : {0.05f, 1.f, 30.f, 3000.f}) {
    Moment m = momentOf(kAxis, kappa, 2);
    m.add(momentOf(kAxis, kappa, 3));
    const SphericalGaussian g = lobeOf(m);
    EXPECT_NEAR(g.sharpness / kappa, 1, 2e-5f + 2e-7f * kappa);
    EXPECT_NEAR(length(g.axis - kAxis), 0, 1e-6f);
    EXPECT_NEAR(g.amplitude * integral(g.sharpness), 5, 1e-5f);
  }
}

TEST(Moment, MergingIsAssociative) {
  Rng rng(2);
  std::vector<Moment> moments;
  for (int i = 0; i < 64; ++i) {
    moments.push_back(momentOf(tilted(kAxis, 20 * rng.next1D()), 100 * rng.next1D(), rng.next1D()));
  }
  Moment forward, halves[2];
  for (size_t i = 0; i < 64; ++i) forward.add(moments[i]), halves[i % 2].add(moments[i]);
  halves[0].add(halves[1]);
  const SphericalGaussian a = lobeOf(forward), b = lobeOf(halves[0]);
  EXPECT_NEAR(a.sharpness / b.sharpness, 1, 1e-4f);
  EXPECT_NEAR(length(a.axis - b.axis), 0, 1e-5f);
}

// methods.md 0.3: two lobes of kappa 50, 5 degrees apart, merge to 48; kappa 100, 10 degrees: 73.
TEST(Moment, MergedWidthsAreThoseOfTheSum) {
  const auto merged = [](float kappa, float degrees) {
    Moment m = momentOf(kAxis, kappa, 1);
    m.add(momentOf(tilted(kAxis, degrees), kappa, 1));
    return lobeOf(m).sharpness;
  };
  EXPECT_NEAR(merged(50, 5), 47.8f, 0.3f);
  EXPECT_NEAR(merged(100, 10), 72.6f, 0.3f);
}

TEST(Moment, EmptyAndOpposedMomentsAreHarmless) {
  EXPECT_EQ(lobeOf(Moment{}).amplitude, 0.f);
  Moment m = momentOf(kAxis, 10, 1);
  m.add(momentOf(-kAxis, 10, 1));
  const SphericalGaussian g = lobeOf(m);
  EXPECT_NEAR(g.sharpness, 0, 1e-5f);
  EXPECT_NEAR(g.amplitude * integral(g.sharpness), 2, 1e-5f);
  EXPECT_EQ(lobeOf(Moment{1, kAxis}).sharpness, 1e7f);
}

}  // namespace
}  // namespace lobelia::lobes
