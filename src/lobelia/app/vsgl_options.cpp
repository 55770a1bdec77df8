#include "lobelia/app/vsgl_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "lobelia/app/option_checks.h"
#include "lobelia/base/error.h"

namespace lobelia::app {
namespace {

constexpr size_t kPointsOfCluster = 64, kLeastPoints = size_t{1} << 16,
                 kMostPoints = size_t{1} << 20;
constexpr int kMostShadowRays = 4096;
constexpr int kLeastMapSize = 8, kMostMapSize = 1024, kMapSize = 64;

// --vsgl-shadows N; nothing where it is a word.
std::optional<int> rayCount(const std::string& text) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || next != end) return {};
  return value;
}

CLI::Validator shadows() {
  return CLI::Validator(
      [](const std::string& text) {
        const std::vector<std::string> words{"random", "mean", "maps", "none"};
        if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
        const std::optional<int> count = rayCount(text);
        if (count && *count >= 1 && *count <= kMostShadowRays) return std::string();
        return fmt::format(
            "'{}' is none of random, mean, maps, none and not an integer from 1 to {}{}", text,
            kMostShadowRays, suggestion(text, words));
      },
      "");
}

}  // namespace

void addVsglOptions(CLI::App& c, RenderOptions& o) {
  c.add_option(
       "--vsgl-clusters", o.vsglClusters,
       "--lights vsgl: points are clustered by a cut of their tree (tree, the default), or "
       "those of reflective shadow maps by filtered importance sampling (fis; fis-original: "
       "with kernels by the density at their centres) or around random ones (kmeans), or all of a "
       "map, its diffuse and its glossy part (pairs: two lights for each emitter, the fastest)")
      ->type_name("HOW")
      ->check(oneOf({"tree", "kmeans", "fis", "fis-original", "pairs"}));
  c.add_option("--vsgl-points", o.vsglPoints,
               "--lights vsgl: points, or texels of reflective shadow maps, that clusters are made "
               "of; default: 64 for each light, from 65536 to 1048576")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 24));
  c.add_option(
       "--vsgl-views", o.vsglViews,
       "--vsgl-clusters kmeans, fis, fis-original, pairs: reflective shadow maps; default: 1 for a "
       "scene lit from one point or direction, else 64; pairs: as many as emitters")
      ->type_name("N")
      ->check(integerRange(1, 1 << 16));
  c.add_option("--vsgl-overlap", o.vsglOverlap,
               "--vsgl-clusters fis, fis-original: power of a kernel over that of one light; "
               "default: 1")
      ->type_name("K")
      ->check(finiteNumber(0, 1000, false));
  c.add_option(
       "--vsgl-shading", o.vsglShading,
       "--lights vsgl: cosines integrated and lobes widened (accurate, the default), or the "
       "paper's: diffuse receivers by products of Gaussians (product) or by the cosine at "
       "the mean (pulled)")
      ->type_name("FORM")
      ->check(oneOf({"accurate", "product", "pulled"}));
  c.add_option("--vsgl-variance", o.vsglVariance,
               "--lights vsgl: extent of a light across the view (projected, the default), or the "
               "same from all sides (isotropic)")
      ->type_name("HOW")
      ->check(oneOf({"projected", "isotropic"}));
  c.add_option("--vsgl-spread", o.vsglSpread,
               "--lights vsgl: factor of that extent's square; 1: that of the points, 2: that of a "
               "surface tiled by lights; default: 1")
      ->type_name("S")
      ->check(finiteNumber(0, 100, false));
  c.add_option("--vsgl-merging", o.vsglMerging,
               "--lights vsgl: means of Gaussians exact (the default) or by Toksvig's formula, as "
               "the paper has them")
      ->type_name("HOW")
      ->check(oneOf({"exact", "toksvig"}));
  c.add_option(
       "--vsgl-shadows", o.vsglShadows,
       "--lights vsgl: a shadow ray to every light, to its middle point (mean, the default) or to "
       "one of four (random); shadow maps in place of rays (maps); N rays for a receiver, to "
       "lights "
       "chosen by what they would send; none: no shadows")
      ->type_name("HOW|N")
      ->check(shadows());
  c.add_option("--vsgl-map-size", o.vsglMapSize,
               "--vsgl-shadows maps: texels on a side of a light's map; default: 64")
      ->type_name("N")
      ->check(integerRange(kLeastMapSize, kMostMapSize));
}

void requireVsgl(const RenderOptions& options) {
  if (options.lights != "vsgl") return;
  const bool maps = !options.vsglClusters.empty() && options.vsglClusters != "tree";
  const auto require = [&](const char* name, bool given, bool fits, const char* what) {
    if (given && !fits) throw UsageError(fmt::format("{} is for {}", name, what));
  };
  require("--vsgl-views", options.vsglViews > 0, maps,
          "--vsgl-clusters kmeans, fis, fis-original and pairs; a tree has points from all over");
  require("--vsgl-overlap", options.vsglOverlap > 0,
          options.vsglClusters == "fis" || options.vsglClusters == "fis-original",
          "--vsgl-clusters fis and fis-original; other clusters do not overlap");
  const bool chosen = shadowRaysOf(options) >= 0 || mapSizeOf(options) > 0;
  require("--vsgl-shadows with maps, N or none", chosen, options.gather == "all",
          "--gather all; other strategies trace the rays that they need");
  require("--vsgl-map-size", options.vsglMapSize > 0, mapSizeOf(options) > 0,
          "--vsgl-shadows maps; rays have no texels");
}

GaussianShading gaussianShadingOf(const RenderOptions& options) {
  using enum GaussianShading::Form;
  GaussianShading shading;
  shading.form = options.vsglShading == "product"  ? product
                 : options.vsglShading == "pulled" ? pulled
                                                   : accurate;
  shading.ends =
      options.vsglShadows == "random" ? GaussianShading::Ends::random : GaussianShading::Ends::mean;
  shading.projected = options.vsglVariance != "isotropic";
  if (options.vsglSpread > 0) shading.spread = options.vsglSpread;
  shading.toksvig = options.vsglMerging == "toksvig";
  return shading;
}

int shadowRaysOf(const RenderOptions& options) {
  if (options.lights != "vsgl") return -1;
  if (options.vsglShadows == "none") return 0;
  return rayCount(options.vsglShadows).value_or(-1);
}

int mapSizeOf(const RenderOptions& options) {
  if (options.lights != "vsgl" || options.vsglShadows != "maps") return 0;
  return options.vsglMapSize > 0 ? options.vsglMapSize : kMapSize;
}

size_t vsglPointsOf(const RenderOptions& options, size_t lights) {
  if (options.vsglPoints > 0) return options.vsglPoints;
  return std::max(lights, std::clamp(kPointsOfCluster * lights, kLeastPoints, kMostPoints));
}

}  // namespace lobelia::app
