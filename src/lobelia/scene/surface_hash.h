// Hash of what surfaces are and reflect: meshes, instances, materials with their textures; not of
// emitters, the images that these alone use, cameras and settings.
#pragma once

#include "lobelia/scene/scene.h"

namespace lobelia {

uint64_t surfaceHash(const Scene& scene);

}  // namespace lobelia
