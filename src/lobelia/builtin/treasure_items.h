// What lies in the treasure (internal to this room). y is up; things stand on y = 0 with their axis
// at x = z = 0. `fine` is a function from segments at detail 1 to segments.
#pragma once

#include <functional>

#include "lobelia/scene/mesh.h"

namespace lobelia::builtin {

using Fineness = std::function<int(int atDetailOne, int least)>;

Mesh coin(const Fineness& fine, int rays);  // radius 1, thickness 0.16, around y = 0; a sun of rays
Mesh goblet(const Fineness& fine);          // about 1 high
Mesh dish(const Fineness& fine);            // radius 1, fluted rim
Mesh crownBand(const Fineness& fine, int points);  // radius 1, a wall rising to points
Mesh crownArches(const Fineness& fine);  // two crossing arches with an orb, on a crownBand
Mesh ringHoop(const Fineness& fine);     // a finger ring of radius 1 around z, setting on top
Mesh cutGem(int sides);                  // faceted, girdle of radius 1
Mesh swordBlade(const Fineness& fine);   // along +y from 0 to 1, about 0.06 wide
Mesh swordHilt(const Fineness& fine);    // guard, grip and pommel, from 0 down to -0.3

}  // namespace lobelia::builtin
