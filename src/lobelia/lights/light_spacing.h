// How far apart virtual lights are, anywhere in the scene.
#pragma once

#include <initializer_list>
#include <memory>

#include "lobelia/lights/virtual_lights.h"

namespace lobelia {

class LightSpacing {
 public:
  // Diffuse, glossy and spherical lights count. The lights need not outlive it.
  explicit LightSpacing(std::initializer_list<const VirtualLights*> lights);
  ~LightSpacing();

  // Radius of a sphere around p in which about `count` (at least 0) lights lie, if they lie on a
  // plane through p; infinite where there are none at all.
  float distance(Vec3f p, float count) const;

 private:
  struct Search;
  std::unique_ptr<Search> search_;
};

}  // namespace lobelia
