// PBRT-v4's equal-area octahedral images of directions, resampled to our layouts.
#pragma once

#include "lobelia/scene/texture.h"

namespace lobelia::io::pbrt {

// Unit direction to the unit square and back.
Vec2f octahedralFromDirection(Vec3f d);
Vec3f directionFromOctahedral(Vec2f p);

// Equirectangular image in the orientation of EmitterType::environment whose local axes are those
// of the octahedral image. The image must be square.
Image environmentFromOctahedral(const Image& square);
// Layout of EmitterType::goniometric; one channel, the mean of colours. PBRT stands its goniometric
// images upright: their z axis is the light's y.
Image goniometricFromOctahedral(const Image& square);

}  // namespace lobelia::io::pbrt
