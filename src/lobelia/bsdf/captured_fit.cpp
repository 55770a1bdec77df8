// The error is that of cube roots of f sqrt(cos_o cos_i), a compressive metric as for measured
// reflectance in [Low12], over the table's own grid (even in the square root
// of theta_h, which weighs highlight and tails alike), up to 80 degrees from the normal: beyond,
// measurements are mostly noise. Amplitudes are linear: for given sharpnesses they are the
// nonnegative least squares of f itself, each entry weighted by
//   (a^(1/3) - b^(1/3)) / (a - b) = 1 / (a^(2/3) + (a b)^(1/3) + b^(2/3)),
// a the table's value and b the fit's of the round before, so that rounds converge to cube roots.
// Sharpnesses enter one at a time, each the best of a ladder, then all are improved by pattern
// search; this for several indices of refraction, the best of which is searched likewise.
// In the end the lobes are scaled so that each channel has the table's energy over all pairs of
// directions, dw_o dw_i = 4 cos(theta_d) dw_h dw_d [Rusinkiewicz98].
#include "lobelia/bsdf/captured_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/bsdf/captured.h"
#include "lobelia/bsdf/nonnegative_least_squares.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

constexpr int kLadder = 22;
constexpr float kLeastSharpness = 1, kGreatestSharpness = 5e4f;
constexpr std::array<float, 5> kIndices{1.f, 1.3f, 1.5f, 1.8f, 2.5f};
constexpr float kGreatestIndex = 4;
constexpr int kRounds = 3;  // of weights
// Of lobes that reflect more than they receive, which scaling down would make too dark: a higher
// index of refraction often does as well.
constexpr double kPenalty = 100;

struct Sample {
  Vec3f wo, wi;
  float root;  // sqrt(cos_o / cos_i): kernels have f cos_i
};
using Column = std::vector<float>;

struct Data {
  std::vector<Sample> samples;
  std::array<Column, 3> values;    // f sqrt(cos cos)
  std::vector<double> measures;    // of dw_o dw_i, times sqrt(cos cos)
  std::array<double, 3> floors{};  // values near zero count as this much
};

// Every so many entries of theta_d and phi_d, where both cosines are above the least.
struct Grid {
  int thetaDStep, phiDStep;
  float leastCosine;
};
constexpr Grid kCompared{6, 15, 0.17364818f};  // 80 degrees
constexpr Grid kIntegrated{2, 6, 0};

Data collect(const TabulatedBrdf& table, const Grid& grid) {
  Data data;
  for (int h = 0; h < TabulatedBrdf::kThetaH; ++h) {
    for (int d = grid.thetaDStep / 2; d < TabulatedBrdf::kThetaD; d += grid.thetaDStep) {
      for (int p = grid.phiDStep / 2; p < TabulatedBrdf::kPhiD; p += grid.phiDStep) {
        const Rgb value = table.values[TabulatedBrdf::index(h, d, p)];
        const HalfDifference angles = TabulatedBrdf::centre(h, d, p);
        const DirectionPair pair = toDirections(angles);
        if (!isMeasured(value) || !(pair.wo.z > grid.leastCosine && pair.wi.z > grid.leastCosine))
          continue;
        const float root = std::sqrt(pair.wo.z * pair.wi.z);
        data.samples.push_back({pair.wo, pair.wi, std::sqrt(pair.wo.z / pair.wi.z)});
        for (size_t c = 0; c < 3; ++c) data.values[c].push_back(value[static_cast<int>(c)] * root);
        // d(theta_h) of an even step in its square root is as its square root.
        data.measures.push_back(
            static_cast<double>(root * std::sin(angles.thetaH) * std::sqrt(angles.thetaH) *
                                std::sin(angles.thetaD) * std::cos(angles.thetaD)));
      }
    }
  }
  for (size_t c = 0; c < 3; ++c) {
    double sum = 0;
    for (const float v : data.values[c]) sum += std::cbrt(static_cast<double>(v));
    const double mean = sum / static_cast<double>(std::max<size_t>(data.samples.size(), 1));
    data.floors[c] = std::max(1e-2 * mean * mean * mean, 1e-9);
  }
  return data;
}

Column columnOf(const Data& data, const Lobe& lobe) {
  Column column(data.samples.size());
  for (size_t i = 0; i < column.size(); ++i) {
    const Sample& s = data.samples[i];
    column[i] = evaluateLobe(lobe, s.wo, s.wi).x * s.root;
  }
  return column;
}
Column diffuseColumn(const Data& data, float ior) {
  return columnOf(data, capturedDiffuse(Rgb(1.f), ior));
}
Column lobeColumn(const Data& data, float logSharpness, float ior) {
  const float sharpness = std::exp(logSharpness);
  // Of unit reflectance, so that amplitudes of sharp and wide lobes are of one size.
  return columnOf(data, capturedLobe(Rgb(1 / projectedIntegral(sharpness)), sharpness, ior));
}

// A fit in the making: column 0 is the diffuse part.
struct Model {
  float ior = 1;
  std::vector<float> logSharpness;
  std::vector<Column> columns;
  std::array<Vector8, 3> amplitudes{};
  double error = 0;
};

