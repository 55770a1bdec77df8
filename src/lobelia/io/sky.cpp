#include "lobelia/io/sky.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>

#include "lobelia/base/parallel.h"
#include "lobelia/io/atmosphere.h"
#include "lobelia/scene/camera_path.h"

namespace lobelia::io {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr int kMinWidth = 8, kMaxWidth = 2048;  // there is no finer detail than haze about the sun
constexpr int kMaxAzimuths = 512;               // of half a turn; columns between are interpolated

// What is out of range; "" when nothing is.
std::string problemOf(const SkySettings& s) {
  if (!(s.turbidity >= 1 && s.turbidity <= 10))
    return fmt::format("a turbidity of {:g}; it lies between 1 (no haze) and 10", s.turbidity);
  const double len = lengthSquared(s.sun);
  if (!(len > 0) || !std::isfinite(len))
    return "the direction to the sun must be finite and not zero";
  if (!(minComponent(s.albedo) >= 0 && maxComponent(s.albedo) <= 1))
    return "the ground's albedo must lie between 0 and 1";
  if (!(s.stretch >= 1 && s.stretch <= 2))
    return fmt::format("a stretch of {:g}; it lies between 1 and 2", s.stretch);
  if (s.width < kMinWidth || s.width > kMaxWidth)
    return fmt::format("a resolution of {}; it lies between {} and {}", s.width, kMinWidth,
                       kMaxWidth);
  return "";
}

// One row of the image: interpolated between azimuths from the sun's, of which there are as many
// as columns. The sky is the same on both sides of the sun.
void fillRow(const std::vector<Rgb>& half, double sunAzimuth, Image* image, int y) {
  const double steps = static_cast<double>(half.size() - 1);
  for (int x = 0; x < image->width; ++x) {
    const double azimuth = (x + 0.5) / image->width * 2 * kPiD;
    const double away = std::abs(std::remainder(azimuth - sunAzimuth, 2 * kPiD)) / kPiD * steps;
    const size_t i = std::min(static_cast<size_t>(away), half.size() - 2);
    const Rgb c = lerp(half[i], half[i + 1], static_cast<float>(away - static_cast<double>(i)));
    float* pixel =
        image->pixels.data() +
        (static_cast<size_t>(y) * static_cast<size_t>(image->width) + static_cast<size_t>(x)) * 3;
    pixel[0] = c.x, pixel[1] = c.y, pixel[2] = c.z;
  }
}

Vec3f upOf(const Scene& scene) {
  if (scene.cameras.empty()) return {0, 1, 0};
  const Vec3d up = verticalAxis(scene.cameras[0]);
  return {static_cast<float>(up.x), static_cast<float>(up.y), static_cast<float>(up.z)};
}

// A rotation that takes y to one of the axes.
Mat4 rotationTo(Vec3f up) {
  if (up.x != 0) return rotation({0, 0, 1}, up.x > 0 ? -90 : 90);
  if (up.z != 0) return rotation({1, 0, 0}, up.z > 0 ? 90 : -90);
  return up.y < 0 ? rotation({1, 0, 0}, 180) : Mat4();
}

std::optional<std::array<double, 4>> parseFour(const std::string& text) {
  std::array<double, 4> values{};
  const char* at = text.data();
  const char* const end = at + text.size();
  for (size_t i = 0; i < 4; ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return std::nullopt;
    const auto [next, error] = std::from_chars(at, end, values[i]);
    if (error != std::errc() || !std::isfinite(values[i])) return std::nullopt;
    at = next;
  }
  if (at != end) return std::nullopt;
  return values;
}

}  // namespace

