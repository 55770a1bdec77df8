// glTF's cameras and lights look along -z with x to the right; ours along +z with x to the left.
// The scale of nodes is taken off both, as the specification says.
#include "lobelia/io/gltf/views.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lobelia/io/spot_falloff.h"

namespace lobelia::io::gltf {
namespace {

constexpr int kFilmHeight = 768;
constexpr double kMaxAspect = 20;
constexpr size_t kMaxKeys = 1 << 16;

Vec3d column(const Mat4& m, size_t c) { return {m.m[0][c], m.m[1][c], m.m[2][c]}; }

// Where something at a node looks along its -z; empty when the node flattens space.
std::optional<Mat4> viewMatrix(const Mat4& toWorld) {
  const Vec3d origin = column(toWorld, 3);
  const Vec3d forward = column(toWorld, 2) * -1.0;
  if (!toWorld.isFinite() || !(length(forward) > 0)) return {};
  return lookAt(origin, origin + normalize(forward), column(toWorld, 1));
}

Mat4 worldAt(const Hierarchy& hierarchy, const std::vector<size_t>& chain, double time) {
  Mat4 world;
  for (const size_t n : chain) {  // from the node upwards
    Pose pose = hierarchy.nodes[n].rest;
    for (const Channel& channel : hierarchy.channels) {
      if (channel.node != n || channel.path == AnimationPath::weights) continue;
      const std::vector<double> v = sample(channel, time);
      pose.matrix.reset();
      if (channel.path == AnimationPath::translation) pose.translation = {v[0], v[1], v[2]};
      if (channel.path == AnimationPath::rotation) pose.rotation = {v[0], v[1], v[2], v[3]};
      if (channel.path == AnimationPath::scale) pose.scale = {v[0], v[1], v[2]};
    }
    world = pose.toParent() * world;
  }
  return world;
}

// Keys at all times of the channels that move the camera; curves get eight to an interval.
std::vector<CameraKey> cameraPath(const Import& import, const Hierarchy& hierarchy, size_t node,
                                  const Mat4& film) {
  std::vector<size_t> chain;
  for (int n = static_cast<int>(node); n >= 0; n = hierarchy.nodes[static_cast<size_t>(n)].parent)
    chain.push_back(static_cast<size_t>(n));
  std::set<float> times;
  for (const Channel& channel : hierarchy.channels) {
    if (std::find(chain.begin(), chain.end(), channel.node) == chain.end() ||
        channel.path == AnimationPath::weights)
      continue;
    const int steps = channel.interpolation == Interpolation::cubicSpline ? 8 : 1;
    for (size_t k = 0; k < channel.times.size(); ++k) {
      times.insert(channel.times[k]);
      for (int s = 1; s < steps && k + 1 < channel.times.size(); ++s)
        times.insert(lerp(channel.times[k], channel.times[k + 1],
                          static_cast<float>(s) / static_cast<float>(steps)));
    }
  }
  std::vector<CameraKey> path;
  for (const float time : times) {
    if (path.size() == kMaxKeys) {
      import.warn(hierarchy.nodes[node].json,
                  fmt::format("its camera has {} keys; only the first {} are kept", times.size(),
                              kMaxKeys));
      break;
    }
    const auto view = viewMatrix(worldAt(hierarchy, chain, static_cast<double>(time)));
    if (view && inverse(*view * film)) path.push_back({time, Transform(*view * film)});
  }
  return path;
}

double requirePositive(const Json& where) {
  const double value = where.number();
  if (!(value > 0)) where.fail(fmt::format("is {}; it must be above 0", value));
  return value;
}

int filmWidth(double aspect) {
  return std::max(1, static_cast<int>(std::lround(kFilmHeight * aspect)));
}

void setClip(const Json& lens, Camera& camera) {
  camera.nearClip = static_cast<float>(lens["znear"].numberWithin(0, 1e30, 1e-2));
  camera.farClip = static_cast<float>(lens["zfar"].numberWithin(0, 1e30, 1e30));
  if (!(camera.farClip > camera.nearClip)) lens["zfar"].fail("must be above znear");
}

// The extension's reference: the square of a ramp in the cosine.
void addSpot(const Import& import, const Json& spot, Emitter& light) {
  const double outer = spot["outerConeAngle"].numberWithin(0, 1.5708, 0.7853981633974483);
  const double inner = spot["innerConeAngle"].numberWithin(0, 1.5708, 0);
  if (!(outer > inner)) spot["outerConeAngle"].fail("must be larger than innerConeAngle");
  const double end = std::cos(outer), start = std::cos(inner);
  shapeSpot(import.scene, light, static_cast<float>(outer), fmt::format("spot-{}-{}", outer, inner),
            [&](double cosine) {
              // Cones that differ by less than cosines can tell have a sharp edge.
              if (!(start > end)) return cosine >= end ? 1.0 : 0.0;
              const double ramp = std::clamp((cosine - end) / (start - end), 0.0, 1.0);
              return ramp * ramp;
            });
}

}  // namespace

void addCamera(const Import& import, const Hierarchy& hierarchy, size_t node, const Mat4& toWorld) {
  const Json nodeJson = hierarchy.nodes[node].json;
  const Json json = import.document.item("cameras", nodeJson["camera"]);
  Camera camera;
  camera.name = json["name"].text("");
  if (camera.name.empty()) camera.name = nodeJson["name"].text("");
  camera.height = kFilmHeight;
  Mat4 film;
  const std::string type = json["type"].text();
  if (type == "perspective") {
    const Json lens = json["perspective"];
    const double yfov = requirePositive(lens["yfov"]);
    if (!(yfov < 3.14159)) lens["yfov"].fail("must be below pi (radians)");
    const Json aspect = lens["aspectRatio"];
    const double ratio = aspect.exists() ? requirePositive(aspect) : 4.0 / 3;
    if (ratio > kMaxAspect || ratio < 1 / kMaxAspect)
      aspect.fail(
          fmt::format("is {}; it must be from {} to {}", ratio, 1 / kMaxAspect, kMaxAspect));
    camera.width = filmWidth(ratio);
    camera.fovX =
        static_cast<float>(2 * std::atan(std::tan(yfov / 2) * camera.width / camera.height));
    setClip(lens, camera);
  } else if (type == "orthographic") {
    const Json lens = json["orthographic"];
    camera.type = CameraType::orthographic;
    const double x = std::abs(lens["xmag"].number()), y = std::abs(lens["ymag"].number());
    if (!(x > 0) || !(y > 0) || x / y > kMaxAspect || y / x > kMaxAspect)
      lens.fail(
          fmt::format("xmag {} and ymag {}; both must be above 0, and none more than {} times "
                      "the other",
                      x, y, kMaxAspect));
    camera.width = filmWidth(x / y);
    film = scaling({x, x, 1});
    setClip(lens, camera);
  } else {
    json["type"].fail(fmt::format("'{}' is unknown; it must be perspective or orthographic{}", type,
                                  suggestion(type, {"perspective", "orthographic"})));
  }
  const std::optional<Mat4> view = viewMatrix(toWorld);
  if (!view || !inverse(*view * film)) {
    import.warn(nodeJson, "its camera is left out: the node's transform flattens space");
    return;
  }
  camera.toWorld = Transform(*view * film);
  camera.path = cameraPath(import, hierarchy, node, film);
  import.scene.cameras.push_back(std::move(camera));
}

void informOfRanges(const Import& import) {
  const Json lights = import.document.root().extension("KHR_lights_punctual")["lights"];
  for (size_t i = 0; i < lights.size(); ++i) {
    const Json range = lights.at(i)["range"];
    if (!range.exists()) continue;
    import.inform(range,
                  "is not used, here and in any other light: light falls off with the square "
                  "of the distance and has no end");
    return;
  }
}

void addLight(const Import& import, const Json& node, const Mat4& toWorld) {
  const Json index = node.extension("KHR_lights_punctual")["light"];
  const Json lights = import.document.root().extension("KHR_lights_punctual")["lights"];
  const Json json = lights.at(index.index(lights.size(), "lights"));
  const std::optional<Mat4> view = viewMatrix(toWorld);
  if (!view || !inverse(*view)) {
    import.warn(node, "its light is left out: the node's transform flattens space");
    return;
  }
  Emitter light;
  light.name = json["name"].text("");
  const Rgb color = json["color"].vector(Rgb(1.f));
  const double intensity = json["intensity"].numberWithin(0, 1e30, 1);
  light.radiance = color * static_cast<float>(intensity);
  light.toWorld = Transform(*view);
  const std::string type = json["type"].text();
  if (type == "directional") {
    light.type = EmitterType::directional;
    light.direction = light.toWorld.vector({0, 0, 1});
  } else if (type == "point") {
    light.type = EmitterType::point;
  } else if (type == "spot") {
    addSpot(import, json["spot"], light);
  } else {
    json["type"].fail(fmt::format("'{}' is unknown; it must be directional, point or spot{}", type,
                                  suggestion(type, {"directional", "point", "spot"})));
  }
  import.scene.emitters.push_back(std::move(light));
}

}  // namespace lobelia::io::gltf
