// Deviation from glTF 2.0, 3.8: minification filters and mipmaps are not used (the samples of a
// pixel filter a texture).
//
// KHR_texture_transform. "Rotate the UVs by this many radians counter-clockwise" is seen with v
// pointing down, as in the image; so does Khronos' test TextureTransformTest have it, unlike the
// matrix printed in the extension's text.
#include "lobelia/io/gltf/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/io/image_io.h"

namespace lobelia::io::gltf {
namespace {

Wrap wrapMode(const Json& where) {
  const uint64_t mode = where.count(10497);
  if (mode == 33071) return Wrap::clamp;
  if (mode == 33648) return Wrap::mirror;
  if (mode == 10497) return Wrap::repeat;
  where.fail(fmt::format("is {}; it must be 33071, 33648 or 10497", mode));
}

void applySampler(const Import& import, const Json& texture, Texture& out) {
  if (!texture["sampler"].exists()) return;
  const Json sampler = import.document.item("samplers", texture["sampler"]);
  out.wrapU = wrapMode(sampler["wrapS"]);
  out.wrapV = wrapMode(sampler["wrapT"]);
  if (sampler["magFilter"].count(9729) == 9728) out.filter = Filter::nearest;
}

void applyTransform(const Json& info, Texture& out) {
  const Json transform = info.extension("KHR_texture_transform");
  if (!transform.exists()) return;
  const auto pair = [&](const char* name, double fallback) {
    const Json value = transform[name];
    return value.exists() ? value.numbers(2) : std::vector<double>{fallback, fallback};
  };
  const std::vector<double> offset = pair("offset", 0), scale = pair("scale", 1);
  const double angle = transform["rotation"].number(0), c = std::cos(angle), s = std::sin(angle);
  const double m[2][3] = {{c * scale[0], s * scale[1], offset[0]},
                          {-s * scale[0], c * scale[1], offset[1]}};
  for (int r = 0; r < 2; ++r)
    for (int i = 0; i < 3; ++i) out.uvMatrix[r][i] = static_cast<float>(m[r][i]);
}

}  // namespace

size_t texCoord(const Json& info) {
  const Json moved = info.extension("KHR_texture_transform")["texCoord"];
  const uint64_t set = moved.exists() ? moved.count() : info["texCoord"].count(0);
  if (set > 15) info.fail(fmt::format("TEXCOORD_{} is not read; sets 0 to 15 are", set));
  return static_cast<size_t>(set);
}

std::string uvAttribute(size_t set) { return fmt::format("vertex_uv{}", set); }

TextureHandle Textures::bitmap(const Json& info, const UvSets& uv, bool raw, int channel) {
  const Json texture = import_.document.item("textures", info["index"]);
  Texture out;
  out.type = TextureType::bitmap;
  out.channel = channel;
  out.image = image(texture, raw);
  if (!out.image.valid()) return {};
  if (const size_t set = texCoord(info); set != uv.first) out.attribute = uvAttribute(set);
  applySampler(import_, texture, out);
  applyTransform(info, out);
  return add(out);
}

ImageHandle Textures::image(const Json& texture, bool raw) {
  Json source = texture.extension("EXT_texture_webp")["source"];
  if (!source.exists()) source = texture["source"];
  if (!source.exists()) {
    import_.warn(texture,
                 "has no image in a format that is read (PNG, JPEG, WebP); it is taken for white");
    return {};
  }
  const size_t index = source.index(import_.document.size("images"), "images");
  const auto [entry, isNew] = images_.try_emplace({index, raw});
  if (!isNew) return entry->second;
  import_.scene.images.push_back(load(source, raw));
  entry->second = {static_cast<uint32_t>(import_.scene.images.size() - 1)};
  return entry->second;
}

Image Textures::load(const Json& source, bool raw) {
  const Json json = import_.document.item("images", source);
  const ImageOptions options{raw, 0};
  if (json["uri"].exists()) {
    const Resource resource = import_.document.resource(json["uri"]);
    return readImage(resource.bytes, resource.name, options);
  }
  if (!json["bufferView"].exists()) json.fail("has neither a uri nor a bufferView; it needs one");
  const Bytes bytes = import_.document.view(json["bufferView"]).bytes;
  Image image = readImage(bytes, json.where().file, options);
  image.name = json["name"].text("");
  if (image.name.empty()) image.name = fmt::format("image{}", import_.scene.images.size());
  return image;
}

TextureHandle Textures::add(Texture texture) {
  import_.scene.textures.push_back(std::move(texture));
  return {static_cast<uint32_t>(import_.scene.textures.size() - 1)};
}

TextureHandle Textures::constant(Rgb value) {
  Texture texture;
  texture.value = value;
  return add(texture);
}

TextureHandle Textures::attribute(const std::string& name) {
  Texture texture;
  texture.type = TextureType::meshAttribute;
  texture.attribute = name;
  return add(texture);
}

TextureHandle Textures::product(TextureHandle a, TextureHandle b) {
  if (!a.valid() || !b.valid()) return a.valid() ? a : b;
  Texture texture;
  texture.type = TextureType::product;
  texture.a = a, texture.b = b;
  return add(texture);
}

TextureHandle Textures::scaled(TextureHandle a, Rgb factor) {
  if (!a.valid()) return constant(factor);
  if (factor == Rgb(1.f)) return a;
  if (factor.x != factor.y || factor.y != factor.z) return product(a, constant(factor));
  Texture texture;
  texture.type = TextureType::scale;
  texture.a = a, texture.scale = factor.x;
  return add(texture);
}

TextureHandle Textures::mix(TextureHandle a, TextureHandle b, TextureHandle amount) {
  Texture texture;
  texture.type = TextureType::mix;
  texture.a = a, texture.b = b, texture.c = amount;
  return add(texture);
}

TextureHandle Textures::turned(TextureHandle a, Rgb which) {
  if (which == Rgb(0.f)) return a;
  return mix(a, mix(constant(Rgb(1.f)), constant(Rgb(0.f)), a), constant(which));
}

ColorParam Textures::color(Rgb factor, TextureHandle texture) {
  if (!texture.valid() || factor == Rgb(0.f)) return factor;
  return scaled(texture, factor);
}

FloatParam Textures::number(double factor, TextureHandle texture) {
  const auto value = static_cast<float>(factor);
  if (!texture.valid() || value == 0) return value;
  return scaled(texture, Rgb(value));
}

}  // namespace lobelia::io::gltf
