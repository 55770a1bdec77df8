// Images and textures: plain data and their evaluation.
#pragma once

#include <string>
#include <vector>

#include "lobelia/base/transform.h"
#include "lobelia/scene/handle.h"

namespace lobelia {

// Scene-linear pixels, row-major, top row first; 1, 3 or 4 (alpha) channels.
struct Image {
  std::string name;  // file it came from
  int width = 0, height = 0, channels = 3;
  std::vector<float> pixels;
  float at(int x, int y, int c) const {
    return pixels[(static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) *
                      static_cast<size_t>(channels) +
                  static_cast<size_t>(c)];
  }
};

enum class Wrap : uint8_t { repeat, mirror, clamp, zero, one };
enum class Filter : uint8_t { nearest, bilinear };
enum class TextureType : uint8_t {
  constant,
  bitmap,
  checkerboard,
  scale,
  meshAttribute,
  product,  // a b
  mix,      // a (1 - c) + b c
  power,    // a^scale
};

// What a texture may depend on at a hit.
struct TextureContext {
  Vec2f uv;
  // mesh attributes interpolated at the hit are looked up by Texture::attribute through these
  const struct Mesh* mesh = nullptr;
  uint32_t triangle = 0;
  Vec2f barycentrics;
};

// A texture evaluates to RGB; scalars use its first channel (or luminance where the source has
// colour). Nested textures are handles.
struct Texture {
  TextureType type = TextureType::constant;
  Rgb value{};        // constant
  ImageHandle image;  // bitmap
  Filter filter = Filter::bilinear;
  Wrap wrapU = Wrap::repeat, wrapV = Wrap::repeat;
  bool alphaChannel = false;  // bitmap used as opacity: read the image's alpha when it has one
  float uvMatrix[2][3] = {{1, 0, 0}, {0, 1, 0}};  // uv' = M (u,v,1)
  int channel = -1;       // bitmap, meshAttribute: only this channel, as grey; -1: colour
  TextureHandle a, b, c;  // checkerboard: its two colours a, b; scale, power: a
  float scale = 1;        // scale: factor; power: exponent
  // meshAttribute: "vertex_color", "face_x"...; bitmap: where uv come from when not empty
  // ("vertex_uv1")
  std::string attribute;
};

// A parameter: a constant, or a texture when `texture` is valid.
struct ColorParam {
  Rgb value{};
  TextureHandle texture;
  ColorParam() = default;
  ColorParam(Rgb v) : value(v) {}              // NOLINT: parameters are given as constants
  ColorParam(TextureHandle t) : texture(t) {}  // NOLINT
};
struct FloatParam {
  float value = 0;
  TextureHandle texture;
  FloatParam() = default;
  FloatParam(float v) : value(v) {}            // NOLINT
  FloatParam(TextureHandle t) : texture(t) {}  // NOLINT
};

struct Scene;
Rgb evaluate(const Scene& scene, TextureHandle texture, const TextureContext& at);
Rgb evaluate(const Scene& scene, const ColorParam& param, const TextureContext& at);
float evaluate(const Scene& scene, const FloatParam& param, const TextureContext& at);
// d(value)/du and d(value)/dv of a scalar texture (bump maps), by the bilinear patch.
Vec2f gradient(const Scene& scene, TextureHandle texture, const TextureContext& at);
// Mean over uv in [0,1)^2 (power of textured emitters, previews).
Rgb mean(const Scene& scene, const ColorParam& param);

}  // namespace lobelia
