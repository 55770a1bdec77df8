#include "lobelia/app/replay.h"

#include <algorithm>
#include <charconv>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/replay_lights.h"
#include "lobelia/app/replay_path.h"
#include "lobelia/app/replay_text.h"

namespace lobelia::app {
namespace {

struct Place {
  int x = 0, y = 0;
};

Place parsePlace(const std::string& text) {
  Place at;
  const char* end = text.data() + text.size();
  const auto [comma, first] = std::from_chars(text.data(), end, at.x);
  if (first == std::errc() && comma != end && *comma == ',') {
    const auto [last, second] = std::from_chars(comma + 1, end, at.y);
    if (second == std::errc() && last == end) return at;
  }
  throw UsageError(fmt::format("--replay '{}' is not of the form X,Y, as in --replay 12,34", text));
}

uint32_t pixelOf(const Place& at, const Film& film, const PixelSet& set, const std::string& text) {
  const int x = at.x - film.x0, y = at.y - film.y0;
  if (x < 0 || y < 0 || x >= film.width || y >= film.height) {
    throw UsageError(fmt::format("--replay {}: the picture has x from {} to {}, y from {} to {}",
                                 text, film.x0, film.x0 + film.width - 1, film.y0,
                                 film.y0 + film.height - 1));
  }
  const uint32_t pixel =
      static_cast<uint32_t>(y) * static_cast<uint32_t>(film.width) + static_cast<uint32_t>(x);
  if (!set.pixels.empty() && !std::binary_search(set.pixels.begin(), set.pixels.end(), pixel)) {
    throw UsageError(fmt::format("--replay {}: not among the pixels of --pixels", text));
  }
  return pixel;
}

}  // namespace

void requireReplay(const RenderOptions& options) {
  if (options.replay.empty()) return;
  parsePlace(options.replay);
  if (options.lights == "light") {
    throw UsageError(
        "--replay: particles of --lights light belong to no pixel; it works with path and virtual "
        "lights");
  }
}

void replay(const Frame& frame, FrameRun& run, bool all, Context& context) {
  RenderOptions options = frame.options;
  options.aovs.clear();
  if (!options.saveLights.empty()) options.passes = 1;  // as lightSetCount() has it
  options.saveLights.clear();
  options.timeLimit = 0;
  Film film = makeFilm(frame.camera, options);
  const PixelSet pixels = choosePixels(frame.camera, options);
  const uint32_t pixel = pixelOf(parsePlace(options.replay), film, pixels, options.replay);
  const int maxDepth = options.maxDepth > 0 ? options.maxDepth : run.scene.maxDepth;
  fmt::print("pixel {} of {}, --lights {}\n", options.replay, run.scene.name, options.lights);
  int samples = 0;
  if (usesVirtualLights(options)) {
    samples = replayVirtualLights({frame.number, frame.camera, options}, run, pixel, maxDepth, all,
                                  film, context);
  } else {
    PathTrace trace(run.scene, all);
    PathSettings settings =
        pathSettings(run.scene, frame.camera, PixelSet{{pixel}}, maxDepth, options);
    settings.observer = &trace;
    samples = settings.spp;
    renderPath(run.tracer, run.emitters, frame.camera, settings, film, context);
  }
  if (!all && samples > kReplaySamples) {
    fmt::print("({} samples more; --verbose prints all)\n", samples - kReplaySamples);
  }
  printPixel(film, pixel, samples);
  composePicture(film, options);
  fmt::print("pixel {}: {}\n", options.replay, text(film.rgb(pixel)));
}

}  // namespace lobelia::app
