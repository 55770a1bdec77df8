// Textures of materials: images, samplers, KHR_texture_transform, and the arithmetic of factors.
#pragma once

#include <map>

#include "lobelia/io/gltf/import.h"

namespace lobelia::io::gltf {

// Which of a mesh's TEXCOORD sets a material reads. `first` becomes the mesh's uv, from which the
// tangents come; the others become vertex attributes.
struct UvSets {
  size_t first = 0;
  std::vector<size_t> others;
  bool needed = false;    // is any read at all?
  bool tangents = false;  // normal maps and anisotropy follow the uv's tangents
};

size_t texCoord(const Json& textureInfo);
std::string uvAttribute(size_t set);  // "vertex_uv1"

class Textures {
 public:
  explicit Textures(const Import& import) : import_(import) {}

  // The bitmap that a textureInfo names; channel as Texture::channel. Invalid (with a finding) when
  // its image is in a format that is not read.
  TextureHandle bitmap(const Json& info, const UvSets& uv, bool raw, int channel = -1);

  TextureHandle add(Texture texture);
  TextureHandle constant(Rgb value);
  TextureHandle attribute(const std::string& name);
  // Products leave out what is 1; an invalid handle stands for 1.
  TextureHandle product(TextureHandle a, TextureHandle b);
  TextureHandle scaled(TextureHandle a, Rgb factor);
  // (1 - amount) a + amount b
  TextureHandle mix(TextureHandle a, TextureHandle b, TextureHandle amount);
  // 1 - a in the channels that `which` marks by a 1.
  TextureHandle turned(TextureHandle a, Rgb which);
  ColorParam color(Rgb factor, TextureHandle texture);
  FloatParam number(double factor, TextureHandle texture);

 private:
  ImageHandle image(const Json& texture, bool raw);
  Image load(const Json& source, bool raw);

  const Import& import_;
  std::map<std::pair<size_t, bool>, ImageHandle> images_;  // by image and raw
};

}  // namespace lobelia::io::gltf
