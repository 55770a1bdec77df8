// Changes to a material as a whole: another type, a bump or normal map put around it.
#pragma once

#include <string>
#include <vector>

#include "lobelia/app/studio/design.h"

namespace lobelia::app {

// The material that shows: what is inside two-sided, mask, bump and normal-map wrappers (the first
// of a blend).
uint32_t shownMaterial(const Design& design, uint32_t material);

// Changes the shown material's type. Colours and roughness stay as near as the new type has them;
// what it has newly gets defaults: of a metal, that of aluminium's colour by its specular
// reflectance. type: one of simpleTypes().
void changeType(Design& design, uint32_t material, MaterialType type);

// Puts a map around the shown material, in the place of one that is there. An invalid texture takes
// the map away. scale: of bump maps, in the scene's units.
void setBump(Design& design, uint32_t material, TextureHandle heights, float scale);
void setNormalMap(Design& design, uint32_t material, TextureHandle normals);

}  // namespace lobelia::app
