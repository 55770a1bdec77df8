// Captured-like materials for built-in scenes: sums of spherical Gaussians whose amplitudes and
// sharpnesses are textures that we generate, in the manner of "card" and "satin" of [P000 figure
// 5].
#pragma once

#include <string>

#include "lobelia/builtin/scene_builder.h"

namespace lobelia::builtin {

// Damask: flowers of warp-faced satin on a weft-faced ground, down to the single threads. Both
// reflect alike in all, but the flowers more and in narrower lobes. `repeats`: copies of the
// pattern (one flower and four quarters) along u and v of the unit square.
struct SatinStyle {
  Rgb dye{0.45f, 0.06f, 0.09f};   // diffuse reflectance of the ground
  Rgb sheen{0.62f, 0.36f, 0.3f};  // reflectance of the flowers' threads, ground: a third of it
  float flowerSharpness = 90, groundSharpness = 12;
  int resolution = 512;  // pixels of the textures along u and v
  float repeats = 1;
};
MaterialHandle addSatin(SceneBuilder& builder, const SatinStyle& style = {},
                        std::string name = "satin");

// Printed card: inks in rosettes and a frame over matte paper, varnished where there is ink. The
// pattern fills the unit square `repeats` times along u and v.
struct CardStyle {
  Rgb paper{0.78f, 0.74f, 0.66f};
  Rgb ink{0.07f, 0.13f, 0.34f}, accent{0.55f, 0.09f, 0.08f};  // diffuse reflectances
  float varnishSharpness = 400, paperSharpness = 10;
  int resolution = 512;
  float repeats = 1;
};
MaterialHandle addCard(SceneBuilder& builder, const CardStyle& style = {},
                       std::string name = "card");

}  // namespace lobelia::builtin
