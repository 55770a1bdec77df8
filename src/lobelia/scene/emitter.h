// Emitters: plain data. Sampling lives in path/emitter_sampling.h.
#pragma once

#include "lobelia/base/transform.h"
#include "lobelia/scene/texture.h"

namespace lobelia {

enum class EmitterType : uint8_t {
  area, point, spot, directional, constant, environment, projector,
  goniometric,  // a point light whose intensity is `image` over directions
  sun,          // directional with a disc of angularRadius; seen by rays that escape
};

struct Emitter {
  EmitterType type = EmitterType::point;
  std::string name;
  std::string group;     // light group; pictures have one layer per group, "" is one of them
  Transform toWorld;     // spot/projector: looks along +z; environment: Mitsuba's axes (y up)
  ColorParam radiance;   // area, constant: radiance; point, spot: intensity (W/sr); directional:
                         // irradiance; projector: irradiance image; environment: bitmap;
                         // goniometric: factor of the image; sun: irradiance on a plane facing it
  float scale = 1;       // environment, projector, goniometric
  ImageHandle image;     // environment: equirectangular, Mitsuba's orientation; goniometric: rows by
                         // the angle from local +z (first row: along +z), columns by the azimuth
                         // from local +x towards +y; texel centres, linear between them
  // spot: intensity falls linearly in angle from beamWidth to cutoff (radians); `pattern` multiplies
  float cutoff = 0.349066f, beamWidth = 0.2617994f;
  TextureHandle pattern;
  float fov = 0.785398f; // projector: x field of view in radians
  Vec3f direction{0, 0, 1};  // directional, sun: where the light travels to, world space
  float angularRadius = 0.004654f;  // sun, radians
};

}  // namespace lobelia
