// Textures, by the rules of Mitsuba 3's plugins bitmap (dr::Texture), checkerboard and
// mesh_attribute.
//
// (u, v) = (0, 0) is the corner of the image's FIRST row and column: Mitsuba's bitmaps do not flip
// v; its OBJ reader does. Texel centres lie at (i + 0.5) / resolution. Wrapping acts on texel
// indices. The modes `zero` and `one` are Mitsuba 0.6's: texels outside the image have that value.
//
// Our own: product, mix and power act on each colour channel; their gradients, which only scalar
// textures need, on what the parts are as scalars. Texture::channel counts r, g, b, alpha from 0: a
// grey image has the same r, g and b, and what has no alpha is opaque (1). A bitmap with an
// `attribute` that a mesh lacks takes the mesh's own uv (validate() warns).
#include "lobelia/scene/texture.h"

#include <cmath>

#include "lobelia/scene/scene.h"

namespace lobelia {
namespace {

Vec2f transformed(const Texture& t, Vec2f uv) {
  return {t.uvMatrix[0][0] * uv.x + t.uvMatrix[0][1] * uv.y + t.uvMatrix[0][2],
          t.uvMatrix[1][0] * uv.x + t.uvMatrix[1][1] * uv.y + t.uvMatrix[1][2]};
}

// Integer part, safe for any float (a texture coordinate that is not finite reads texel 0).
int floorToInt(float x) {
  const float f = std::floor(x);
  return std::abs(f) < 0x1p30f ? static_cast<int>(f) : 0;
}

int positiveModulo(int i, int n) {
  const int r = i % n;
  return r < 0 ? r + n : r;
}

// Index inside the image, or -1 for "outside" in the modes zero and one.
int wrapped(int i, int n, Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat:
      return positiveModulo(i, n);
    case Wrap::mirror: {
      const int r = positiveModulo(i, 2 * n);
      return r < n ? r : 2 * n - 1 - r;
    }
    case Wrap::clamp:
      return std::clamp(i, 0, n - 1);
    case Wrap::zero:
    case Wrap::one:
      break;
  }
  return i < 0 || i >= n ? -1 : i;
}

Rgb texel(const Texture& t, const Image& image, int x, int y) {
  const int i = wrapped(x, image.width, t.wrapU), j = wrapped(y, image.height, t.wrapV);
  if (i < 0 || j < 0) return Rgb((i < 0 ? t.wrapU : t.wrapV) == Wrap::one ? 1.f : 0.f);
  const bool hasAlpha = image.channels == 2 || image.channels == 4;
  if (t.alphaChannel && hasAlpha) return Rgb(image.at(i, j, image.channels - 1));
  if (t.channel >= 3) return Rgb(hasAlpha ? image.at(i, j, image.channels - 1) : 1.f);
  if (t.channel >= 0) return Rgb(image.at(i, j, image.channels < 3 ? 0 : t.channel));
  if (image.channels < 3) return Rgb(image.at(i, j, 0));
  return {image.at(i, j, 0), image.at(i, j, 1), image.at(i, j, 2)};
}

// The four texels around a point and the weights of the second ones.
struct Patch {
  Rgb c00, c10, c01, c11;
  float wx, wy;
};

Patch bilinearPatch(const Texture& t, const Image& image, Vec2f uv) {
  const float x = uv.x * static_cast<float>(image.width) - 0.5f;
  const float y = uv.y * static_cast<float>(image.height) - 0.5f;
  const int i = floorToInt(x), j = floorToInt(y);
  const float wx = x - std::floor(x), wy = y - std::floor(y);
  return {texel(t, image, i, j),         texel(t, image, i + 1, j),  texel(t, image, i, j + 1),
          texel(t, image, i + 1, j + 1), std::isfinite(wx) ? wx : 0, std::isfinite(wy) ? wy : 0};
}

Rgb bitmap(const Texture& t, const Image& image, Vec2f uv) {
  uv = transformed(t, uv);
  if (t.filter == Filter::nearest) {
    return texel(t, image, floorToInt(uv.x * static_cast<float>(image.width)),
                 floorToInt(uv.y * static_cast<float>(image.height)));
  }
  const Patch p = bilinearPatch(t, image, uv);
  return lerp(lerp(p.c00, p.c10, p.wx), lerp(p.c01, p.c11, p.wx), p.wy);
}

bool firstColour(const Texture& t, Vec2f uv) {
  uv = transformed(t, uv);
  return (uv.x - std::floor(uv.x) > 0.5f) == (uv.y - std::floor(uv.y) > 0.5f);
}

const MeshAttribute* findAttribute(const Texture& t, const TextureContext& at) {
  if (!at.mesh || t.attribute.empty()) return nullptr;
  for (const MeshAttribute& a : at.mesh->attributes) {
    if (a.name == t.attribute) return &a;
  }
  return nullptr;
}

Rgb attributeValue(const Texture& t, const MeshAttribute& a, size_t index) {
  const float* const v = &a.values[index * static_cast<size_t>(a.size)];
  if (t.channel >= 3) return Rgb(a.size >= 4 ? v[3] : 1.f);
  if (t.channel >= 0) return Rgb(v[t.channel < a.size ? t.channel : 0]);
  return a.size >= 3 ? Rgb(v[0], v[1], v[2]) : Rgb(v[0]);
}

// A mesh without the attribute gives black (validate() warns).
Rgb attribute(const Texture& t, const TextureContext& at) {
  const MeshAttribute* const a = findAttribute(t, at);
  if (!a) return Rgb(0.f);
  if (a->perFace) return attributeValue(t, *a, at.triangle);
  const Vec3u v = at.mesh->triangles[at.triangle];
  const float b1 = at.barycentrics.x, b2 = at.barycentrics.y;
  return attributeValue(t, *a, v.x) * (1 - b1 - b2) + attributeValue(t, *a, v.y) * b1 +
         attributeValue(t, *a, v.z) * b2;
}

// The attribute that a bitmap takes its uv from, null when it takes the mesh's own.
const MeshAttribute* uvAttribute(const Texture& t, const TextureContext& at) {
  const MeshAttribute* const a = findAttribute(t, at);
  return a && !a->perFace && a->size >= 2 ? a : nullptr;
}

Vec2f attributeUv(const MeshAttribute& a, uint32_t vertex) {
  const float* const v = &a.values[vertex * static_cast<size_t>(a.size)];
  return {v[0], v[1]};
}

Vec2f uvOf(const Texture& t, const TextureContext& at) {
  const MeshAttribute* const a = uvAttribute(t, at);
  if (!a) return at.uv;
  const Vec3u v = at.mesh->triangles[at.triangle];
  const float b1 = at.barycentrics.x, b2 = at.barycentrics.y;
  return attributeUv(*a, v.x) * (1 - b1 - b2) + attributeUv(*a, v.y) * b1 +
         attributeUv(*a, v.z) * b2;
}

// Exact for grey: Mitsuba's eval_1 is the luminance of colour, the value itself of one channel.
float scalar(Rgb c) { return c.x == c.y && c.y == c.z ? c.x : luminance(c); }

// Gradient by uv of what changes by d1 and d2 along the triangle's edges from vertex 0.
Vec2f gradientOfEdges(const TextureContext& at, float d1, float d2) {
  const Vec3u v = at.mesh->triangles[at.triangle];
  if (at.mesh->uvs.empty()) return {d1, d2};
  const Vec2f uv0 = at.mesh->uvs[v.x];
  const Vec2f duv1 = at.mesh->uvs[v.y] - uv0, duv2 = at.mesh->uvs[v.z] - uv0;
  const float det = duv1.x * duv2.y - duv1.y * duv2.x;
  if (det == 0) return {};
  return Vec2f{d1 * duv2.y - d2 * duv1.y, d2 * duv1.x - d1 * duv2.x} * (1 / det);
}

Vec2f attributeGradient(const Texture& t, const TextureContext& at) {
  const MeshAttribute* const a = findAttribute(t, at);
  if (!a || a->perFace) return {};
  const Vec3u v = at.mesh->triangles[at.triangle];
  const float f0 = scalar(attributeValue(t, *a, v.x));
  return gradientOfEdges(at, scalar(attributeValue(t, *a, v.y)) - f0,
                         scalar(attributeValue(t, *a, v.z)) - f0);
}

Vec2f bitmapGradient(const Texture& t, const Image& image, const TextureContext& at) {
  if (t.filter == Filter::nearest) return {};  // as Mitsuba: a staircase has no slope
  const Patch p = bilinearPatch(t, image, transformed(t, uvOf(t, at)));
  const float f00 = scalar(p.c00), f10 = scalar(p.c10), f01 = scalar(p.c01), f11 = scalar(p.c11);
  const float dx =
      ((1 - p.wy) * (f10 - f00) + p.wy * (f11 - f01)) * static_cast<float>(image.width);
  const float dy =
      ((1 - p.wx) * (f01 - f00) + p.wx * (f11 - f10)) * static_cast<float>(image.height);
  // The transpose of the uv matrix carries a gradient back. (Mitsuba 3 multiplies by the
  // resolution after this step instead of before; the same for square images and for matrices
  // without rotation, and what is right otherwise is this.)
  const Vec2f slope{t.uvMatrix[0][0] * dx + t.uvMatrix[1][0] * dy,
                    t.uvMatrix[0][1] * dx + t.uvMatrix[1][1] * dy};
  const MeshAttribute* const own = uvAttribute(t, at);
  if (!own) return slope;
  const Vec3u v = at.mesh->triangles[at.triangle];
  const Vec2f uv0 = attributeUv(*own, v.x);
  const Vec2f e1 = attributeUv(*own, v.y) - uv0, e2 = attributeUv(*own, v.z) - uv0;
  return gradientOfEdges(at, slope.x * e1.x + slope.y * e1.y, slope.x * e2.x + slope.y * e2.y);
}

Rgb power(Rgb base, float exponent) {
  base = max(base, Rgb(0.f));
  return {std::pow(base.x, exponent), std::pow(base.y, exponent), std::pow(base.z, exponent)};
}

Rgb mixed(Rgb a, Rgb b, Rgb amount) { return a * (Rgb(1.f) - amount) + b * amount; }

}  // namespace

