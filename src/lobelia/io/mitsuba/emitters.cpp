// Emitters of Mitsuba scenes: area, point, spot, directional, constant, envmap, projector; ours:
// sun with its irradiance. Others are in sky_emitters.cpp. `group` names the light group of any of
// them.

#include "lobelia/io/mitsuba/reader.h"

namespace lobelia::io::mitsuba {
namespace {

constexpr float kDegree = kPi / 180;

const std::vector<std::string>& emitterTypes() {
  static const std::vector<std::string> types{
      "area",      "point", "spot", "directional", "constant", "envmap",
      "projector", "sky",   "sun",  "sunsky",      "ies",      "goniometric",
  };
  return types;
}

bool isSurrounding(const Emitter& e) {
  return e.type == EmitterType::constant || e.type == EmitterType::environment;
}

// Sampling weights and the like steer other renderers' sampling only.
void ignoreSampling(Object& object) {
  object.ignore({"sampling_weight", "mis_compensation", "cache", "id"});
}

Transform placement(Object& object) {
  const std::optional<Mat4> matrix = object.transform("to_world");
  return matrix ? makeTransform(*matrix, object.where()) : Transform();
}

void refuseBoth(Object& object, const std::string& name) {
  if (object.has(name) && object.has("to_world")) {
    throw InputError(object.where(), "both " + name + " and to_world are given; give one of them");
  }
}

}  // namespace

EmitterHandle Reader::add(Emitter emitter, const Location& where) {
  if (isSurrounding(emitter)) {
    for (const Emitter& other : scene_.emitters) {
      if (isSurrounding(other)) {
        throw InputError(where, "this is a second environment emitter; a scene can have one");
      }
    }
  }
  scene_.emitters.push_back(std::move(emitter));
  return {static_cast<uint32_t>(scene_.emitters.size() - 1)};
}

EmitterHandle Reader::areaEmitter(const Element& element) {
  if (const auto known = areaEmitters_.find(&element); known != areaEmitters_.end()) {
    return known->second;
  }
  Object object = open(element);
  if (object.type() != "area") {
    throw InputError(object.where(),
                     "the emitter '" + object.type() + "' cannot be a shape's; only 'area' can");
  }
  Emitter e;
  e.type = EmitterType::area;
  e.name = object.id();
  e.radiance = color(object, "radiance", Rgb(1.f), SpectrumUse::emission);
  e.group = object.string("group").value_or("");
  ignoreSampling(object);
  object.finish();
  const EmitterHandle handle = add(std::move(e), object.where());
  areaEmitters_.emplace(&element, handle);
  return handle;
}

void Reader::emitter(const Element& element) {
  Object object = open(element);
  const std::string& type = object.type();
  if (isComputedSky(object)) {
    sunAndSky(object);
    ignoreSampling(object);
    return object.finish();
  }
  Emitter e;
  if (type == "point") {
    e.type = EmitterType::point;
    refuseBoth(object, "position");
    e.toWorld = placement(object);
    if (const std::optional<Vec3d> p = object.vector("position")) {
      e.toWorld = makeTransform(translation(*p), object.where());
    }
    e.radiance = color(object, "intensity", Rgb(1.f), SpectrumUse::emission);
  } else if (type == "spot") {
    e.type = EmitterType::spot;
    e.toWorld = placement(object);
    e.radiance = color(object, "intensity", Rgb(1.f), SpectrumUse::emission);
    const float cutoff = object.number("cutoff_angle", 20.f);
    const float beam = object.number("beam_width", cutoff * 0.75f);
    if (!(cutoff > 0 && cutoff <= 90 && beam >= 0 && beam <= cutoff)) {
      throw InputError(object.where(),
                       "the spot's angles are impossible; 0 <= beam_width <= cutoff_angle <= 90");
    }
    e.cutoff = cutoff * kDegree;
    e.beamWidth = beam * kDegree;
    if (const Element* pattern = object.property("texture")) {
      const ColorParam param = color(*pattern, SpectrumUse::emission);
      if (param.texture.valid()) {
        e.pattern = param.texture;
      } else if (e.radiance.texture.valid()) {
        findings_.warn(pattern->where, "the spot's constant texture is ignored");
      } else {
        e.radiance.value *= param.value;
      }
    }
  } else if (type == "directional") {
    e.type = EmitterType::directional;
    e.toWorld = placement(object);
    e.direction = direction(object);
    e.radiance = color(object, "irradiance", Rgb(1.f), SpectrumUse::emission);
  } else if (type == "sun") {
    e.type = EmitterType::sun;
    e.toWorld = placement(object);
    e.direction = direction(object);
    e.radiance = color(object, "irradiance", Rgb(1.f), SpectrumUse::emission);
    if (const std::optional<double> degrees = object.number("angular_radius")) {
      e.angularRadius = static_cast<float>(*degrees * static_cast<double>(kPi) / 180);
    }
    if (!(e.angularRadius >= 0 && e.angularRadius <= kPi / 2)) {
      throw InputError(object.where(), "the sun's angular radius lies between 0 and 90 degrees");
    }
  } else if (type == "constant") {
    e.type = EmitterType::constant;
    e.radiance = color(object, "radiance", Rgb(1.f), SpectrumUse::emission);
    object.ignore({"to_world"});
  } else if (type == "envmap") {
    e = environment(object);
  } else if (type == "projector") {
    e = projector(object);
  } else if (type == "goniometric" || type == "ies") {
    e = goniometric(object);
  } else if (type == "area") {
    throw InputError(object.where(), "an area emitter belongs inside a shape");
  } else {
    unknownType(object, emitterTypes());
  }
  e.name = object.id();
  e.group = object.string("group").value_or("");
  ignoreSampling(object);
  object.finish();
  add(std::move(e), object.where());
}

// Where a directional emitter's light travels to.
Vec3f Reader::direction(Object& object) {
  refuseBoth(object, "direction");
  if (const std::optional<Vec3d> d = object.vector("direction")) {
    if (lengthSquared(*d) == 0) throw InputError(object.where(), "the direction is zero");
    return normalize(
        Vec3f{static_cast<float>(d->x), static_cast<float>(d->y), static_cast<float>(d->z)});
  }
  return normalize(placement(object).vector({0, 0, 1}));
}

Emitter Reader::environment(Object& object) {
  Emitter e;
  e.type = EmitterType::environment;
  e.toWorld = placement(object);
  e.scale = object.number("scale", 1.f);
  if (e.scale < 0) throw InputError(object.where(), "the envmap's scale is negative");
  const std::optional<std::string> file = object.string("filename");
  if (!file) throw InputError(object.where(), "the envmap has no filename");
  e.image = image(*file, false, std::max(object.number("gamma", 0.f), 0.f), object.where());
  return e;
}

Emitter Reader::projector(Object& object) {
  Emitter e;
  e.type = EmitterType::projector;
  e.toWorld = placement(object);
  e.scale = object.number("scale", 1.f);
  if (!object.has("irradiance")) {
    throw InputError(object.where(), "the projector has no irradiance; give it a texture");
  }
  e.radiance = color(object, "irradiance", Rgb(1.f), SpectrumUse::emission);
  double aspect = 1;
  if (e.radiance.texture.valid()) {
    const Texture& texture = scene_[e.radiance.texture];
    if (texture.type == TextureType::bitmap) {
      aspect = static_cast<double>(scene_[texture.image].width) / scene_[texture.image].height;
    }
  }
  e.fov = fieldOfView(object, aspect);
  return e;
}

}  // namespace lobelia::io::mitsuba
