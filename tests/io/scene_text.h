// A scene as text in which handles are replaced by what they stand for: two scenes that differ only
// in the order of their vectors and in names give the same text.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "lobelia/scene/material_parameters.h"
#include "lobelia/scene/scene.h"

namespace lobelia::test {

class SceneText {
 public:
  explicit SceneText(const Scene& scene) : s_(scene) {}

  std::string all() const {
    std::string out;
    for (const Instance& i : s_.instances) out += instance(i) + "\n";
    for (const Emitter& e : s_.emitters)
      if (e.type != EmitterType::area) out += emitter(e) + "\n";
    for (const Camera& c : s_.cameras) out += camera(c) + "\n";
    // The writer names an integrator where the scene has none.
    return out + fmt::format("{} {} {}\n", s_.integrator.empty() ? "path" : s_.integrator,
                             s_.maxDepth, s_.hideEmitters);
  }

  std::string image(ImageHandle h) const {
    if (!h.valid()) return "none";
    const Image& i = s_[h];
    return fmt::format("image {}x{}x{} {}", i.width, i.height, i.channels, bits(i.pixels));
  }
  std::string texture(TextureHandle h) const {
    if (!h.valid()) return "none";
    const Texture& t = s_[h];
    switch (t.type) {
      case TextureType::constant:
        return "rgb " + rgb(t.value);
      case TextureType::bitmap:
        return fmt::format("bitmap({} {} {} {} {} {} {})", image(t.image), int(t.filter),
                           int(t.wrapU), int(t.wrapV), t.alphaChannel, t.channel, t.attribute,
                           uv(t));
      case TextureType::checkerboard:
        return fmt::format("checker({} {} {})", texture(t.a), texture(t.b), uv(t));
      case TextureType::scale:
        return fmt::format("scale({} {})", t.scale, texture(t.a));
      case TextureType::meshAttribute:
        return fmt::format("attribute {} {} {}", t.attribute, t.channel, t.scale);
      case TextureType::product:
        return fmt::format("product({} {})", texture(t.a), texture(t.b));
      case TextureType::mix:
        return fmt::format("mix({} {} {})", texture(t.a), texture(t.b), texture(t.c));
      case TextureType::power:
        return fmt::format("power({} {})", texture(t.a), t.scale);
    }
    return "?";
  }
  std::string material(MaterialHandle h) const {
    if (!h.valid()) return "none";
    const Material& m = s_[h];
    std::string out = fmt::format("material {} (", int(m.type));
    eachColorParam(m, [&](const ColorParam& p) { out += color(p) + " "; });
    out += fmt::format("{} {} {} {} {} {} ", m.isSpecularGlossiness, texture(m.clearcoatNormal),
                       texture(m.anisotropicDirection), m.thin, m.coatIor, rgb(m.absorption));
    out += fmt::format("{} {} {} {} {} {} ", m.ior, int(m.distribution), m.wardVariant, m.nonlinear,
                       texture(m.map), m.scale);
    eachFloatParam(m, [&](const FloatParam& p) {
      out += (p.texture.valid() ? texture(p.texture) : fmt::format("{}", p.value)) + " ";
    });
    for (const CapturedLobe& lobe : m.capturedLobes) {
      const FloatParam& s = lobe.sharpness;
      out += color(lobe.amplitude) + " " +
             (s.texture.valid() ? texture(s.texture) : fmt::format("{}", s.value)) + " ";
    }
    return out + material(m.a) + " " + material(m.b) + ")";
  }
  std::string emitter(const Emitter& e) const {
    return fmt::format("emitter {} '{}' {} {} {} {} {} {} {} {} {} {}", int(e.type), e.group,
                       matrix(e.type == EmitterType::directional ? Mat4() : e.toWorld.to),
                       color(e.radiance), e.scale, image(e.image), e.cutoff, e.beamWidth,
                       texture(e.pattern), e.fov, rgb(e.direction), e.angularRadius);
  }
  std::string mesh(MeshHandle h) const {
    const Mesh& m = s_[h];
    std::string out = fmt::format("mesh {} {} {} {} {}", m.isUnitSphere, bits(m.positions),
                                  bits(m.normals), bits(m.uvs), bits(m.triangles));
    for (const MeshAttribute& a : m.attributes)
      out += fmt::format(" {} {} {} {}", a.name, a.perFace, a.size, bits(a.values));
    return out;
  }
  std::string instance(const Instance& i) const {
    return fmt::format("instance {} {} {} {} {}", mesh(i.mesh), matrix(i.toWorld.to),
                       material(i.material), i.emitter.valid() ? emitter(s_[i.emitter]) : "none",
                       i.flipNormals);
  }
  std::string camera(const Camera& c) const {
    return fmt::format("camera {} {} {} {},{} {} {} {} {} {}x{} {},{}..{},{} {} {} {}", int(c.type),
                       matrix(c.toWorld.to), c.fovX, c.principalPointOffset.x,
                       c.principalPointOffset.y, c.nearClip, c.farClip, c.apertureRadius,
                       c.focusDistance, c.width, c.height, c.cropX0, c.cropY0, c.cropX1, c.cropY1,
                       int(c.filter), c.filterRadius, c.spp);
  }

 private:
  // Length and hash (FNV-1a over words) of an array's bits.
  template <class T>
  static std::string bits(const std::vector<T>& values) {
    uint64_t hash = 0xcbf29ce484222325ull;
    for (const T& value : values) {
      uint32_t words[sizeof(T) / 4];
      std::memcpy(words, &value, sizeof(T));
      for (const uint32_t w : words) hash = (hash ^ w) * 0x100000001b3ull;
    }
    return fmt::format("{}:{:x}", values.size(), hash);
  }
  static std::string rgb(Vec3f v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }
  static std::string uv(const Texture& t) {
    const auto& m = t.uvMatrix;
    return fmt::format("{} {} {} {} {} {}", m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2]);
  }
  static std::string matrix(const Mat4& m) {
    std::string out;
    for (const auto& row : m.m)
      for (const double x : row) out += fmt::format("{} ", x + 0.0);  // -0 is 0
    return out;
  }
  std::string color(const ColorParam& c) const {
    return c.texture.valid() ? texture(c.texture) : rgb(c.value);
  }

  const Scene& s_;
};

}  // namespace lobelia::test
