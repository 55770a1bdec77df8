#include "lobelia/app/render_options.h"

#include <CLI/CLI.hpp>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/methods.h"
#include "lobelia/app/option_checks.h"
#include "lobelia/app/vsgl_options.h"

namespace lobelia::app {

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
  c.add_option("scene", o.scene, "Scene file, or the name of a built-in scene")
      ->type_name("FILE|SCENE")
      ->required();
  c.add_option("-D,--define", o.definitions, "name=value for a scene's $name")
      ->type_name("NAME=VALUE")
      ->allow_extra_args(false);
  c.add_option("--environment", o.environment, "Equirectangular HDR image that lights the scene")
      ->type_name("FILE");
  c.add_option("--sky", o.sky,
               "TURBIDITY,X,Y,Z: sun and sky light the scene; the sun in direction X,Y,Z of the "
               "scene, turbidity 2 (very clear) to 10")
      ->type_name("T,X,Y,Z");
  c.add_option("--design", o.design,
               "Design: a file of materials, emitters and cameras that take the place of the "
               "scene's (docs/manual.md)")
      ->type_name("FILE");
  c.add_option("--time", o.time, "Seconds at which an animated scene is taken")
      ->type_name("SECONDS")
      ->check(finiteNumber(-HUGE_VAL))
      ->capture_default_str();
  c.add_option("--variant", o.variant, "Material variant of a glTF scene")->type_name("NAME");
  c.add_flag("--strict", o.strict, "Warnings about the scene are errors");
  c.add_option("--detail", o.detail, "Tessellation of built-in scenes")
      ->type_name("X")
      ->check(finiteNumber(0.01, 100))
      ->capture_default_str();
  c.add_option(
       "--meshes", o.meshes,
       "Folder of real meshes (dragon.ply, suzanne.obj, bunny.ply, teapot.obj...) that take "
       "the place of a built-in scene's stand-ins")
      ->type_name("FOLDER");
}

void addGlobalOptions(CLI::App& c, GlobalOptions& o) {
  c.add_option("--threads", o.threads, "Threads; 0: all cores")
      ->type_name("N")
      ->check(integerRange(0, 4096))
      ->capture_default_str();
  auto* quiet = c.add_flag("--quiet", o.quiet, "Errors only");
  c.add_flag("--verbose", o.verbose, "More messages")->excludes(quiet);
}

void addPictureOptions(CLI::App& c, RenderOptions& o) {
  c.add_option("--size", o.size, "WxH in pixels")->type_name("WxH");
  c.add_option("--crop", o.crop,
               "X0,Y0,X1,Y1: compute only this window (pixels, x1 and y1 exclusive)")
      ->type_name("X0,Y0,X1,Y1");
  c.add_option("--camera", o.camera,
               "Camera by name or index (from 0); with --frames several, A,B,C: a smooth path "
               "through them")
      ->type_name("NAME");
  c.add_option("--frames", o.frames,
               "Render N frames along the camera's path; files are numbered: %04d in a name, or "
               ".0000 before the extension")
      ->type_name("N")
      ->check(integerRange(1, 1'000'000));
  c.add_option("--frame", o.frame, "Only this of the frames (from 0), or A-B")->type_name("K|A-B");
  c.add_flag("--turntable", o.turntable,
             "The frames go once around what the camera looks at, about the vertical axis");
}

