// Sun and sky as emitters: the atmosphere's radiance as an environment image, and the sun's disc.
#pragma once

#include <string>

#include "lobelia/base/error.h"
#include "lobelia/scene/scene.h"

namespace lobelia::io {

// What is seen below the horizon.
enum class BelowHorizon : uint8_t { black, extended, ground };

struct SkySettings {
  double turbidity = 3;          // from 1 to 10
  Vec3d sun{0, 1, 0};            // towards the sun in the sky's own axes: y is up; any length
  Rgb albedo{0.3f, 0.3f, 0.3f};  // of the ground, from 0 to 1
  double stretch = 1;            // from 1 to 2: angles from the zenith are drawn out by this factor
  int width = 512;               // of the image; its height is half of that, and one row
  BelowHorizon below = BelowHorizon::black;
};

struct Sky {
  Image image;        // for EmitterType::environment, y up; units: atmosphere.h
  Vec3f sun;          // towards the sun, as in the image; unit
  Rgb sunIrradiance;  // on a plane facing it
};

// Throws InputError at `where` when the settings are out of range.
Sky makeSky(const SkySettings& settings, const Location& where);

// Emitters of a sky whose own axes `toWorld` turns into the world's.
Emitter skyEmitter(Scene& scene, Image image, const Transform& toWorld);
Emitter sunEmitter(const Sky& sky, const Transform& toWorld);

// "turbidity,x,y,z" (ReadSettings::sky): sun and sky in place of the scene's environment and suns.
// x, y, z points to the sun in world space, in which up is the axis nearest to the first camera's
// up direction (y where there is no camera). Below the horizon lies a grey ground of albedo 0.3.
void applySky(Scene& scene, const std::string& sky);

}  // namespace lobelia::io