using Weights = std::array<Column, 3>;

Weights weightsOf(const Data& data, const Model* fit) {
  Weights weights;
  for (size_t c = 0; c < 3; ++c) {
    weights[c].resize(data.samples.size());
    for (size_t i = 0; i < data.samples.size(); ++i) {
      const double a = static_cast<double>(data.values[c][i]);
      double b = a;
      if (fit) {
        b = 0;
        for (size_t k = 0; k < fit->columns.size(); ++k)
          b += fit->amplitudes[c][k] * static_cast<double>(fit->columns[k][i]);
      }
      const double ra = std::cbrt(a + data.floors[c]), rb = std::cbrt(b + data.floors[c]);
      weights[c][i] = static_cast<float>(1 / (ra * ra + ra * rb + rb * rb));
    }
  }
  return weights;
}

// Amplitudes for the model's columns and the error that is left.
void solve(const Data& data, const Weights& weights, Model& model) {
  const size_t n = model.columns.size(), count = data.samples.size();
  model.error = 0;
  double excess = 0;
  for (size_t c = 0; c < 3; ++c) {
    Matrix8 gram{};
    Vector8 projection{};
    double own = 0;
    for (size_t i = 0; i < count; ++i) {
      const double root = static_cast<double>(weights[c][i]), w = root * root;
      const double y = static_cast<double>(data.values[c][i]);
      own += w * y * y;
      for (size_t k = 0; k < n; ++k) {
        const double v = w * static_cast<double>(model.columns[k][i]);
        projection[k] += v * y;
        for (size_t j = 0; j <= k; ++j) gram[k][j] += v * static_cast<double>(model.columns[j][i]);
      }
    }
    for (size_t k = 0; k < n; ++k)
      for (size_t j = k + 1; j < n; ++j) gram[k][j] = gram[j][k];
    const Vector8 x = solveNonnegative(gram, projection, static_cast<int>(n));
    double left = own;
    for (size_t k = 0; k < n; ++k) {
      left -= 2 * x[k] * projection[k];
      for (size_t j = 0; j < n; ++j) left += x[k] * gram[k][j] * x[j];
    }
    model.error += left;
    model.amplitudes[c] = x;
    // Columns are of unit reflectance: see capturedScale().
    double weight = model.ior > 1 ? 0 : x[0];
    for (size_t k = 1; k < n; ++k) weight += x[k];
    excess = std::max(excess, weight - 1);
  }
  model.error *= 1 + kPenalty * excess;
}

Model grow(const Data& data, const Weights& weights, float ior, int lobeCount) {
  const float low = std::log(kLeastSharpness), high = std::log(kGreatestSharpness);
  std::vector<Column> ladder;
  const auto rung = [&](int i) {
    return low + (high - low) * static_cast<float>(i) / (kLadder - 1);
  };
  for (int i = 0; i < kLadder; ++i) ladder.push_back(lobeColumn(data, rung(i), ior));
  Model model;
  model.ior = ior;
  model.columns.push_back(diffuseColumn(data, ior));
  for (int k = 0; k < lobeCount; ++k) {
    int best = 0;
    double least = 1e300;
    model.columns.emplace_back();
    for (int i = 0; i < kLadder; ++i) {
      model.columns.back() = ladder[static_cast<size_t>(i)];
      solve(data, weights, model);
      if (model.error < least) best = i, least = model.error;
    }
    model.columns.back() = ladder[static_cast<size_t>(best)];
    model.logSharpness.push_back(rung(best));
  }
  solve(data, weights, model);
  return model;
}

void setIndex(const Data& data, float ior, Model& model) {
  model.ior = ior;
  model.columns[0] = diffuseColumn(data, ior);
  for (size_t k = 0; k < model.logSharpness.size(); ++k)
    model.columns[k + 1] = lobeColumn(data, model.logSharpness[k], ior);
}

// Pattern search: steps up and down each sharpness (and the index of refraction), halved when none
// helps.
void refine(const Data& data, const Weights& weights, float step, float lastStep, bool withIndex,
            Model& model) {
  solve(data, weights, model);
  for (; step > lastStep; step *= 0.5f) {
    bool improved = true;
    for (int sweep = 0; improved && sweep < 6; ++sweep) {
      improved = false;
      for (size_t k = 0; k < model.logSharpness.size(); ++k) {
        for (const float sign : {1.f, -1.f}) {
          Model trial = model;
          trial.logSharpness[k] =
              std::clamp(model.logSharpness[k] + sign * step, std::log(kMinCapturedSharpness),
                         std::log(2 * kGreatestSharpness));
          trial.columns[k + 1] = lobeColumn(data, trial.logSharpness[k], trial.ior);
          solve(data, weights, trial);
          if (trial.error < model.error) model = std::move(trial), improved = true;
        }
      }
      for (const float sign : {1.f, -1.f}) {
        if (!withIndex || model.ior <= 1) break;
        Model trial = model;
        setIndex(data,
                 std::clamp(1 + (model.ior - 1) * std::exp(sign * step), 1.05f, kGreatestIndex),
                 trial);
        solve(data, weights, trial);
        if (trial.error < model.error) model = std::move(trial), improved = true;
      }
    }
  }
}