Sky makeSky(const SkySettings& settings, const Location& where) {
  if (const std::string problem = problemOf(settings); !problem.empty())
    throw InputError(where, problem);
  const Vec3d sun = settings.sun / length(settings.sun);
  const double zenith = std::acos(std::clamp(sun.y, -1.0, 1.0));
  const double azimuth = std::atan2(sun.x, -sun.z);
  AtmosphereSettings atmosphereSettings;
  atmosphereSettings.turbidity = settings.turbidity;
  atmosphereSettings.sunElevation = 0.5 * kPiD - zenith;
  atmosphereSettings.albedo = settings.albedo;
  const Atmosphere atmosphere(atmosphereSettings);

  Sky sky;
  const double stretched = std::min(zenith * settings.stretch, kPiD);
  sky.sun = {static_cast<float>(std::sin(stretched) * std::sin(azimuth)),
             static_cast<float>(std::cos(stretched)),
             static_cast<float>(-std::sin(stretched) * std::cos(azimuth))};
  sky.sunIrradiance = atmosphere.sunIrradiance();
  Image& image = sky.image;
  image.name = "sky";
  image.width = settings.width;
  image.height = settings.width / 2 + 1;
  image.channels = 3;
  image.pixels.assign(static_cast<size_t>(image.width) * static_cast<size_t>(image.height) * 3,
                      0.f);

  std::vector<double> azimuths(static_cast<size_t>(std::min(settings.width / 2, kMaxAzimuths)) + 1);
  for (size_t i = 0; i < azimuths.size(); ++i)
    azimuths[i] = static_cast<double>(i) / static_cast<double>(azimuths.size() - 1) * kPiD;
  const auto horizon = atmosphere.radiance(0, azimuths);
  parallelFor(static_cast<size_t>(image.height), 1, [&](size_t y) {
    const double angle = static_cast<double>(y) / (image.height - 1) * kPiD / settings.stretch;
    if (angle <= 0.5 * kPiD * (1 + 1e-12)) {
      fillRow(atmosphere.radiance(std::max(0.0, std::cos(angle)), azimuths), azimuth, &image,
              static_cast<int>(y));
    } else if (settings.below == BelowHorizon::extended) {
      fillRow(horizon, azimuth, &image, static_cast<int>(y));
    } else if (settings.below == BelowHorizon::ground) {
      fillRow({atmosphere.groundRadiance(), atmosphere.groundRadiance()}, azimuth, &image,
              static_cast<int>(y));
    }
  });
  return sky;
}

Emitter skyEmitter(Scene& scene, Image image, const Transform& toWorld) {
  Emitter emitter;
  emitter.type = EmitterType::environment;
  emitter.name = "sky";
  emitter.toWorld = toWorld;
  scene.images.push_back(std::move(image));
  emitter.image = {static_cast<uint32_t>(scene.images.size() - 1)};
  return emitter;
}

Emitter sunEmitter(const Sky& sky, const Transform& toWorld) {
  Emitter emitter;
  emitter.type = EmitterType::sun;
  emitter.name = "sun";
  emitter.radiance = sky.sunIrradiance;
  emitter.direction = normalize(-toWorld.vector(sky.sun));
  return emitter;
}

// Handles of the other emitters stay valid: what is replaced is replaced in its place.
void applySky(Scene& scene, const std::string& text) {
  const auto values = parseFour(text);
  if (!values) {
    throw UsageError(fmt::format(
        "--sky {}: not TURBIDITY,X,Y,Z with the direction to the sun, as in --sky 3,1,2,0.5",
        text));
  }
  const Transform toWorld(rotationTo(upOf(scene)));
  SkySettings settings;
  settings.turbidity = (*values)[0];
  const Vec3f sun =
      toWorld.from.vector({static_cast<float>((*values)[1]), static_cast<float>((*values)[2]),
                           static_cast<float>((*values)[3])});
  settings.sun = {double{sun.x}, double{sun.y}, double{sun.z}};
  settings.below = BelowHorizon::ground;
  const Location where{"--sky " + text, 0, 0};
  if (const std::string problem = problemOf(settings); !problem.empty())
    throw UsageError(fmt::format("--sky {}: {}", text, problem));
  const Sky sky = makeSky(settings, where);

  if (maxComponent(sky.sunIrradiance) <= 0) {
    Finding finding;
    finding.where = where, finding.message = "the sun has set: it gives no light";
    scene.findings.push_back(std::move(finding));
  }
  const auto replace = [&](const Emitter& emitter, auto&& isReplaced) {
    bool placed = false;
    for (Emitter& other : scene.emitters) {
      if (!isReplaced(other.type)) continue;
      Emitter off = emitter;  // of several, the first is replaced and the others are turned off
      if (placed) off.radiance = Rgb(0.f), off.scale = 0;
      other = off;
      placed = true;
    }
    if (!placed) scene.emitters.push_back(emitter);
  };
  replace(skyEmitter(scene, sky.image, toWorld), [](EmitterType type) {
    return type == EmitterType::constant || type == EmitterType::environment;
  });
  replace(sunEmitter(sky, toWorld), [](EmitterType type) { return type == EmitterType::sun; });
}

}  // namespace lobelia::io
