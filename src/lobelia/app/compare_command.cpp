#include <fmt/format.h>

#include <algorithm>
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

struct Window {
  int x0, y0, x1, y1;
};

Film cut(const Film& film, const Window& window) {
  Film out;
  out.fullWidth = film.fullWidth, out.fullHeight = film.fullHeight;
  out.x0 = window.x0, out.y0 = window.y0;
  out.width = window.x1 - window.x0, out.height = window.y1 - window.y0;
  const auto copyRows = [&](const std::vector<float>& from, std::vector<float>& to, int channels) {
    const ptrdiff_t row = ptrdiff_t{out.width} * channels;
    for (int y = window.y0; y < window.y1; ++y) {
      const ptrdiff_t pixel = ptrdiff_t{y - film.y0} * film.width + (window.x0 - film.x0);
      const auto begin = from.begin() + pixel * channels;
      to.insert(to.end(), begin, begin + row);
    }
  };
  const Layer& picture = film.layers.at("");
  Layer& layer = out.layers[""];
  layer.channels = picture.channels;
  copyRows(picture.values, layer.values, picture.channels);
  if (!film.alpha.empty()) copyRows(film.alpha, out.alpha, 1);
  return out;
}

// Crops of one picture meet in the pixels that all of them have. Pictures of different sizes are
// left for compare() to refuse.
void cutToCommonWindow(const std::vector<Film*>& films) {
  const Film& first = *films.front();
  Window common{first.x0, first.y0, first.x0 + first.width, first.y0 + first.height};
  bool same = true;
  for (const Film* film : films) {
    if (film->fullWidth != first.fullWidth || film->fullHeight != first.fullHeight) return;
    same &= film->x0 == first.x0 && film->y0 == first.y0 && film->width == first.width &&
            film->height == first.height;
    common = {std::max(common.x0, film->x0), std::max(common.y0, film->y0),
              std::min(common.x1, film->x0 + film->width),
              std::min(common.y1, film->y0 + film->height)};
  }
  if (same || common.x0 >= common.x1 || common.y0 >= common.y1) return;
  for (Film* film : films) *film = cut(*film, common);
}

// Tone mapping is not undone: its pictures have another light than those of linear light.
void warnOfMixture(const Film& image, const std::string& file, const Film& reference,
                   const std::string& referenceFile, Context& context) {
  if (image.forDisplay == reference.forDisplay) return;
  const auto& [shown, linear] =
      image.forDisplay ? std::pair{file, referenceFile} : std::pair{referenceFile, file};
  context.warning(
      fmt::format("{} is a picture for display (tone-mapped, white at most) and {} holds linear "
                  "light: they are not comparable value by value; compare two of one kind",
                  shown, linear));
}

}  // namespace

ExitCode compareImages(const CompareOptions& options, const GlobalOptions& global) {
  if (!options.diff.empty()) {
    if (std::filesystem::path(options.diff).extension() != ".png") {
      throw UsageError(fmt::format("--diff {}: the picture is written as .png", options.diff));
    }
    requireWritable(options.diff);
  }
  Film image = io::readFilm(options.image), reference = io::readFilm(options.reference);
  std::optional<Film> reference2 = readOptional(options.reference2),
                      mask = readOptional(options.mask);
  Console console(global.verbosity());
  Context context(&console);
  warnOfMixture(image, options.image, reference, options.reference, context);
  if (reference2) warnOfMixture(image, options.image, *reference2, options.reference2, context);
  std::vector<Film*> films{&image, &reference};
  for (std::optional<Film>* film : {&reference2, &mask})
    if (*film) films.push_back(&**film);
  cutToCommonWindow(films);
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