void addRenderOptions(CLI::App& c, RenderOptions& o) {
  addSceneOptions(c, o.scene);
  c.add_option("-o,--output", o.outputs, "Picture to write: .exr (linear), .png (tone-mapped)")
      ->type_name("FILE")
      ->allow_extra_args(false);
  c.add_option("--lights", o.lights, "Light model; `lobelia methods` explains")
      ->type_name("MODEL")
      ->check(offered(lightModelNames()))
      ->capture_default_str();
  c.add_option("--gather", o.gather, "Gather strategy; `lobelia methods` explains")
      ->type_name("STRATEGY")
      ->check(offered(gatherStrategyNames()))
      ->capture_default_str();
  c.add_option("--spp", o.spp,
               "Samples per pixel; default: 16 with virtual lights, else the scene's or 64")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 24));
  addPictureOptions(c, o);
  c.add_option("--pixels", o.pixels, "Compute only N pixels, spread over the image by the seed")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 32));
  c.add_option("--pixels-seed", o.pixelsSeed,
               "Seed by which --pixels chooses, so that pictures of several seeds have the same "
               "pixels; default: --seed")
      ->type_name("N")
      ->check(seedNumber());
  c.add_option("--display", o.display, "Show the picture in tev while it is made")
      ->type_name("HOST:PORT");
  c.add_option("--max-depth", o.maxDepth,
               "1: emission only, 2: direct light, ...; default: the scene's, else unlimited")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 20));
  c.add_option("--num-lights", o.lightCount,
               "Virtual lights, or photons, aimed at, per set; default: 512 (photon: 200000)")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 31));
  c.add_option("--passes", o.passes,
               "Independent sets of lights, among which the samples are shared out; default: a set "
               "per sample (one set with --save-lights, --load-lights; one per 16 samples with "
               "--gather mdlc)")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 24));
  c.add_option("--rows", o.rows,
               "--gather mrcs: pixels at which all lights are computed; default: 1024")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 20));
  c.add_option("--columns", o.columns,
               "--gather mrcs: lights per set that stand for all, with --error at most; default: "
               "by an error of 0.02, at most 16384. --gather lightslice: lights that stand for all "
               "in a slice; default: 400")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 31));
  c.add_option("--slices", o.slices,
               "--gather lightslice: groups of like receivers, each with lights of its own; "
               "default: 400")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 20));
  c.add_option("--error", o.error,
               "--gather mrcs, sglc: relative error aimed at in the gathered light, 0.01 = 1 %")
      ->type_name("R")
      ->check(finiteNumber(0, 1, false));
  c.add_option("--sketch", o.sketch,
               "--gather mrcs: numbers kept of a light's rows, or off: all of them; default: 64 "
               "where all take more than 64 MiB")
      ->type_name("N");
  c.add_option("--column-scale", o.columnScale,
               "--gather mrcs: a light that stands for others is scaled as a whole (scalar) or "
               "channel by channel, which is biased")
      ->type_name("HOW")
      ->check(oneOf({"scalar", "channel"}))
      ->capture_default_str();
  c.add_option("--near-field", o.nearField,
               "--gather mrcs: radii of a spherical light within which receivers gather the light "
               "itself, not what stands for it; 0: none (the paper's); default: 6, fewer where "
               "--radius is above 2")
      ->type_name("K")
      ->check(finiteNumber(0, 1000));
  c.add_option(
       "--memory", o.memory,
       "--gather mrcs, lightslice: memory for what is kept of all lights; --lights richvpl: "
       "for its places; units K, M, G; default: 2G")
      ->type_name("BYTES")
      ->transform(byteCount());
  c.add_option("--sglc-mode", o.cutMode,
               "--gather sglc: one shadow ray per light answers for a cluster of neighbouring "
               "receivers (shared, the default), or every receiver traces its own (unbiased); "
               "or pairs of light and receiver nodes, refined by bounds (paper)")
      ->type_name("MODE")
      ->check(oneOf({"shared", "unbiased", "paper"}));
  c.add_option(
       "--threshold", o.threshold,
       "--sglc-mode paper: error that a pair of nodes may have, relative to what its "
       "pixels have; 0: all lights; default: 0.01. --gather lightcuts, mdlc, stochastic: share "
       "of a receiver's (mdlc: a pixel's) light below which the bound of a node's must be, unless "
       "the cut is full; 0: only its size limits it; default: lightcuts, mdlc 0.02, stochastic "
       "0. illumcut: share of what pixels have in a coarse picture, below which the bound "
       "of a pair of nodes must be; 0: all lights; default: 0.01")
      ->type_name("R")
      ->check(finiteNumber(0, 1));
  c.add_option("--bound", o.bound,
               "--sglc-mode paper: error of pairs of nodes as if all of their lights were seen "
               "alike (approximate, the default), or whatever is seen (conservative)")
      ->type_name("WHICH")
      ->check(oneOf({"approximate", "conservative"}));
  c.add_option("--sglc-bounds", o.boundForm,
               "--sglc-mode paper: bounds by boxes and with sharpness and amplitude coupled "
               "(tight, the default), or as the paper has them (corrected)")
      ->type_name("FORM")
      ->check(oneOf({"tight", "corrected"}));
  c.add_option("--sglc-share", o.shared,
               "--sglc-mode paper: receivers of a node share a shadow ray and are lit one by one "
               "(visibility, the default), or all get the light of one (radiance)")
      ->type_name("WHAT")
      ->check(oneOf({"visibility", "radiance"}));
  c.add_option("--sglc-children", o.children,
               "--sglc-mode paper: of a pair the node is refined that extends further (extent, the "
               "default), or that whose children leave the smaller error (paper)")
      ->type_name("RULE")
      ->check(oneOf({"extent", "paper"}));
  c.add_option("--illumcut-rays", o.illumcutRays,
               "--gather illumcut: shadow rays of some receivers of a node, of more where they do "
               "not agree (sampled, the default), or of every receiver (full)")
      ->type_name("WHICH")
      ->check(oneOf({"sampled", "full"}));
  c.add_option("--richvpl-lights", o.richLights,
               "--lights richvpl: places that send out the light of all lights around them; "
               "default: 1000")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 24));
  c.add_option(
       "--richvpl-radiance", o.richRadiance,
       "--lights richvpl: light of a place by directions, as a cube map, or as a mixture of "
       "Gaussian lobes (vmf, the default)")
      ->type_name("FORM")
      ->check(oneOf({"cube", "vmf"}));
  c.add_option("--richvpl-texels", o.richTexels,
               "--richvpl-radiance cube: texels along an edge, an even number; default: 16")
      ->type_name("N")
      ->check(integerRange(4, 128));
  c.add_option("--richvpl-lobes", o.richLobes,
               "--richvpl-radiance vmf: lobes of a place, at most; default: 8")
      ->type_name("N")
      ->check(integerRange(1, 256));
  c.add_option(
       "--cut-size", o.cutSize,
       "--gather sglc: nodes of a cluster's cut, at most; default: 1024, with --error 16384. "
       "lightcuts, stochastic: nodes of a receiver's cut, at most; default: 1000, 256. mdlc: "
       "pairs of nodes of a pixel's, at most; default: 8000")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 24));
  c.add_option("--env-lights", o.environmentLights,
               "With --direct lights: directional lights per environment")
      ->type_name("N")
      ->check(integerRange(1, int64_t{1} << 24))
      ->capture_default_str();
  c.add_option("--direct", o.direct, "Direct light by next-event estimation (nee) or by lights")
      ->type_name("HOW")
      ->check(oneOf({"nee", "lights"}))
      ->capture_default_str();
  c.add_option("--radius", o.radius,
               "Radius of spherical lights over the distance of their tenth neighbour; default: "
               "chosen automatically")
      ->type_name("C")
      ->check(finiteNumber(0, 1e6, false));
  c.add_option("--vsl-indicator", o.sphereIndicator,
               "Which directions to a spherical light count: those that meet its disc on the "
               "surface (planar), or all, with a cosine (cosine, the paper's)")
      ->type_name("HOW")
      ->check(oneOf({"planar", "cosine"}))
      ->capture_default_str();
  c.add_option("--vsl-sampling", o.sphereSampling,
               "Directions to a spherical light by its disc or cone and by products of lobes "
               "(product), by the cone and both BSDFs (paper; slow), or by the cone alone (cone)")
      ->type_name("HOW")
      ->check(oneOf({"product", "paper", "cone"}))
      ->capture_default_str();
  c.add_option("--vsl-samples", o.sphereSamples,
               "Directions per pair where lobes and light overlap over a whole hemisphere")
      ->type_name("N")
      ->check(integerRange(1, 1000))
      ->capture_default_str();
  addVsglOptions(c, o);
  c.add_option("--specular-limit", o.specularLimit,
               "Roughness below which a lobe extends paths instead of gathering")
      ->type_name("ROUGHNESS")
      ->check(finiteNumber(0, 1))
      ->capture_default_str();
  c.add_option("--clamp", o.clamp,
               "Upper limit of geometry term times lobes, or off; default: off (vpl, and with "
               "--compensate: 127/R^2, R the scene's radius)")
      ->type_name("X");
  c.add_option("--near-lights", o.nearLights,
               "With vpl, glossy and vsl: receivers find by rays of their own what is so near that "
               "about N virtual lights lie there, or fewer; 0: nothing; default: 4, with "
               "--compensate 0")
      ->type_name("N")
      ->check(finiteNumber(0, 1e6));
  c.add_flag("--compensate", o.compensate,
             "With vpl and glossy lights: path-trace what clamp and lights leave out");
  c.add_option("--photons-nearest", o.photonsNearest,
               "With --lights photon: photons looked up where a receiver's ray ends")
      ->type_name("K")
      ->check(integerRange(1, 1'000'000))
      ->capture_default_str();
  c.add_option("--photon-radius", o.photonRadius,
               "With --lights photon: how far away they are at most; default: a tenth of the "
               "scene's radius")
      ->type_name("X")
      ->check(finiteNumber(0, HUGE_VAL, false));
  c.add_option("--gather-rays", o.gatherRays, "With --lights photon: rays of a receiver per sample")
      ->type_name("N")
      ->check(integerRange(1, 1 << 16))
      ->capture_default_str();
  c.add_option("--component", o.component, "Which light: all, direct or indirect")
      ->type_name("PART")
      ->check(oneOf({"all", "direct", "indirect"}))
      ->capture_default_str();
  c.add_option("--seed", o.seed, "Seed of all randomness")
      ->type_name("N")
      ->check(seedNumber())
      ->capture_default_str();
  c.add_option("--time-limit", o.timeLimit, "Seconds after which to write what there is")
      ->type_name("SECONDS")
      ->check(finiteNumber(0, HUGE_VAL, false));
  auto* checkpoint =
      c.add_option("--checkpoint", o.checkpoint,
                   "Start afresh and keep the state of the render in a file, for --resume")
          ->type_name("FILE");
  c.add_option("--resume", o.resume,
               "Go on from the checkpoint when the file is there; keep the state in it")
      ->type_name("FILE")
      ->excludes(checkpoint);
  c.add_option("--checkpoint-interval", o.checkpointInterval, "Seconds between checkpoints")
      ->type_name("SECONDS")
      ->check(finiteNumber(0, HUGE_VAL, false))
      ->capture_default_str();
  c.add_option("--replay", o.replay,
               "X,Y: render only this pixel and print what its samples did; writes no picture")
      ->type_name("X,Y");
  c.add_option("--save-lights", o.saveLights, "Write the virtual lights to a file")
      ->type_name("FILE");
  c.add_option("--load-lights", o.loadLights, "Use the virtual lights of a file")
      ->type_name("FILE");
  c.add_option(
       "--export-trees", o.exportTrees,
       "--gather sglc, lightcuts: write light trees and the cuts of the first sample as NPY "
       "files, with description.json")
      ->type_name("FOLDER");
  c.add_option("--stats", o.stats, "Write statistics as JSON")->type_name("FILE");
  c.add_option("--aov", o.aovs, "Layers to add to the EXR, separated by commas")
      ->type_name("LIST")
      ->check(offered(knownLayers()));
  c.add_option("--exposure", o.exposure, "Stops added to the PNG's automatic exposure")
      ->type_name("STOPS")
      ->check(finiteNumber(-100, 100));
}

}  // namespace lobelia::app
