#include "lobelia/app/render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

namespace lobelia::app {
namespace {

// CLI::Range lets NaN through and prints limits such as 1e308 in full.
CLI::Validator finiteNumber(double least, double most = HUGE_VAL, bool leastIncluded = true) {
  const std::string range =
      std::isinf(least) && std::isinf(most)
          ? std::string("a finite number")
          : fmt::format("a finite number {} {}{}", leastIncluded ? "from" : "above", least,
                        std::isinf(most) ? "" : fmt::format(" to {}", most));
  const auto check = [=](const std::string& text) {
    double value = 0;
    const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) &&
                      value <= most && (leastIncluded ? value >= least : value > least);
    return good ? std::string() : fmt::format("'{}' is not {}", text, range);
  };
  return CLI::Validator(check, "");
}

// Conversion to unsigned numbers wraps negative ones and cuts those too large.
CLI::Validator seedNumber() {
  return CLI::Validator(
      [](const std::string& text) {
        uint64_t value = 0;
        const char* end = text.data() + text.size();
        const auto [next, error] = std::from_chars(text.data(), end, value);
        return error == std::errc() && next == end
                   ? std::string()
                   : fmt::format("'{}' is not an integer from 0 to 2^64-1", text);
      },
      "");
}

}  // namespace

void refuseEmptyValues(CLI::App& c) {
  for (CLI::Option* option : c.get_options()) {
    if (option->get_expected_min() == 0) continue;  // flags
    option->check(CLI::Validator(
        [](const std::string& text) {
          return text.empty() ? std::string("the value is empty; leave the option out instead")
                              : "";
        },
        ""));
  }
}

void addSceneOptions(CLI::App& c, SceneOptions& o) {
  c.add_option("scene", o.scene, "Scene file, or the name of a built-in scene")->required();
  c.add_option("-D,--define", o.definitions, "name=value for a scene's $name")
      ->allow_extra_args(false);
  c.add_option("--environment", o.environment, "Equirectangular HDR image that lights the scene");
  c.add_option("--sky", o.sky,
               "TURBIDITY,X,Y,Z: sun and sky light the scene; the sun in direction X,Y,Z of the "
               "scene, turbidity 2 (very clear) to 10");
  c.add_option("--time", o.time, "Seconds at which an animated scene (glTF) is taken")
      ->check(finiteNumber(-HUGE_VAL))
      ->capture_default_str();
  c.add_option("--variant", o.variant, "Material variant of a glTF scene");
  c.add_flag("--strict", o.strict, "Warnings about the scene are errors");
  c.add_option("--detail", o.detail, "Tessellation of built-in scenes")
      ->check(finiteNumber(0.01, 100))
      ->capture_default_str();
  c.add_option("--meshes", o.meshes,
               "Folder of real meshes (dragon.ply, suzanne.obj, bunny.ply, teapot.obj...) that take "
               "the place of a built-in scene's stand-ins");
}

void addGlobalOptions(CLI::App& c, GlobalOptions& o) {
  c.add_option("--threads", o.threads, "Threads; 0: all cores")->check(CLI::Range(0, 4096));
  auto* quiet = c.add_flag("--quiet", o.quiet, "Errors only");
  c.add_flag("--verbose", o.verbose, "More messages")->excludes(quiet);
}

void addRenderOptions(CLI::App& c, RenderOptions& o) {
  addSceneOptions(c, o.scene);
  c.add_option("-o,--output", o.outputs,
               "Picture to write: .exr (linear), .png (tone-mapped); may be repeated")
      ->required()
      ->allow_extra_args(false);
  c.add_option("--lights", o.lights, "Light model; see `lobelia methods`")->capture_default_str();
  c.add_option("--gather", o.gather, "Gather strategy; see `lobelia methods`")
      ->capture_default_str();
  c.add_option("--spp", o.spp,
               "Samples per pixel; default: 16 with virtual lights, else the scene's or 64")
      ->check(CLI::Range(1, 1 << 24));
  c.add_option("--size", o.size, "WxH in pixels");
  c.add_option("--crop", o.crop,
               "X0,Y0,X1,Y1: compute only this window (pixels, x1 and y1 exclusive)");
  c.add_option("--pixels", o.pixels, "Compute only N pixels, spread over the image by the seed")
      ->check(CLI::Range(uint64_t{1}, uint64_t{1} << 32));
  c.add_option("--camera", o.camera, "Camera by name or index (from 0)");
  c.add_option("--max-depth", o.maxDepth,
               "1: emission only, 2: direct light, ...; default: the scene's, else unlimited")
      ->check(CLI::Range(1, 1 << 20));
  c.add_option("--num-lights", o.lightCount, "Virtual lights aimed at, per set")
      ->check(CLI::Range(uint64_t{1}, uint64_t{1} << 31))
      ->capture_default_str();
  c.add_option("--passes", o.passes,
               "Independent sets of lights, among which the samples are shared out; default: a set "
               "per sample (one set with --save-lights, --load-lights)")
      ->check(CLI::Range(1, 1 << 24));
  c.add_option("--env-lights", o.environmentLights,
               "With --direct lights: directional lights per environment")
      ->check(CLI::Range(uint64_t{1}, uint64_t{1} << 24))
      ->capture_default_str();
  c.add_option("--direct", o.direct, "Direct light by next-event estimation (nee) or by lights")
      ->check(CLI::IsMember({"nee", "lights"}))
      ->capture_default_str();
  c.add_option("--specular-limit", o.specularLimit,
               "Roughness below which a lobe extends paths instead of gathering")
      ->check(finiteNumber(0, 1))
      ->capture_default_str();
  c.add_option("--clamp", o.clamp,
               "Upper limit of geometry term times lobes, or off; default: off (vpl: 127/R^2, R "
               "the scene's radius)");
  c.add_option("--component", o.component, "Which light: all, direct or indirect")
      ->check(CLI::IsMember({"all", "direct", "indirect"}))
      ->capture_default_str();
  c.add_option("--seed", o.seed, "Seed of all randomness")
      ->check(seedNumber())
      ->capture_default_str();
  c.add_option("--time-limit", o.timeLimit, "Seconds after which to write what there is")
      ->check(finiteNumber(0, HUGE_VAL, false));
  c.add_option("--save-lights", o.saveLights, "Write the virtual lights to a file");
  c.add_option("--load-lights", o.loadLights, "Use the virtual lights of a file");
  c.add_option("--stats", o.stats, "Write statistics as JSON");
  c.add_option("--aov", o.aovs,
               "Layers to add to the EXR: albedo,normal,depth,direct,indirect,specular,variance");
  c.add_option("--exposure", o.exposure, "Stops added to the PNG's automatic exposure")
      ->check(finiteNumber(-100, 100));
}

}  // namespace lobelia::app
