// Generated images for the built-in scenes (internal to this room): the same bits everywhere,
// periodic in u and v. Colours are scene-linear and quantised to 8 bits of sRGB, other data to 8
// linear bits, so that files of them hold exactly these values.
#pragma once

#include <functional>

#include "lobelia/scene/texture.h"

namespace lobelia::builtin {

// Pixels of f(u, v) at texel centres.
Image colorImage(int width, int height, const std::function<Rgb(Vec2f)>& f);
Image dataImage(int width, int height, const std::function<float(Vec2f)>& f);  // one channel, [0,1]

// Colour with a height (0 to 1) and a roughness that fit it.
struct SurfaceImages {
  Image color, height, roughness;
};

// Planks along u: `planks` rows across v, cut at random places, grain along u.
struct Wood {
  Rgb light{0.42f, 0.25f, 0.12f}, dark{0.20f, 0.10f, 0.045f};
  int planks = 6;        // 1: a board without joints
  float joint = 0.012f;  // width, part of a plank's
  float roughness = 0.18f, roughnessSpread = 0.08f;
  uint64_t seed = 1;
};
SurfaceImages wood(const Wood& wood, int size);

// columns x rows tiles with grout; rows may be shifted (brick bond). Each tile's tone and gloss
// differ.
struct Tiles {
  Rgb color{0.75f, 0.74f, 0.70f}, grout{0.35f, 0.34f, 0.32f};
  Rgb second{-1.f, -1.f, -1.f};  // of every other tile, when not negative (even columns and rows)
  int columns = 4, rows = 4;
  bool brickBond = false;
  float groutWidth =
      0.03f;  // part of a tile's smaller side; tiles are aspect times as wide as high
  float aspect = 1;
  float edge = 0.05f;  // rounding of tiles towards the grout, as groutWidth
  float toneSpread = 0.05f, mottle = 0.03f;
  float roughness = 0.07f, roughnessSpread = 0.04f, groutRoughness = 0.5f;
  uint64_t seed = 1;
};
SurfaceImages tiles(const Tiles& tiles, int size);

struct Marble {
  Rgb ground{0.78f, 0.77f, 0.75f}, vein{0.30f, 0.31f, 0.34f};
  int scale = 3;  // lattice cells per repeat
  float sharpness = 3;
  uint64_t seed = 1;
};
Image marble(const Marble& marble, int size);
// Speckled stone: grains of three colours.
Image granite(Rgb a, Rgb b, Rgb c, int grains, int size, uint64_t seed = 1);
// Roughness of brushed metal: streaks along u.
Image brushed(float mean, float spread, int size, uint64_t seed = 1);
// Stripes across u: share of `a` in a repeat of n.
Image stripes(Rgb a, Rgb b, int n, float share, int size);
// A plain weave of `threads` threads each way; the height of its threads.
SurfaceImages fabric(Rgb warp, Rgb weft, int threads, int size, uint64_t seed = 1);

}  // namespace lobelia::builtin