Rgb evaluate(const Scene& scene, TextureHandle handle, const TextureContext& at) {
  const Texture& t = scene[handle];
  switch (t.type) {
    case TextureType::constant:
      return t.value;
    case TextureType::bitmap:
      return bitmap(t, scene[t.image], uvOf(t, at));
    case TextureType::checkerboard:
      return evaluate(scene, firstColour(t, at.uv) ? t.a : t.b, at);
    case TextureType::scale:
      return evaluate(scene, t.a, at) * t.scale;
    case TextureType::meshAttribute:
      return attribute(t, at) * t.scale;
    case TextureType::product:
      return evaluate(scene, t.a, at) * evaluate(scene, t.b, at);
    case TextureType::mix:
      return mixed(evaluate(scene, t.a, at), evaluate(scene, t.b, at), evaluate(scene, t.c, at));
    case TextureType::power:
      return power(evaluate(scene, t.a, at), t.scale);
  }
  return {};
}

Rgb evaluate(const Scene& scene, const ColorParam& param, const TextureContext& at) {
  return param.texture.valid() ? evaluate(scene, param.texture, at) : param.value;
}

float evaluate(const Scene& scene, const FloatParam& param, const TextureContext& at) {
  return param.texture.valid() ? scalar(evaluate(scene, param.texture, at)) : param.value;
}

