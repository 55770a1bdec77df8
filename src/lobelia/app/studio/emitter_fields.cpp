#include "lobelia/app/studio/emitter_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace lobelia::app {
namespace {

constexpr float kDegree = kPi / 180;
constexpr float kFar = 1e9f;  // of positions

using F = EmitterField;
constexpr EmitterFieldInfo kColor{F::color, "colour", "color", 3};
constexpr EmitterFieldInfo kStrength{F::strength, "strength", "strength", 1, 0, 1e6f, true};
constexpr EmitterFieldInfo kPosition{F::position, "position", "position", 3, -kFar, kFar};
constexpr EmitterFieldInfo kDirection{F::direction, "direction", "direction", 3, -1, 1};
constexpr EmitterFieldInfo kCutoff{F::cutoff, "cone", "cutoff_angle", 1, 0.1f, 90};
constexpr EmitterFieldInfo kBeam{F::beamWidth, "full light within", "beam_width", 1, 0, 90};
constexpr EmitterFieldInfo kFov{F::fieldOfView, "field of view", "fov", 1, 1, 170};
constexpr EmitterFieldInfo kRadius{
    F::angularRadius, "radius of the disc", "angular_radius", 1, 0, 20};

constexpr std::array kLight{kColor, kStrength};
constexpr std::array kPoint{kColor, kStrength, kPosition};
constexpr std::array kGoniometric{kColor, kStrength, kPosition, kDirection};
constexpr std::array kSpot{kColor, kStrength, kPosition, kDirection, kCutoff, kBeam};
constexpr std::array kProjector{kStrength, kPosition, kDirection, kFov};
constexpr std::array kDirectional{kColor, kStrength, kDirection};
constexpr std::array kSun{kColor, kStrength, kDirection, kRadius};
constexpr std::array kEnvironment{kStrength};

bool hasScale(const Emitter& e) {
  return e.type == EmitterType::environment || e.type == EmitterType::projector;
}
bool isDirected(const Emitter& e) {
  return e.type == EmitterType::directional || e.type == EmitterType::sun;
}

Vec3d wide(Vec3f v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

// Its axes, with +z along d.
Transform towards(Vec3f position, Vec3f d) {
  const Vec3d up = std::abs(d.y) < 0.99f ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
  const std::optional<Mat4> matrix = lookAt(wide(position), wide(position) + wide(d), up);
  return matrix ? Transform(*matrix) : Transform(translation(wide(position)));
}

Vec3f positionOf(const Emitter& e) { return e.toWorld.point({0, 0, 0}); }

float strengthOf(const Emitter& e) {
  if (hasScale(e)) return e.scale;
  return std::max({e.radiance.value.x, e.radiance.value.y, e.radiance.value.z, 0.f});
}

float clamped(float value, const EmitterFieldInfo& info) {
  return value >= info.least ? std::min(value, info.most) : info.least;
}

}  // namespace

std::span<const EmitterFieldInfo> emitterFields(EmitterType type) {
  switch (type) {
    case EmitterType::area:
    case EmitterType::constant:
      return kLight;
    case EmitterType::point:
      return kPoint;
    case EmitterType::spot:
      return kSpot;
    case EmitterType::directional:
      return kDirectional;
    case EmitterType::environment:
      return kEnvironment;
    case EmitterType::projector:
      return kProjector;
    case EmitterType::goniometric:
      return kGoniometric;
    case EmitterType::sun:
      return kSun;
  }
  return {};
}

const char* typeWord(EmitterType type) {
  constexpr const char* kWords[] = {"area",   "point",     "spot",        "directional", "constant",
                                    "envmap", "projector", "goniometric", "sun"};
  return kWords[static_cast<size_t>(type)];
}

const EmitterFieldInfo& findEmitterField(EmitterType type, const std::string& word,
                                         const Location& where) {
  std::vector<std::string> words;
  for (const EmitterFieldInfo& info : emitterFields(type)) {
    if (word == info.word) return info;
    words.push_back(info.word);
  }
  throw InputError(where, fmt::format("a light of type {} has no '{}'{}; it has {}", typeWord(type),
                                      word, suggestion(word, words), fmt::join(words, ", ")));
}

Vec3f emitterValue(const Emitter& e, EmitterField field) {
  switch (field) {
    case F::color: {
      const float strength = strengthOf(e);
      return strength > 0 ? e.radiance.value / strength : Rgb(1.f);
    }
    case F::strength:
      return Vec3f(strengthOf(e));
    case F::position:
      return positionOf(e);
    case F::direction:
      return isDirected(e) ? e.direction : normalize(e.toWorld.vector({0, 0, 1}));
    case F::cutoff:
      return Vec3f(e.cutoff / kDegree);
    case F::beamWidth:
      return Vec3f(e.beamWidth / kDegree);
    case F::fieldOfView:
      return Vec3f(e.fov / kDegree);
    case F::angularRadius:
      return Vec3f(e.angularRadius / kDegree);
  }
  return {};
}

void setEmitterValue(Emitter& e, EmitterField field, Vec3f value) {
  for (const EmitterFieldInfo& info : emitterFields(e.type)) {
    if (info.field != field) continue;
    if (!isFinite(value)) return;
    for (int i = 0; i < 3; ++i) value[i] = clamped(value[i], info);
  }
  switch (field) {
    case F::color: {
      const float largest = std::max({value.x, value.y, value.z});
      if (!(largest > 0)) return;  // black: that is a strength of 0
      e.radiance = value * (strengthOf(e) / largest);
      break;
    }
    case F::strength:
      if (hasScale(e)) {
        e.scale = value.x;
      } else {
        // Of no light at all the colour would be lost.
        e.radiance = emitterValue(e, F::color) * std::max(value.x, 1e-20f);
      }
      break;
    case F::position: {
      Mat4 to = e.toWorld.to;
      for (size_t i = 0; i < 3; ++i) to.m[i][3] = static_cast<double>(value[static_cast<int>(i)]);
      e.toWorld = Transform(to);
      break;
    }
    case F::direction: {
      if (!(length(value) > 1e-6f)) return;
      const Vec3f d = normalize(value);
      e.toWorld = towards(positionOf(e), d);
      e.direction = d;
      break;
    }
    case F::cutoff:
      e.cutoff = value.x * kDegree;
      e.beamWidth = std::min(e.beamWidth, e.cutoff);
      break;
    case F::beamWidth:
      e.beamWidth = std::min(value.x * kDegree, e.cutoff);
      break;
    case F::fieldOfView:
      e.fov = value.x * kDegree;
      break;
    case F::angularRadius:
      e.angularRadius = value.x * kDegree;
      break;
  }
}

std::string freeLightName(const Design& design) {
  for (int number = 1;; ++number) {
    std::string name = fmt::format("light{}", number);
    if (std::none_of(design.emitters.begin(), design.emitters.end(),
                     [&](const Emitter& e) { return e.name == name; }))
      return name;
  }
}

Emitter newEmitter(EmitterType type, const std::string& name, Vec3f position, Rgb light) {
  Emitter e;
  e.type = type;
  e.name = name;
  e.radiance = light;
  e.direction = {0, -1, 0};
  e.toWorld = type == EmitterType::spot ? towards(position, e.direction)
                                        : Transform(translation(wide(position)));
  if (isDirected(e)) e.toWorld = towards({}, e.direction);
  return e;
}

}  // namespace lobelia::app
