// The mapping is that of Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using SIMD",
// as PBRT-v4 uses it (Pharr, Jakob, Humphreys 2023, section 3.8.3).
//
// Resampling: the octahedral image has N^2 texels of equal solid angle, the result 2N x N; each of
// its texels is the mean of 4 x 4 directions, looked up without interpolation as PBRT does. Texels
// lie where images over directions have them (path/spherical_image.h, environments and goniometric
// lights alike): column i about (i + 1/2) / 2N of a turn, row j about j / (N - 1) from pole to
// pole.
#include "lobelia/io/pbrt/octahedral.h"

#include <cmath>
#include <numbers>

#include "lobelia/base/parallel.h"

namespace lobelia::io::pbrt {
namespace {

constexpr int kSubsamples = 4;  // per axis

Rgb lookUp(const Image& image, Vec3f d) {
  const Vec2f p = octahedralFromDirection(d);
  const auto n = static_cast<float>(image.width);
  const int x = std::clamp(static_cast<int>(p.x * n), 0, image.width - 1);
  const int y = std::clamp(static_cast<int>(p.y * n), 0, image.height - 1);
  if (image.channels < 3) return Rgb(image.at(x, y, 0));
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

// direction(u, v): of the fractions of the width and of the height.
template <class F>
Image resample(const Image& square, int channels, const F& direction) {
  Image out;
  out.name = square.name;
  out.width = 2 * square.width, out.height = square.height;
  out.channels = channels;
  const auto stride = static_cast<size_t>(out.width) * static_cast<size_t>(channels);
  out.pixels.resize(stride * static_cast<size_t>(out.height));
  const auto cells = static_cast<float>(std::max(out.height - 1, 1));  // from pole to pole
  parallelFor(static_cast<size_t>(out.height), 8, [&](size_t y) {
    const float top = std::max(static_cast<float>(y) - 0.5f, 0.f) / cells;
    const float bottom = std::min(static_cast<float>(y) + 0.5f, cells) / cells;
    for (int x = 0; x < out.width; ++x) {
      Rgb sum;
      float weights = 0;
      for (int i = 0; i < kSubsamples * kSubsamples; ++i) {
        const float du = (static_cast<float>(i % kSubsamples) + 0.5f) / kSubsamples;
        const float dv = (static_cast<float>(i / kSubsamples) + 0.5f) / kSubsamples;
        const float u = (static_cast<float>(x) + du) / static_cast<float>(out.width);
        const float v = top + (bottom - top) * dv;
        const float weight = std::sin(v * kPi);  // solid angle
        sum += lookUp(square, direction(u, v)) * weight;
        weights += weight;
      }
      sum /= weights;
      float* const pixel =
          &out.pixels[y * stride + static_cast<size_t>(x) * static_cast<size_t>(channels)];
      if (channels == 1)
        pixel[0] = (sum.x + sum.y + sum.z) / 3;
      else
        pixel[0] = sum.x, pixel[1] = sum.y, pixel[2] = sum.z;
    }
  });
  return out;
}

}  // namespace

Vec2f octahedralFromDirection(Vec3f d) {
  const float x = std::abs(d.x), y = std::abs(d.y), z = std::min(std::abs(d.z), 1.f);
  const float r = std::sqrt(1 - z);
  const float phi = (x == 0 && y == 0) ? 0.f : std::atan2(y, x) * (2 * kInvPi);
  float v = phi * r, u = r - v;
  if (d.z < 0) {  // the lower hemisphere lies in the corners
    std::swap(u, v);
    u = 1 - u, v = 1 - v;
  }
  return {0.5f * (std::copysign(u, d.x) + 1), 0.5f * (std::copysign(v, d.y) + 1)};
}

Vec3f directionFromOctahedral(Vec2f p) {
  const float u = 2 * p.x - 1, v = 2 * p.y - 1;
  const float up = std::abs(u), vp = std::abs(v);
  const float inside = 1 - (up + vp);  // below 0 in the corners
  const float r = 1 - std::abs(inside);
  const float phi = (r == 0 ? 1.f : (vp - up) / r + 1) * (kPi / 4);
  const float z = std::copysign(1 - r * r, inside);
  const float s = r * std::sqrt(std::max(0.f, 2 - r * r));
  return {std::copysign(std::cos(phi), u) * s, std::copysign(std::sin(phi), v) * s, z};
}

Image environmentFromOctahedral(const Image& square) {
  return resample(square, 3, [](float u, float v) -> Vec3f {
    const float phi = u * kTwoPi, theta = v * kPi, sine = std::sin(theta);
    return {std::sin(phi) * sine, std::cos(theta), -std::cos(phi) * sine};
  });
}

Image goniometricFromOctahedral(const Image& square) {
  return resample(square, 1, [](float u, float v) -> Vec3f {
    const float phi = u * kTwoPi, theta = v * kPi, sine = std::sin(theta);
    const Vec3f d{std::cos(phi) * sine, std::sin(phi) * sine, std::cos(theta)};
    return {d.x, d.z, d.y};
  });
}

}  // namespace lobelia::io::pbrt
