// The node hierarchy and its animations (glTF 2.0, 3.5 and 3.11).
#pragma once

#include <array>
#include <optional>

#include "lobelia/base/transform.h"
#include "lobelia/io/gltf/accessors.h"
#include "lobelia/io/gltf/import.h"

namespace lobelia::io::gltf {

using Quaternion = std::array<double, 4>;  // x, y, z, w

// Where a node is relative to its parent: a matrix, or translation, rotation and scale.
struct Pose {
  std::optional<Mat4> matrix;
  Vec3d translation;
  Quaternion rotation{0, 0, 0, 1};
  Vec3d scale{1, 1, 1};
  std::vector<double> weights;  // of morph targets; empty: the mesh's
  Mat4 toParent() const;
};
Mat4 rotationMatrix(Quaternion q);  // q need not be of unit length

struct Node {
  Json json;
  int parent = -1;
  std::vector<size_t> children;
  Pose rest;
};

// All nodes. Fails on cycles and on nodes with two parents: the hierarchy is a forest.
std::vector<Node> readNodes(const Document& document);

enum class AnimationPath : uint8_t { translation, rotation, scale, weights };
enum class Interpolation : uint8_t { linear, step, cubicSpline };

struct Channel {
  size_t node = 0;
  AnimationPath path = AnimationPath::translation;
  Interpolation interpolation = Interpolation::linear;
  std::vector<float> times;   // rising
  size_t components = 3;      // of a value
  std::vector<float> values;  // a value a time; cubicSpline: in-tangent, value, out-tangent
};

// The channels of all animations. Where two drive the same property of a node, the first counts.
std::vector<Channel> readChannels(const Import& import, const std::vector<Node>& nodes);
// The value at a time; before the first and after the last key it stands still.
std::vector<double> sample(const Channel& channel, double time);
// The poses of all nodes at a time.
std::vector<Pose> posesAt(const std::vector<Node>& nodes, const std::vector<Channel>& channels,
                          double time);
// Node to world for all nodes.
std::vector<Mat4> worldMatrices(const std::vector<Node>& nodes, const std::vector<Pose>& poses);

}  // namespace lobelia::io::gltf
