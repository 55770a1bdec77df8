#include "lobelia/builtin/environment.h"

#include <cmath>

#include "lobelia/base/parallel.h"

namespace lobelia::builtin {
namespace {

// What is left of a lamp's radiance in direction d: a rectangle with soft edges, square to `to`
// (unit), of half sizes across and along at distance 1.
float softBox(Vec3f d, Vec3f to, float halfX, float halfY) {
  const float z = dot(d, to);
  if (z <= 0) return 0;
  const Vec3f side = normalize(cross(std::abs(to.y) < 0.9f ? Vec3f(0, 1, 0) : Vec3f(1, 0, 0), to));
  const float x = std::abs(dot(d, side)) / z, y = std::abs(dot(d, cross(to, side))) / z;
  const auto edge = [](float at, float half) {
    return std::clamp((half - at) / (0.12f * half) + 0.5f, 0.f, 1.f);
  };
  // A lamp is brightest in its middle.
  return edge(x, halfX) * edge(y, halfY) * (1 - 0.35f * (sqr(x / halfX) + sqr(y / halfY)) / 2);
}

Rgb studioRadiance(Vec3f d) {
  const float up = 0.5f + 0.5f * d.y;
  Rgb c = lerp(Rgb(0.10f, 0.095f, 0.09f), Rgb(0.26f, 0.28f, 0.31f), up * up);
  c += Rgb(13.f, 12.4f, 11.6f) * softBox(d, normalize(Vec3f(0.15f, 1, 0.1f)), 0.75f, 0.40f);
  c += Rgb(9.f, 9.4f, 10.f) * softBox(d, normalize(Vec3f(-1, 0.45f, 0.5f)), 0.30f, 0.55f);
  c += Rgb(8.f, 6.4f, 4.8f) * softBox(d, normalize(Vec3f(0.9f, 0.35f, -0.6f)), 0.07f, 0.55f);
  return c;
}

}  // namespace

Image environmentImage(int height, const Radiance& radiance, std::string name) {
  Image image;
  image.name = std::move(name);
  image.height = height, image.width = 2 * height, image.channels = 3;
  image.pixels.resize(static_cast<size_t>(image.width * height * 3));
  parallelFor(static_cast<size_t>(height), 4, [&](size_t y) {
    for (int x = 0; x < image.width; ++x) {
      Rgb sum;
      constexpr int kSub = 3;  // samples along a pixel's side
      for (int s = 0; s < kSub * kSub; ++s) {
        const float u = (static_cast<float>(x) + (static_cast<float>(s % kSub) + 0.5f) / kSub) /
                        static_cast<float>(image.width);
        const float v = (static_cast<float>(y) + (static_cast<float>(s / kSub) + 0.5f) / kSub) /
                        static_cast<float>(height);
        const float phi = kTwoPi * u, theta = kPi * v;
        sum += radiance(
            {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)});
      }
      const size_t at = (y * static_cast<size_t>(image.width) + static_cast<size_t>(x)) * 3;
      for (int c = 0; c < 3; ++c) image.pixels[at + static_cast<size_t>(c)] = sum[c] / (3 * 3);
    }
  });
  return image;
}

void addEnvironment(SceneBuilder& scene, Image image, double degrees, std::string name) {
  Emitter light;
  light.type = EmitterType::environment;
  light.image = scene.add(std::move(image));
  light.toWorld = Transform(rotation({0, 1, 0}, degrees));
  scene.add(light, std::move(name));
}

void addStudioLight(SceneBuilder& scene, double degrees) {
  addEnvironment(scene, environmentImage(256, studioRadiance, "studio-light"), degrees, "studio");
}

}  // namespace lobelia::builtin
