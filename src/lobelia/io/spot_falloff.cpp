#include "lobelia/io/spot_falloff.h"

#include <cmath>

namespace lobelia::io {
namespace {

constexpr int kPicture = 512, kRows = 4096;

double centre(int i, int count) { return (i + 0.5) / count; }

ImageHandle add(Scene& scene, Image image) {
  scene.images.push_back(std::move(image));
  return {static_cast<uint32_t>(scene.images.size() - 1)};
}

TextureHandle sharedPicture(const Scene& scene, float cutoff, const std::string& name) {
  for (const Emitter& other : scene.emitters) {
    if (other.type != EmitterType::spot || other.cutoff != cutoff || !other.pattern.valid())
      continue;
    const ImageHandle image = scene[other.pattern].image;
    if (image.valid() && scene[image].name == name) return other.pattern;
  }
  return {};
}

Image rows(const std::string& name, const SpotFalloff& falloff) {
  Image image;
  image.name = name;
  image.width = 1, image.height = kRows, image.channels = 1;
  for (int y = 0; y < kRows; ++y)  // the first and the last are the poles
    image.pixels.push_back(
        static_cast<float>(falloff(std::cos(y * static_cast<double>(kPi) / (kRows - 1)))));
  return image;
}

Image tangentPlane(const std::string& name, double cutoff, const SpotFalloff& falloff) {
  Image image;
  image.name = name;
  image.width = image.height = kPicture, image.channels = 1;
  const double edge = std::tan(cutoff);
  for (int y = 0; y < kPicture; ++y) {
    for (int x = 0; x < kPicture; ++x) {
      const double tangent =
          edge * std::hypot(2 * centre(x, kPicture) - 1, 2 * centre(y, kPicture) - 1);
      image.pixels.push_back(static_cast<float>(falloff(1 / std::sqrt(1 + tangent * tangent))));
    }
  }
  return image;
}

}  // namespace

void shapeSpot(Scene& scene, Emitter& light, float cutoff, const std::string& name,
               const SpotFalloff& falloff) {
  if (cutoff > kWidestSpot) {
    light.type = EmitterType::goniometric;
    light.image = add(scene, rows(name, falloff));
    return;
  }
  light.type = EmitterType::spot;
  light.cutoff = light.beamWidth = cutoff;
  light.pattern = sharedPicture(scene, cutoff, name);
  if (light.pattern.valid()) return;
  Texture texture;
  texture.type = TextureType::bitmap;
  texture.wrapU = texture.wrapV = Wrap::clamp;
  texture.image = add(scene, tangentPlane(name, static_cast<double>(cutoff), falloff));
  scene.textures.push_back(std::move(texture));
  light.pattern = {static_cast<uint32_t>(scene.textures.size() - 1)};
}

}  // namespace lobelia::io
