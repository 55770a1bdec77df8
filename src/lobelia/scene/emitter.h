// Emitters: plain data. Sampling lives in path/emitter_sampling.h.
#pragma once

#include "lobelia/base/transform.h"
#include "lobelia/scene/texture.h"

namespace lobelia {

enum class EmitterType : uint8_t { area, point, spot, directional, constant, environment, projector };

struct Emitter {
  EmitterType type = EmitterType::point;
  std::string name;
  Transform toWorld;     // spot/projector: looks along +z; environment: Mitsuba's axes (y up)
  ColorParam radiance;   // area, constant: radiance; point, spot: intensity (W/sr); directional:
                         // irradiance; projector: irradiance image; environment: bitmap
  float scale = 1;       // environment, projector
  ImageHandle image;     // environment: equirectangular, Mitsuba's orientation
  // spot: intensity falls linearly in angle from beamWidth to cutoff (radians); `pattern` multiplies
  float cutoff = 0.349066f, beamWidth = 0.2617994f;
  TextureHandle pattern;
  float fov = 0.785398f; // projector: x field of view in radians
  Vec3f direction{0, 0, 1};  // directional: where the light travels to, world space
};

}  // namespace lobelia
