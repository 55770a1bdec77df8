// A procedural closed room of about 100,000 triangles, on which rates of rays are measured: wavy
// walls, floor and ceiling, and spheres of several sizes that stand about; a lamp under the ceiling
// and a camera near a wall. 6 x 4 x 3 metres, z is up. The built-in scene `study-room` is one.
#pragma once

#include "lobelia/scene/scene.h"

namespace lobelia::builtin {

// The same geometry in every kind; manyLights has no lamp.
enum class RoomKind {
  diffuse,     // Lambert
  ggx,         // conductors of GGX roughness 0.2
  plastic,     // a GGX coat of roughness 0.2 over a diffuse base
  mixed,       // all of these
  manyLights,  // diffuse, lit by its spheres
};
Scene closedRoom(RoomKind kind, float detail = 1);

// A grid of cells x cells quads spanned by u and v from a corner, displaced along n by waves that
// vanish at the border, so that the walls of a room stay closed.
Mesh wavyWall(Vec3f corner, Vec3f u, Vec3f v, Vec3f n, uint32_t cells, float height);

}  // namespace lobelia::builtin
