// Area lights that shine from both sides. An emitter here has one: the other is a second instance,
// set back by 1e-4 of the shape's size.
#pragma once

#include <map>

#include "lobelia/scene/scene.h"

namespace lobelia::io {

class LightBacks {
 public:
  explicit LightBacks(Scene& scene) : scene_(scene) {}

  // Adds the back of an instance, with the same emitter and material. Instances of a mesh share the
  // mesh of their backs.
  void add(size_t instance);

 private:
  MeshHandle backOf(MeshHandle mesh, bool flipped);

  Scene& scene_;
  std::map<std::pair<uint32_t, bool>, MeshHandle> backs_;  // by mesh and flipNormals
};

}  // namespace lobelia::io