// Of cube roots, relative.
double relativeError(const Data& data, const Model& model) {
  double difference = 0, total = 0;
  for (size_t c = 0; c < 3; ++c) {
    for (size_t i = 0; i < data.samples.size(); ++i) {
      double b = 0;
      for (size_t k = 0; k < model.columns.size(); ++k)
        b += model.amplitudes[c][k] * static_cast<double>(model.columns[k][i]);
      const double ra = std::cbrt(static_cast<double>(data.values[c][i])), rb = std::cbrt(b);
      difference += (ra - rb) * (ra - rb), total += ra * ra;
    }
  }
  return total > 0 ? std::sqrt(difference / total) : 0;
}

// Scales the lobes to the table's energy, as far as they may reflect it; returns the largest
// relative difference that is left.
double matchEnergy(const TabulatedBrdf& table, CapturedFit& fit) {
  const Data data = collect(table, kIntegrated);
  std::array<double, 3> wanted{}, diffuse{}, glossy{};
  const auto total = [&](const Column& column) {
    double sum = 0;
    for (size_t i = 0; i < column.size(); ++i)
      sum += static_cast<double>(column[i]) * data.measures[i];
    return sum;
  };
  const double base = total(diffuseColumn(data, fit.ior));
  std::vector<double> lobes(fit.lobes.size());
  parallelFor(lobes.size(), 1, [&](size_t k) {
    lobes[k] = total(columnOf(data, capturedLobe(Rgb(1.f), fit.lobes[k].sharpness, fit.ior)));
  });
  double worst = 0;
  for (size_t c = 0; c < 3; ++c) {
    const int channel = static_cast<int>(c);
    wanted[c] = total(data.values[c]);
    diffuse[c] = base * static_cast<double>(fit.diffuse[channel]);
    for (size_t k = 0; k < lobes.size(); ++k)
      glossy[c] += lobes[k] * static_cast<double>(fit.lobes[k].amplitude[channel]);
    double scale = 1;
    if (glossy[c] > 0.01 * wanted[c])
      scale = std::clamp((wanted[c] - diffuse[c]) / glossy[c], 0.5, 2.0);
    for (FittedLobe& lobe : fit.lobes) lobe.amplitude[channel] *= static_cast<float>(scale);
    glossy[c] *= scale;
  }
  Rgb weights{};
  for (const FittedLobe& lobe : fit.lobes)
    weights += lobe.amplitude * projectedIntegral(lobe.sharpness);
  const float bound = capturedScale(fit.diffuse, weights, fit.ior);
  fit.diffuse *= bound;
  for (FittedLobe& lobe : fit.lobes) lobe.amplitude *= bound;
  for (size_t c = 0; c < 3; ++c) {
    if (!(wanted[c] > 0)) continue;
    const double energy = (diffuse[c] + glossy[c]) * static_cast<double>(bound);
    worst = std::max(worst, std::abs(energy / wanted[c] - 1));
  }
  return worst;
}

}  // namespace

CapturedFit fitCaptured(const TabulatedBrdf& table, int lobeCount) {
  lobeCount = std::clamp(lobeCount, 1, kMaxFittedLobes);
  const Data data = collect(table, kCompared);
  const Weights first = weightsOf(data, nullptr);
  std::array<Model, kIndices.size()> models;
  parallelFor(models.size(), 1, [&](size_t i) {
    models[i] = grow(data, first, kIndices[i], lobeCount);
    refine(data, first, 0.3f, 0.05f, false, models[i]);
  });
  Model best = models[0];
  for (const Model& model : models)
    if (model.error < best.error) best = model;
  for (int round = 0; round < kRounds; ++round) {
    const Weights weights = weightsOf(data, &best);
    refine(data, weights, 0.1f, round + 1 < kRounds ? 0.02f : 0.002f, true, best);
  }
  CapturedFit fit;
  fit.ior = best.ior;
  fit.samples = data.samples.size();
  fit.error = relativeError(data, best);
  const auto color = [&](size_t k) {
    return Rgb(static_cast<float>(best.amplitudes[0][k]), static_cast<float>(best.amplitudes[1][k]),
               static_cast<float>(best.amplitudes[2][k]));
  };
  fit.diffuse = color(0);
  for (size_t k = 0; k < best.logSharpness.size(); ++k) {
    const float sharpness = std::exp(best.logSharpness[k]);
    const Rgb amplitude = color(k + 1) / projectedIntegral(sharpness);
    if (maxComponent(amplitude) > 0) fit.lobes.push_back({amplitude, sharpness});
  }
  std::sort(fit.lobes.begin(), fit.lobes.end(),
            [](const FittedLobe& a, const FittedLobe& b) { return a.sharpness > b.sharpness; });
  fit.energyError = matchEnergy(table, fit);
  return fit;
}

}  // namespace lobelia
