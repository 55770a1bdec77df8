// Emitters of Mitsuba scenes that are computed or measured: sky, sun and sunsky (0.6 and 3), and
// two of our own: goniometric (an image over directions) and ies (a photometric file).
//
// The sky is ours (io/atmosphere.h), in Mitsuba's units; its parameters are theirs. In 0.6 the
// sky's up is y, north -z and east x; in Mitsuba 3 up is z, south x and west y. A given direction
// to the sun is in world space in both. Sun and sky become two emitters of our scene: an
// environment image and the sun's disc.
#include "lobelia/io/ies_reader.h"
#include "lobelia/io/mitsuba/reader.h"
#include "lobelia/io/sky.h"
#include "lobelia/io/sun_position.h"

namespace lobelia::io::mitsuba {
namespace {

constexpr float kDegree = kPi / 180;
constexpr float kSunAperture = 0.5358f;  // degrees, from limb to limb

int inRange(Object& object, const std::string& name, int otherwise, int least, int most) {
  const int value = object.integer(name, otherwise);
  if (value < least || value > most) {
    throw InputError(object.where(), "the " + name + " is " + std::to_string(value) +
                                         "; it lies between " + std::to_string(least) + " and " +
                                         std::to_string(most));
  }
  return value;
}

float notNegative(Object& object, const std::string& name, float otherwise) {
  const float value = object.number(name, otherwise);
  if (value < 0) throw InputError(object.where(), "the " + name + " is negative");
  return value;
}

PlaceAndTime placeAndTime(Object& object) {
  PlaceAndTime at;
  at.year = inRange(object, "year", at.year, -4000, 9999);
  at.month = inRange(object, "month", at.month, 1, 12);
  at.day = inRange(object, "day", at.day, 1, 31);
  at.hour = object.number("hour").value_or(at.hour);
  at.minute = object.number("minute").value_or(at.minute);
  at.second = object.number("second").value_or(at.second);
  at.latitude = object.number("latitude").value_or(at.latitude);
  at.longitude = object.number("longitude").value_or(at.longitude);
  at.timezone = object.number("timezone").value_or(at.timezone);
  if (!(std::abs(at.latitude) <= 90)) {
    throw InputError(object.where(), "the latitude lies between -90 and 90 degrees");
  }
  return at;
}

// Mitsuba's sky axes from ours (x east, y up, z south where time and place are given).
Mat4 skyAxes(bool legacy) {
  if (legacy) return {};
  return Mat4{{{{0, 0, 1, 0}, {-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}}};
}

}  // namespace

bool Reader::isComputedSky(Object& object) {
  const std::string& type = object.type();
  return type == "sky" || type == "sunsky" || (type == "sun" && !object.has("irradiance"));
}

void Reader::sunAndSky(Object& object) {
  const bool hasSun = object.type() != "sky", hasSky = object.type() != "sun";
  const std::optional<Mat4> matrix = object.transform("to_world");
  const Transform toWorld =
      makeTransform((matrix ? *matrix : Mat4()) * skyAxes(object.legacy()), object.where());
  SkySettings settings;
  settings.turbidity = object.number("turbidity").value_or(3);
  settings.albedo = constantColor(object, "albedo", Rgb(object.legacy() ? 0.15f : 0.3f),
                                  SpectrumUse::reflectance);
  settings.stretch = object.number("stretch").value_or(1);
  settings.width = object.integer("resolution", settings.width);
  if (!hasSky) settings.width = 8;  // the sun alone needs no image
  if (object.boolean("extend", false)) settings.below = BelowHorizon::extended;
  if (const std::optional<Vec3d> d = object.vector("sun_direction")) {
    const Vec3f local = toWorld.from.vector(
        {static_cast<float>(d->x), static_cast<float>(d->y), static_cast<float>(d->z)});
    settings.sun = {double{local.x}, double{local.y}, double{local.z}};
  } else {
    settings.sun = sunDirection(placeAndTime(object));
  }
  const float scale = notNegative(object, "scale", 1);
  const float skyScale = hasSky ? notNegative(object, "sky_scale", scale) : 0;
  const float sunScale = hasSun ? notNegative(object, "sun_scale", scale) : 0;
  const float radiusScale = hasSun ? notNegative(object, "sun_radius_scale", 1) : 1;
  const float aperture = hasSun ? notNegative(object, "sun_aperture", kSunAperture) : kSunAperture;
  if (aperture * radiusScale >= 180) {
    throw InputError(object.where(), "the sun's disc fills half of the sky; make it smaller");
  }
  const std::string group = object.string("group").value_or("");
  const Sky sky = makeSky(settings, object.where());
  const auto finish = [&](Emitter emitter) {
    if (!object.id().empty()) emitter.name = object.id();
    emitter.group = group;
    add(std::move(emitter), object.where());
  };
  if (skyScale > 0) {
    Emitter emitter = skyEmitter(scene_, sky.image, toWorld);
    emitter.scale = skyScale;
    finish(std::move(emitter));
  }
  if (sunScale > 0 && maxComponent(sky.sunIrradiance) > 0) {
    Emitter emitter = sunEmitter(sky, toWorld);
    emitter.radiance.value *= sunScale;
    emitter.angularRadius = 0.5f * aperture * radiusScale * kDegree;
    finish(std::move(emitter));
  } else if (sunScale > 0) {
    findings_.warn(object.where(), "the sun has set: it gives no light");
  }
}

Emitter Reader::goniometric(Object& object) {
  Emitter e;
  e.type = EmitterType::goniometric;
  if (const std::optional<Mat4> matrix = object.transform("to_world")) {
    e.toWorld = makeTransform(*matrix, object.where());
  }
  e.scale = notNegative(object, "scale", 1);
  e.radiance = color(object, "intensity", Rgb(1.f), SpectrumUse::emission);
  const std::optional<std::string> file = object.string("filename");
  if (!file) throw InputError(object.where(), "the " + object.type() + " has no filename");
  if (object.type() == "ies") {
    e.image = photometry(*file, object.where());
    const Mat4 turn = rotation({0, 0, 1}, iesTurn(scene_[e.image]));
    e.toWorld = makeTransform(e.toWorld.to * turn, object.where());
  } else {
    e.image = image(*file, false, std::max(object.number("gamma", 0.f), 0.f), object.where());
  }
  return e;
}

ImageHandle Reader::photometry(const std::string& file, const Location& where) {
  const std::string path = document_.resolve(file, where);
  const std::string key = path + "|ies";
  if (const auto known = images_.find(key); known != images_.end()) return known->second;
  std::vector<Finding> warnings;
  const IesPhotometry measured = readIes(path, where, warnings);
  findings_.add(warnings);
  scene_.images.push_back(iesImage(measured, path));
  const ImageHandle handle{static_cast<uint32_t>(scene_.images.size() - 1)};
  images_.emplace(key, handle);
  return handle;
}

}  // namespace lobelia::io::mitsuba
