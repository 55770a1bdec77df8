#include "lobelia/io/merl_reader.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "lobelia/io/file_bytes.h"

namespace lobelia::io {
namespace {

constexpr size_t kHeader = 3 * sizeof(int32_t);
constexpr size_t kBytes = kHeader + 3 * TabulatedBrdf::kSize * sizeof(double);
constexpr double kScales[3] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
constexpr int32_t kDimensions[3] = {TabulatedBrdf::kThetaH, TabulatedBrdf::kThetaD,
                                    TabulatedBrdf::kPhiD};

}  // namespace

TabulatedBrdf readMerl(const std::string& file, const Location& from) {
  std::error_code ignored;
  const auto size = std::filesystem::file_size(file, ignored);
  if (!ignored && std::filesystem::is_regular_file(file, ignored) && size != kBytes) {
    throw InputError({file},
                     fmt::format("not a MERL table: it has {} bytes; 90 x 90 x 180 values for each "
                                 "of three colours make {}",
                                 size, kBytes));
  }
  const std::string bytes = readFileBytes(file, "MERL table", from);
  int32_t dimensions[3] = {};
  if (bytes.size() == kBytes) std::memcpy(dimensions, bytes.data(), kHeader);
  if (std::memcmp(dimensions, kDimensions, kHeader) != 0) {
    throw InputError({file},
                     fmt::format("not a MERL table: its dimensions are {} x {} x {}; they must be "
                                 "90 x 90 x 180",
                                 dimensions[0], dimensions[1], dimensions[2]));
  }
  TabulatedBrdf table;
  for (size_t i = 0; i < TabulatedBrdf::kSize; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      double value = 0;
      std::memcpy(&value, bytes.data() + kHeader + (c * TabulatedBrdf::kSize + i) * sizeof(double),
                  sizeof(double));
      const float scaled = static_cast<float>(value * kScales[c]);
      table.values[i][static_cast<int>(c)] = std::isfinite(scaled) ? scaled : -1.f;
    }
  }
  countInvalid(table);
  if (table.invalidCount == table.aboveCount) {
    throw InputError({file}, "the MERL table holds no measured value; all are negative");
  }
  return table;
}

void writeMerl(const std::string& file, const TabulatedBrdf& table) {
  std::string bytes(kBytes, '\0');
  std::memcpy(bytes.data(), kDimensions, kHeader);
  for (size_t i = 0; i < TabulatedBrdf::kSize; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const double value = static_cast<double>(table.values[i][static_cast<int>(c)]) / kScales[c];
      std::memcpy(bytes.data() + kHeader + (c * TabulatedBrdf::kSize + i) * sizeof(double), &value,
                  sizeof(double));
    }
  }
  writeFileAtomically(file, bytes);
}

std::string describeFit(const TabulatedBrdf& table, const CapturedFit& fit) {
  return fmt::format(
      "{} lobes, index of refraction {:.3g}, error {:.2f} % of the cube roots, energy within "
      "{:.2f} "
      "%; {} of {} values were not measured",
      fit.lobes.size(), fit.ior, 100 * fit.error, 100 * fit.energyError, table.invalidCount,
      table.aboveCount);
}

std::string doubtsAbout(const TabulatedBrdf& table, const CapturedFit& fit) {
  // A tenth of a cube root is a third of the reflectance: differences that one sees side by side.
  constexpr double kMostError = 0.1, kMostEnergyError = 0.05;
  if (fit.error > kMostError) {
    return fmt::format(
        "the fit is poor: off by {:.1f} % of the cube roots of the reflected light (good fits are "
        "below 5 %); more --lobes may help, but not for light that returns whence it came",
        100 * fit.error);
  }
  if (fit.energyError > kMostEnergyError)
    return fmt::format("the fit's energy is off by {:.1f} %", 100 * fit.energyError);
  if (2 * table.invalidCount > table.aboveCount)
    return fmt::format("{} of the table's {} values were not measured; the fit guesses there",
                       table.invalidCount, table.aboveCount);
  return "";
}

Material materialOf(const CapturedFit& fit) {
  Material m;
  m.type = MaterialType::sphericalGaussians;
  m.diffuse = fit.diffuse;
  m.ior = fit.ior;
  for (const FittedLobe& lobe : fit.lobes)
    m.capturedLobes.push_back({ColorParam(lobe.amplitude), FloatParam(lobe.sharpness)});
  return m;
}

}  // namespace lobelia::io
