// Cameras and punctual lights of nodes.
#pragma once

#include "lobelia/io/gltf/nodes.h"

namespace lobelia::io::gltf {

// The nodes from `node` up to its root, and what drives them: enough to find its place at a time.
struct Hierarchy {
  const std::vector<Node>& nodes;
  const std::vector<Channel>& channels;
};

// A camera of glTF 2.0, 3.10, seen from a node; with keys in Camera::path when the node or one
// above it is animated. Films are 768 pixels high.
void addCamera(const Import& import, const Hierarchy& hierarchy, size_t node, const Mat4& toWorld);
// KHR_lights_punctual. Candela and lux are taken as W/sr and W/m^2: glTF's emissive surfaces are in
// no other unit than its lights. Lights have no end (`range` is ignored).
void addLight(const Import& import, const Json& node, const Mat4& toWorld);
// Says once in a file that ranges of lights are ignored.
void informOfRanges(const Import& import);

}  // namespace lobelia::io::gltf
