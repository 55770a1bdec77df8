// `lobelia fit`: captured reflectance from a table of measurements.
#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "lobelia/app/commands.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/io/file_bytes.h"
#include "lobelia/io/merl_reader.h"

namespace lobelia::app {
namespace {

nlohmann::ordered_json rgb(Rgb c) { return {c.x, c.y, c.z}; }

nlohmann::ordered_json describe(const TabulatedBrdf& table, const CapturedFit& fit) {
  nlohmann::ordered_json lobes = nlohmann::ordered_json::array();
  for (const FittedLobe& lobe : fit.lobes)
    lobes.push_back({{"amplitude", rgb(lobe.amplitude)}, {"sharpness", lobe.sharpness}});
  return {{"diffuse", rgb(fit.diffuse)},
          {"ior", fit.ior},
          {"lobes", std::move(lobes)},
          {"error", fit.error},
          {"energy_error", fit.energyError},
          {"entries_compared", fit.samples},
          {"entries_measured", table.aboveCount - table.invalidCount},
          {"entries_invalid", table.invalidCount}};
}

}  // namespace

ExitCode fit(const FitOptions& options, const GlobalOptions& global) {
  const std::filesystem::path output = options.output;
  const std::string extension = output.extension().string();
  if (!options.output.empty()) {
    if (extension != ".xml" && extension != ".json") {
      throw UsageError(
          fmt::format("-o {}: the material is written as .xml or .json", options.output));
    }
    requireWritable(options.output);
  }
  const auto start = std::chrono::steady_clock::now();
  const TabulatedBrdf table = io::readMerl(options.table);
  const CapturedFit fit = fitCaptured(table, options.lobes);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  Console console(global.verbosity());
  if (const std::string doubts = io::doubtsAbout(table, fit); !doubts.empty())
    Context(&console).warning(doubts);
  nlohmann::ordered_json json = describe(table, fit);
  if (extension == ".xml") io::writeFit(options.output, fit, output.stem().string());
  if (extension == ".json") io::writeFileAtomically(options.output, json.dump(2) + "\n");
  if (options.json) {
    json["seconds"] = seconds;
    fmt::print("{}\n", json.dump());
    return ExitCode::done;
  }
  fmt::print("{}\n", io::describeFit(table, fit));
  fmt::print("diffuse    {:.4f} {:.4f} {:.4f}\n", fit.diffuse.x, fit.diffuse.y, fit.diffuse.z);
  for (const FittedLobe& lobe : fit.lobes) {
    fmt::print("sharpness  {:<8.5g} amplitude {:.4g} {:.4g} {:.4g}\n", lobe.sharpness,
               lobe.amplitude.x, lobe.amplitude.y, lobe.amplitude.z);
  }
  return ExitCode::done;
}

}  // namespace lobelia::app
