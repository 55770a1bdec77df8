// Animations sampled at a time (glTF 2.0, 3.11 and appendix C: interpolation modes).
//
// glTF does not say which of several animations plays. All play, from time 0 on; where two drive
// the same property of a node, the first does.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lobelia/io/gltf/nodes.h"

namespace lobelia::io::gltf {
namespace {

// Morph weights of the mesh that a node shows.
size_t morphTargetCount(const Document& document, const Json& node) {
  const Json mesh = node["mesh"];
  if (!mesh.exists()) return 0;
  const Json primitives = document.item("meshes", mesh)["primitives"];
  return primitives.size() > 0 ? primitives.at(0)["targets"].size() : 0;
}

AnimationPath pathOf(const Json& where) {
  const std::string name = where.text();
  if (name == "translation") return AnimationPath::translation;
  if (name == "rotation") return AnimationPath::rotation;
  if (name == "scale") return AnimationPath::scale;
  if (name == "weights") return AnimationPath::weights;
  where.fail(fmt::format("'{}' is unknown; it must be translation, rotation, scale or weights{}",
                         name, suggestion(name, {"translation", "rotation", "scale", "weights"})));
}

Interpolation interpolationOf(const Json& where) {
  const std::string name = where.text("LINEAR");
  if (name == "LINEAR") return Interpolation::linear;
  if (name == "STEP") return Interpolation::step;
  if (name == "CUBICSPLINE") return Interpolation::cubicSpline;
  where.fail(fmt::format("'{}' is unknown; it must be LINEAR, STEP or CUBICSPLINE{}", name,
                         suggestion(name, {"LINEAR", "STEP", "CUBICSPLINE"})));
}

Channel readChannel(Document& document, const Json& json, const Json& samplers,
                    const std::vector<Node>& nodes) {
  Channel channel;
  channel.node = json["target"]["node"].index(nodes.size(), "nodes");
  channel.path = pathOf(json["target"]["path"]);
  const Json sampler = samplers.at(json["sampler"].index(samplers.size(), "samplers"));
  channel.interpolation = interpolationOf(sampler["interpolation"]);
  channel.times = readFloats(document, sampler["input"], "SCALAR").values;
  if (channel.times.empty()) sampler["input"].fail("has no keys; it needs one");
  for (size_t k = 1; k < channel.times.size(); ++k)
    if (!(channel.times[k] > channel.times[k - 1]))
      sampler["input"].fail(fmt::format("time {} is not later than the one before", k));
  const bool rotates = channel.path == AnimationPath::rotation;
  const bool morphs = channel.path == AnimationPath::weights;
  FloatArray output = readFloats(document, sampler["output"],
                                 rotates  ? "VEC4"
                                 : morphs ? "SCALAR"
                                          : "VEC3");
  channel.components =
      morphs ? morphTargetCount(document, nodes[channel.node].json) : output.components;
  const size_t perKey =
      channel.components * (channel.interpolation == Interpolation::cubicSpline ? 3 : 1);
  if (output.values.size() != channel.times.size() * perKey)
    sampler["output"].fail(fmt::format("{} numbers for {} keys; there must be {} a key",
                                       output.values.size(), channel.times.size(), perKey));
  channel.values = std::move(output.values);
  return channel;
}

void normalizeQuaternion(std::vector<double>& q) {
  double n2 = 0;
  for (const double v : q) n2 += v * v;
  if (!(n2 > 0)) {
    q = {0, 0, 0, 1};
    return;
  }
  for (double& v : q) v /= std::sqrt(n2);
}

// Spherical linear interpolation along the shorter arc.
std::vector<double> slerp(std::vector<double> a, std::vector<double> b, double t) {
  normalizeQuaternion(a), normalizeQuaternion(b);
  double cosine = 0;
  for (size_t i = 0; i < 4; ++i) cosine += a[i] * b[i];
  const double sign = cosine < 0 ? -1 : 1;
  cosine = std::min(std::abs(cosine), 1.0);
  const double angle = std::acos(cosine), sine = std::sin(angle);
  const double wa = sine > 1e-6 ? std::sin((1 - t) * angle) / sine : 1 - t;
  const double wb = sign * (sine > 1e-6 ? std::sin(t * angle) / sine : t);
  std::vector<double> q(4);
  for (size_t i = 0; i < 4; ++i) q[i] = wa * a[i] + wb * b[i];
  normalizeQuaternion(q);
  return q;
}

}  // namespace

std::vector<Channel> readChannels(const Import& import, const std::vector<Node>& nodes) {
  std::vector<Channel> channels;
  std::set<std::pair<size_t, AnimationPath>> driven;
  const Json animations = import.document.root()["animations"];
  for (size_t a = 0; a < animations.size(); ++a) {
    const Json items = animations.at(a)["channels"];
    size_t overruled = 0;
    for (size_t c = 0; c < items.size(); ++c) {
      const Json item = items.at(c);
      if (item["target"].extension("KHR_animation_pointer").exists()) continue;
      if (!item["target"]["node"].exists()) continue;  // of an extension, says the specification
      Channel channel = readChannel(import.document, item, animations.at(a)["samplers"], nodes);
      if (driven.emplace(channel.node, channel.path).second) {
        channels.push_back(std::move(channel));
      } else {
        ++overruled;
      }
    }
    if (overruled > 0)
      import.inform(animations.at(a),
                    fmt::format("{} channels drive what an earlier animation drives too; the "
                                "earlier one is shown",
                                overruled));
  }
  return channels;
}

std::vector<double> sample(const Channel& channel, double time) {
  const size_t n = channel.components;
  const bool cubic = channel.interpolation == Interpolation::cubicSpline;
  // part: 0 in-tangent, 1 value, 2 out-tangent (cubic only).
  const auto at = [&](size_t key, size_t part) {
    const size_t begin = cubic ? (key * 3 + part) * n : key * n;
    return std::vector<double>(channel.values.begin() + static_cast<long>(begin),
                               channel.values.begin() + static_cast<long>(begin + n));
  };
  const std::vector<float>& times = channel.times;
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  const bool rotates = channel.path == AnimationPath::rotation;
  std::vector<double> value;
  if (after == times.begin() || after == times.end() ||
      channel.interpolation == Interpolation::step) {
    value = at(after == times.begin() ? 0 : static_cast<size_t>(after - times.begin()) - 1, 1);
    if (rotates) normalizeQuaternion(value);
    return value;
  }
  const auto next = static_cast<size_t>(after - times.begin()), key = next - 1;
  const double interval = double{times[next]} - double{times[key]};
  const double t = (time - double{times[key]}) / interval;
  if (!cubic) {
    if (rotates) return slerp(at(key, 1), at(next, 1), t);
    value = at(key, 1);
    const std::vector<double> second = at(next, 1);
    for (size_t i = 0; i < n; ++i) value[i] += t * (second[i] - value[i]);
    return value;
  }
  const double t2 = t * t, t3 = t2 * t;
  const std::vector<double> v0 = at(key, 1), out = at(key, 2), v1 = at(next, 1), in = at(next, 0);
  value.resize(n);
  for (size_t i = 0; i < n; ++i)
    value[i] = (2 * t3 - 3 * t2 + 1) * v0[i] + interval * (t3 - 2 * t2 + t) * out[i] +
               (3 * t2 - 2 * t3) * v1[i] + interval * (t3 - t2) * in[i];
  if (rotates) normalizeQuaternion(value);
  return value;
}

std::vector<Pose> posesAt(const std::vector<Node>& nodes, const std::vector<Channel>& channels,
                          double time) {
  std::vector<Pose> poses;
  for (const Node& node : nodes) poses.push_back(node.rest);
  for (const Channel& channel : channels) {
    Pose& pose = poses[channel.node];
    const std::vector<double> v = sample(channel, time);
    if (channel.path != AnimationPath::weights) pose.matrix.reset();  // such nodes have none
    switch (channel.path) {
      case AnimationPath::translation:
        pose.translation = {v[0], v[1], v[2]};
        break;
      case AnimationPath::rotation:
        pose.rotation = {v[0], v[1], v[2], v[3]};
        break;
      case AnimationPath::scale:
        pose.scale = {v[0], v[1], v[2]};
        break;
      case AnimationPath::weights:
        pose.weights = v;
        break;
    }
  }
  return poses;
}

}  // namespace lobelia::io::gltf
