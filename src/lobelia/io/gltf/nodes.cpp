#include "lobelia/io/gltf/nodes.h"

#include <fmt/format.h>

namespace lobelia::io::gltf {
namespace {

Vec3d vec3d(const std::vector<double>& v) { return {v[0], v[1], v[2]}; }

Pose restPose(const Json& node) {
  Pose pose;
  if (const Json matrix = node["matrix"]; matrix.exists()) {
    const std::vector<double> v = matrix.numbers(16);  // column by column
    Mat4 m;
    for (size_t r = 0; r < 4; ++r)
      for (size_t c = 0; c < 4; ++c) m.m[r][c] = v[c * 4 + r];
    if (v[3] != 0 || v[7] != 0 || v[11] != 0 || v[15] != 1)
      matrix.fail("its last row must be 0 0 0 1");
    pose.matrix = m;
  }
  if (node["translation"].exists()) pose.translation = vec3d(node["translation"].numbers(3));
  if (node["scale"].exists()) pose.scale = vec3d(node["scale"].numbers(3));
  if (const Json rotation = node["rotation"]; rotation.exists()) {
    const std::vector<double> v = rotation.numbers(4);
    pose.rotation = {v[0], v[1], v[2], v[3]};
    if (!(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3] > 1e-20))
      rotation.fail("is zero; it must be a unit quaternion");
  }
  if (const Json weights = node["weights"]; weights.exists())
    pose.weights = weights.numbers(weights.size());
  return pose;
}

// Every node has at most one parent by now, so that a cycle is a way up that comes back.
void refuseCycles(const std::vector<Node>& nodes) {
  std::vector<size_t> visitedFrom(nodes.size(), nodes.size());
  for (size_t start = 0; start < nodes.size(); ++start) {
    int at = static_cast<int>(start);
    while (at >= 0 && visitedFrom[static_cast<size_t>(at)] == nodes.size()) {
      visitedFrom[static_cast<size_t>(at)] = start;
      at = nodes[static_cast<size_t>(at)].parent;
    }
    if (at >= 0 && visitedFrom[static_cast<size_t>(at)] == start)
      nodes[static_cast<size_t>(at)].json["children"].fail(
          "the node is a descendant of itself; nodes must form trees");
  }
}

}  // namespace

Mat4 rotationMatrix(Quaternion q) {
  const double n2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  const double s = n2 > 0 ? 2 / n2 : 0, x = q[0], y = q[1], z = q[2], w = q[3];
  Mat4 r;
  r.m[0] = {1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w), 0};
  r.m[1] = {s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w), 0};
  r.m[2] = {s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y), 0};
  return r;
}

Mat4 Pose::toParent() const {
  if (matrix) return *matrix;
  return lobelia::translation(translation) * rotationMatrix(rotation) * scaling(scale);
}

std::vector<Node> readNodes(const Document& document) {
  const Json items = document.root()["nodes"];
  std::vector<Node> nodes;
  for (size_t i = 0; i < items.size(); ++i) {
    const Json json = items.at(i);
    nodes.push_back({json, -1, {}, restPose(json)});
  }
  for (size_t i = 0; i < nodes.size(); ++i) {
    const Json children = nodes[i].json["children"];
    for (size_t c = 0; c < children.size(); ++c) {
      const size_t child = children.at(c).index(nodes.size(), "nodes");
      if (nodes[child].parent >= 0)
        children.at(c).fail(
            fmt::format("node {} has a parent already, nodes[{}]; nodes must form "
                        "trees",
                        child, nodes[child].parent));
      nodes[child].parent = static_cast<int>(i);
      nodes[i].children.push_back(child);
    }
  }
  refuseCycles(nodes);
  return nodes;
}

std::vector<Mat4> worldMatrices(const std::vector<Node>& nodes, const std::vector<Pose>& poses) {
  std::vector<Mat4> world(nodes.size());
  std::vector<size_t> open;
  for (size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].parent < 0) open.push_back(i);
  while (!open.empty()) {
    const size_t i = open.back();
    open.pop_back();
    world[i] = poses[i].toParent();
    if (const int parent = nodes[i].parent; parent >= 0)
      world[i] = world[static_cast<size_t>(parent)] * world[i];
    open.insert(open.end(), nodes[i].children.begin(), nodes[i].children.end());
  }
  return world;
}

}  // namespace lobelia::io::gltf
