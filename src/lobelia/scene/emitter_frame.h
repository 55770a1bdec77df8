// How a point-like emitter (spot, projector, goniometric) stands in the world.
//
// Its pattern is an intensity per solid angle, which a transform that scales space unevenly or
// shears it would change by a Jacobian, and would make of a round cone an elliptic one. Only the
// rigid part counts: every method asks here, and validate() says what was dropped.
#pragma once

#include "lobelia/base/frame.h"
#include "lobelia/scene/emitter.h"

namespace lobelia {

// Orthonormal axes x, y, z in world space: z along the transformed z (the view axis stays), x the
// part of the transformed x across it. Left-handed where the transform mirrors space.
Frame emitterFrame(const Emitter& emitter);

// Whether emitterFrame() and a uniform scale are all that the transform does to directions.
bool keepsAngles(const Emitter& emitter);

}  // namespace lobelia