Vec2f gradient(const Scene& scene, TextureHandle handle, const TextureContext& at) {
  const Texture& t = scene[handle];
  const auto value = [&](TextureHandle part) { return scalar(evaluate(scene, part, at)); };
  switch (t.type) {
    case TextureType::bitmap:
      return bitmapGradient(t, scene[t.image], at);
    case TextureType::checkerboard:
      return gradient(scene, firstColour(t, at.uv) ? t.a : t.b, at);
    case TextureType::scale:
      return gradient(scene, t.a, at) * t.scale;
    case TextureType::meshAttribute:
      return attributeGradient(t, at) * t.scale;
    case TextureType::product:
      return gradient(scene, t.a, at) * value(t.b) + gradient(scene, t.b, at) * value(t.a);
    case TextureType::mix: {
      const float amount = value(t.c);
      return gradient(scene, t.a, at) * (1 - amount) + gradient(scene, t.b, at) * amount +
             gradient(scene, t.c, at) * (value(t.b) - value(t.a));
    }
    case TextureType::power: {
      const float base = value(t.a);
      if (!(base > 0)) return {};
      return gradient(scene, t.a, at) * (t.scale * std::pow(base, t.scale - 1));
    }
    case TextureType::constant:
      break;
  }
  return {};
}

}  // namespace lobelia
