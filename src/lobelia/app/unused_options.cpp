#include "lobelia/app/unused_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>

#include "lobelia/app/light_sets.h"
#include "lobelia/app/render_frame.h"
#include "lobelia/base/error.h"

namespace lobelia::app {
namespace {

bool isGiven(const RenderOptions& options, const std::string& name) {
  return std::find(options.given.begin(), options.given.end(), name) != options.given.end();
}

bool writes(const RenderOptions& options, const char* extension) {
  return std::any_of(options.outputs.begin(), options.outputs.end(), [&](const std::string& file) {
    return std::filesystem::path(file).extension() == extension;
  });
}

// Options of virtual lights alone; --save-lights and --load-lights are errors without them.
constexpr const char* kOfVirtualLights[] = {
    "--gather", "--num-lights", "--passes", "--env-lights", "--direct", "--clamp", "--near-lights"};

}  // namespace

std::vector<std::string> givenOptions(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    if (option->count() > 0 && !option->get_lnames().empty())
      names.push_back("--" + option->get_lnames().front());
  return names;
}

std::vector<std::string> unusedOptions(const RenderOptions& options) {
  std::vector<std::string> unused;
  const auto report = [&](const std::string& name, bool without, const std::string& why) {
    if (without && isGiven(options, name))
      unused.push_back(fmt::format("{} has no effect: {}", name, why));
  };
  const bool virtualLights = usesVirtualLights(options);
  report("--memory",
         options.gather != "mrcs" && options.gather != "lightslice" && options.lights != "richvpl",
         "only --gather mrcs and lightslice and --lights richvpl keep more where there is room");
  for (const char* name : kOfVirtualLights)
    report(name, !virtualLights, fmt::format("--lights {} has no virtual lights", options.lights));
  if (virtualLights) {
    report("--env-lights", options.direct != "lights",
           "environments become lights with --direct lights only");
    const bool loads = !options.loadLights.empty();
    report("--num-lights", options.lights == "vsgl" && options.vsglClusters == "pairs",
           "--vsgl-clusters pairs has two lights for each view and for what goes on from there");
    report("--num-lights", loads, "--load-lights brings the lights that it holds");
    for (const char* name :
         {"--vsgl-clusters", "--vsgl-points", "--vsgl-views", "--vsgl-overlap", "--vsgl-merging"})
      report(name, loads, "--load-lights brings the lights that it holds");
    report("--env-lights", loads && options.direct == "lights",
           "--load-lights brings the lights that it holds");
    if (const int samples = virtualLightSamples(options); options.passes > samples) {
      unused.push_back(
          fmt::format("--passes {}: there are {} samples per pixel, and as many sets of lights "
                      "suffice them; more sets need more --spp",
                      options.passes, samples));
    }
  }
  for (const char* name :
       {"--radius", "--vsl-indicator", "--vsl-sampling", "--vsl-samples", "--near-field"})
    report(name, options.lights != "vsl", "only --lights vsl has spherical lights");
  for (const char* name :
       {"--richvpl-lights", "--richvpl-radiance", "--richvpl-texels", "--richvpl-lobes"})
    report(name, options.lights != "richvpl", "only --lights richvpl has Rich-VPLs");
  for (const char* name :
       {"--vsgl-clusters", "--vsgl-points", "--vsgl-views", "--vsgl-overlap", "--vsgl-shading",
        "--vsgl-variance", "--vsgl-spread", "--vsgl-merging", "--vsgl-shadows", "--vsgl-map-size"})
    report(name, options.lights != "vsgl", "only --lights vsgl has spherical Gaussian lights");
  report("--clamp", (options.lights == "vsl" || options.lights == "vsgl") && options.clamp != "off",
         "spherical and spherical Gaussian lights have no spikes to clamp");
  for (const char* name : {"--photons-nearest", "--photon-radius", "--gather-rays"})
    report(name, options.lights != "photon", "only --lights photon has photons");
  report("--gather", options.lights == "photon", "photons are gathered by rays of the receivers");
  report("--pixels-seed", options.pixels == 0, "all pixels are computed without --pixels");
  report("--checkpoint-interval", options.checkpoint.empty() && options.resume.empty(),
         "neither --checkpoint nor --resume names a file");
  for (const char* name :
       {"--output", "--stats", "--aov", "--exposure", "--display", "--checkpoint", "--resume",
        "--save-lights", "--export-trees", "--time-limit"})
    report(name, !options.replay.empty(), "--replay shows one pixel and writes nothing");
  if (options.replay.empty())
    report("--exposure", !writes(options, ".png"), "no .png is written, and .exr stays linear");
  return unused;
}

void requireUsedResults(const RenderOptions& options) {
  if (options.aovs.empty() || !options.replay.empty() || writes(options, ".exr")) return;
  throw UsageError(
      fmt::format("--aov {}: layers are written to .exr only; add an output such as -o picture.exr",
                  options.aovs));
}

}  // namespace lobelia::app
