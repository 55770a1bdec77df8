#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "lobelia/app/commands.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/film/metrics.h"
#include "lobelia/io/image_io.h"

namespace lobelia::app {
namespace {

// JSON has no infinity: null then.
nlohmann::ordered_json number(double v) {
  return std::isfinite(v) ? nlohmann::ordered_json(v) : nlohmann::ordered_json();
}

std::optional<Film> readOptional(const std::string& file) {
  if (file.empty()) return {};
  return io::readFilm(file);
}

}  // namespace

ExitCode compareImages(const CompareOptions& options) {
  if (!options.diff.empty()) {
    if (std::filesystem::path(options.diff).extension() != ".png") {
      throw UsageError(fmt::format("--diff {}: the picture is written as .png", options.diff));
    }
    requireWritable(options.diff);
  }
  const Film image = io::readFilm(options.image), reference = io::readFilm(options.reference);
  const std::optional<Film> reference2 = readOptional(options.reference2),
                            mask = readOptional(options.mask);
  const Comparison r =
      compare(image, reference, reference2 ? &*reference2 : nullptr, mask ? &*mask : nullptr);
  if (!options.diff.empty()) {
    io::writePng(options.diff, differencePicture(image, reference), image.width, image.height);
  }
  if (options.json) {
    nlohmann::ordered_json json{{"rmse", number(r.rmse)},
                                {"relmse", number(r.relmse)},
                                {"l2", number(r.l2)},
                                {"mae", number(r.mae)},
                                {"flip", r.flip ? number(*r.flip) : nlohmann::ordered_json()},
                                {"mean_ratio", number(r.meanRatio)},
                                {"nonfinite", r.nonfinite},
                                {"pixels", r.pixels}};
    fmt::print("{}\n", json.dump());
  } else {
    fmt::print("rmse       {:.6g}\nrelmse     {:.6g}\nl2         {:.6g}\nmae        {:.6g}\n",
               r.rmse, r.relmse, r.l2, r.mae);
    fmt::print("flip       {}\n", r.flip ? fmt::format("{:.6g}", *r.flip) : "(needs whole images)");
    fmt::print("mean_ratio {:.6g}\nnonfinite  {}\npixels     {}\n", r.meanRatio, r.nonfinite,
               r.pixels);
  }
  return ExitCode::done;
}

}  // namespace lobelia::app
