// The materials of figure 6 of [P004]: what a person may give an object without any precomputation,
// one of each kind that the paper shows.
#pragma once

#include <string>
#include <vector>

#include "lobelia/scene/scene.h"

namespace lobelia::app {

struct MaterialDesign {
  std::string name;
  Material material;
};

// The material of most triangles: the object that designs are shown on. Not of emitters' surfaces
// nor of what lets light through: a scene of nothing else gives a handle that is not valid.
MaterialHandle largestMaterial(const Scene& scene);

// Adds the images, textures and wrapped materials that designs for the object want; materials stay
// as they are. Its meshes get texture coordinates where they have none: projected aslant, so that
// no side is seen along them and there are no seams.
std::vector<MaterialDesign> addDesigns(Scene& scene, MaterialHandle object);

}  // namespace lobelia::app
