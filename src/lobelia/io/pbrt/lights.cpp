// Lights that are no surfaces.
//
// Levels. PBRT divides a light's scale by the photometric value of its spectrum, so that any light
// has Y = scale; of an rgb it divides by that of the colour space's illuminant, so that L = (1, 1,
// 1) is a pixel of (1, 1, 1). `power` and `illuminance` are photometric too. PBRT reckons a map's
// illuminance on its upper side with 2 pi over the number of all pixels, where those pixels' solid
// angle is 4 pi over it: a map gives twice the illuminance asked for, there and so here.
//
// Differences: a spot's smooth step in the cosine is a picture on our spot's tangent plane, or a
// goniometric light when it is wider than that allows. PBRT's projection light gives the intensity
// of a direction, ours the irradiance of the picture plane: the picture is multiplied by the cosine
// cubed. Of several infinite lights uniform ones are added up.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/base/frame.h"
#include "lobelia/io/image_io.h"
#include "lobelia/io/pbrt/octahedral.h"
#include "lobelia/io/pbrt/reader.h"
#include "lobelia/io/spot_falloff.h"

namespace lobelia::io::pbrt {
namespace {

constexpr float kDegree = kPi / 180;
constexpr int kMinProjection = 256;
constexpr int kMaxOctahedral = 8192;

// From +z to the direction, about the origin, then to the place.
Mat4 facing(Vec3d from, Vec3d to, const Location& where) {
  const Vec3d d = to - from;
  if (!(lengthSquared(d) > 0)) throw InputError(where, "'from' and 'to' are the same point");
  const Vec3d z = normalize(d);
  const Vec3d across = std::abs(z.x) > std::abs(z.y) ? Vec3d(0, 1, 0) : Vec3d(1, 0, 0);
  const Vec3d x = normalize(cross(across, z)), y = cross(z, x);
  Mat4 m;
  m.m[0] = {x.x, y.x, z.x, from.x};
  m.m[1] = {x.y, y.y, z.y, from.y};
  m.m[2] = {x.z, y.z, z.z, from.z};
  return m;
}

float smoothStep(float x, float a, float b) {
  if (a == b) return x < a ? 0.f : 1.f;
  const float t = std::clamp((x - a) / (b - a), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

Rgb pixel(const Image& image, int x, int y) {
  if (image.channels < 3) return Rgb(image.at(x, y, 0));
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

// value(x, y, rgb) summed over the image, over the number of its pixels.
template <class F>
double meanOf(const Image& image, const F& value) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      sum += static_cast<double>(value(x, y, pixel(image, x, y)));
  return sum / (static_cast<double>(image.width) * image.height);
}

Vec2f centre(const Image& image, int x, int y) {
  return {(static_cast<float>(x) + 0.5f) / static_cast<float>(image.width),
          (static_cast<float>(y) + 0.5f) / static_cast<float>(image.height)};
}

}  // namespace

Rgb Reader::lightColor(Parameters& in, const std::string& name) {
  const float scale = in.number("scale", 1.f);
  if (!(scale >= 0)) throw InputError(in.where(), "the light's scale is below 0");
  // Without a spectrum: the white of the colour space.
  Rgb white = state_.colorSpace.toSrgb(Rgb(1.f));
  return color(in, name, SpectrumUse::emission).value_or(white) * scale;
}

EmitterHandle Reader::add(Emitter emitter) {
  scene_.emitters.push_back(std::move(emitter));
  return {static_cast<uint32_t>(scene_.emitters.size() - 1)};
}

void Reader::lightSource(const Token& token) {
  const std::string type = quoted(token, "type");
  Parameters in = parameters(token, "light");
  if (type == "infinite") {
    infiniteLight(in);
  } else if (type == "point") {
    add(pointLight(in));
  } else if (type == "distant") {
    add(distantLight(in));
  } else if (type == "spot") {
    add(spotLight(in));
  } else if (type == "goniometric") {
    add(goniometricLight(in));
  } else if (type == "projection") {
    add(projectionLight(in));
  } else {
    throw InputError(token.where, unknownName("light", type,
                                              {"point", "distant", "spot", "goniometric",
                                               "projection", "infinite"}));
  }
  in.finish(fmt::format("light '{}'", type), findings_);
}

Emitter Reader::pointLight(Parameters& in) {
  Emitter e;
  e.type = EmitterType::point;
  Rgb intensity = lightColor(in, "I");
  if (const float power = in.number("power", -1.f); power > 0) intensity *= power / (4 * kPi);
  e.radiance = intensity;
  e.toWorld = placement(state_.ctm * translation(in.point("from", {})), in.where());
  return e;
}

Emitter Reader::distantLight(Parameters& in) {
  Emitter e;
  e.type = EmitterType::directional;
  Rgb irradiance = lightColor(in, "L");
  if (const float lux = in.number("illuminance", -1.f); lux > 0) irradiance *= lux;
  e.radiance = irradiance;
  const Vec3d from = in.point("from", {}), to = in.point("to", {0, 0, 1});
  e.toWorld = placement(state_.ctm * facing(from, to, in.where()), in.where());
  e.direction = normalize(e.toWorld.vector({0, 0, 1}));
  return e;
}

Emitter Reader::spotLight(Parameters& in) {
  Emitter e;
  Rgb intensity = lightColor(in, "I");
  const float cone = in.number("coneangle", 30.f), delta = in.number("conedeltaangle", 5.f);
  if (!(cone > 0 && cone <= 180 && delta >= 0))
    throw InputError(in.where(),
                     "the spot's angles are impossible; 0 < coneangle <= 180, 0 <= conedeltaangle");
  const float cosEnd = std::cos(cone * kDegree), cosStart = std::cos((cone - delta) * kDegree);
  if (const float power = in.number("power", -1.f); power > 0)
    intensity *= power / (kTwoPi * ((1 - cosStart) + (cosStart - cosEnd) / 2));
  e.radiance = intensity;
  e.toWorld = placement(
      state_.ctm * facing(in.point("from", {}), in.point("to", {0, 0, 1}), in.where()), in.where());
  // A delta of more than twice the cone turns PBRT's step around: dark in the cone, lit outside.
  const float cutoff = delta > 2 * cone ? kPi : cone * kDegree;
  if (delta == 0 && cutoff <= kWidestSpot) {
    e.type = EmitterType::spot;
    e.cutoff = e.beamWidth = cutoff;
    return e;
  }
  shapeSpot(scene_, e, cutoff, fmt::format("spot-{}-{}", cone, delta), [&](double cosine) {
    return static_cast<double>(smoothStep(static_cast<float>(cosine), cosEnd, cosStart));
  });
  return e;
}

Image Reader::squareImage(const std::string& file, const Location& where) {
  Image image = readImage(resolve(file, "image", where), {}, where);
  if (image.width != image.height)
    throw InputError(where, fmt::format("'{}' has {} x {} pixels; PBRT-v4's images of directions "
                                        "are square (equal-area octahedral)",
                                        file, image.width, image.height));
  if (image.width > kMaxOctahedral)
    throw InputError(where, fmt::format("'{}' is {} pixels wide; at most {} are read", file,
                                        image.width, kMaxOctahedral));
  for (float& v : image.pixels) v = std::max(v, 0.f);
  return image;
}

Emitter Reader::goniometricLight(Parameters& in) {
  Emitter e;
  e.type = EmitterType::goniometric;
  Rgb intensity = lightColor(in, "I");
  const float power = in.number("power", -1.f);
  e.toWorld = placement(state_.ctm, in.where());
  double mean = 1;
  if (const std::optional<std::string> file = in.string("filename")) {
    const Image image = squareImage(*file, in.where());
    mean = meanOf(image, [](int, int, Rgb c) { return (c.x + c.y + c.z) / 3; });
    scene_.images.push_back(goniometricFromOctahedral(image));
    e.image = {static_cast<uint32_t>(scene_.images.size() - 1)};
  } else {
    findings_.warn(in.where(), "the goniometric light has no filename; it shines evenly");
    e.type = EmitterType::point;
  }
  if (power > 0 && mean > 0) intensity *= power / (4 * kPi * static_cast<float>(mean));
  e.radiance = intensity;
  return e;
}

Emitter Reader::projectionLight(Parameters& in) {
  Emitter e;
  e.type = EmitterType::projector;
  const std::optional<std::string> file = in.string("filename");
  if (!file) throw InputError(in.where(), "the projection light has no filename");
  Image source = readImage(resolve(*file, "image", in.where()), {}, in.where());
  const float fov = in.number("fov", 90.f);
  if (!(fov > 0 && fov < 180)) throw InputError(in.where(), "fov lies between 0 and 180");
  // Small pictures are enlarged: PBRT shows their pixels as squares.
  const int factor = std::max(1, (kMinProjection + std::min(source.width, source.height) - 1) /
                                     std::min(source.width, source.height));
  const float aspect = static_cast<float>(source.width) / static_cast<float>(source.height);
  const float shorter = std::tan(0.5f * fov * kDegree);
  const float tanX = aspect > 1 ? shorter * aspect : shorter;
  const float tanY = aspect > 1 ? shorter : shorter / aspect;
  Image picture;
  picture.name = source.name;
  picture.width = source.width * factor, picture.height = source.height * factor;
  const auto cosCubed = [&](Vec2f uv) {
    const float x = (2 * uv.x - 1) * tanX, y = (2 * uv.y - 1) * tanY;
    return std::pow(1 + x * x + y * y, -1.5f);
  };
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      const Rgb c = max(pixel(source, x / factor, y / factor), Rgb(0.f)) *
                    (cosCubed(centre(picture, x, y)) * kInvPi);
      picture.pixels.insert(picture.pixels.end(), {c.x, c.y, c.z});
    }
  }
  e.scale = in.number("scale", 1.f);
  if (const float power = in.number("power", -1.f); power > 0) {
    const float area = 4 * tanX * tanY;
    const double mean = meanOf(
        source, [&](int x, int y, Rgb c) { return luminance(c) * cosCubed(centre(source, x, y)); });
    if (mean > 0) e.scale *= power / (area * static_cast<float>(mean));
  }
  scene_.images.push_back(std::move(picture));
  Texture t;
  t.type = TextureType::bitmap;
  t.wrapU = t.wrapV = Wrap::clamp;
  t.image = {static_cast<uint32_t>(scene_.images.size() - 1)};
  e.radiance = add(std::move(t));
  e.fov = 2 * std::atan(tanX);
  // Our projector's x runs to the left.
  e.toWorld = placement(state_.ctm * scaling({-1, 1, 1}), in.where());
  return e;
}

void Reader::infiniteLight(Parameters& in) {
  in.unsupported("portal", "light comes through all openings", findings_);
  Emitter e;
  e.toWorld = placement(state_.ctm, in.where());
  const float lux = in.number("illuminance", -1.f);
  const std::optional<std::string> file = in.string("filename");
  if (!file) {
    e.type = EmitterType::constant;
    Rgb radiance = lightColor(in, "L");
    if (lux > 0) radiance *= lux * kInvPi;
    e.radiance = radiance;
    return addEnvironment(std::move(e), in.where());
  }
  if (in.has("L"))
    throw InputError(in.where(), "the infinite light has both L and filename; give one of them");
  e.type = EmitterType::environment;
  e.scale = in.number("scale", 1.f);
  if (!(e.scale >= 0)) throw InputError(in.where(), "the light's scale is below 0");
  const Image image = squareImage(*file, in.where());
  if (lux > 0) {
    // As PBRT reckons (see above).
    const double mean = meanOf(image, [&](int x, int y, Rgb c) {
      return luminance(c) * std::max(0.f, directionFromOctahedral(centre(image, x, y)).z);
    });
    if (mean > 0) e.scale *= lux / (kTwoPi * static_cast<float>(mean));
  }
  scene_.images.push_back(environmentFromOctahedral(image));
  e.image = {static_cast<uint32_t>(scene_.images.size() - 1)};
  addEnvironment(std::move(e), in.where());
}

// A scene of ours has one environment.
void Reader::addEnvironment(Emitter emitter, const Location& where) {
  emitter.name = "infinite";
  if (!environment_.valid()) {
    environment_ = add(std::move(emitter));
    return;
  }
  Emitter& first = scene_.emitters[environment_.index];
  const bool isImage = emitter.type == EmitterType::environment;
  if (isImage && first.type == EmitterType::environment) {
    return findings_.warn(where,
                          "a second infinite light with an image is not supported; it is "
                          "left out");
  }
  if (isImage) std::swap(first, emitter);
  if (first.type == EmitterType::constant) {
    first.radiance.value += emitter.radiance.value;
    return;
  }
  if (!(first.scale > 0)) {
    first = emitter;
    return;
  }
  Image& image = scene_.images[first.image.index];
  for (size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] += emitter.radiance.value[static_cast<int>(i % 3)] / first.scale;
}

}  // namespace lobelia::io::pbrt
