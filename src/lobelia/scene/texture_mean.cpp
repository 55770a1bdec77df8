// Mean of a colour parameter over the unit square of uv. Exact where it is a mean of texels;
// otherwise (transformed or nested textures) the midpoint rule on a fixed grid. Where textures that
// are no functions of uv are combined, their means are: near enough for choosing lights.
#include <algorithm>
#include <cmath>

#include "lobelia/scene/scene.h"
#include "lobelia/scene/texture.h"

namespace lobelia {
namespace {

constexpr int kGrid = 256;

bool isPlain(const Texture& t) {
  return t.uvMatrix[0][0] == 1 && t.uvMatrix[0][1] == 0 && t.uvMatrix[0][2] == 0 &&
         t.uvMatrix[1][0] == 0 && t.uvMatrix[1][1] == 1 && t.uvMatrix[1][2] == 0;
}

// Does a unit square of uv see each texel as often as any other?
bool repeatsTexels(Wrap wrap) { return wrap != Wrap::zero && wrap != Wrap::one; }

Rgb toRgb(Vec3d sum, double count) {
  return {static_cast<float>(sum.x / count), static_cast<float>(sum.y / count),
          static_cast<float>(sum.z / count)};
}

Rgb gridMean(const Scene& scene, TextureHandle handle) {
  Vec3d sum;
  TextureContext at;
  for (int j = 0; j < kGrid; ++j) {
    for (int i = 0; i < kGrid; ++i) {
      at.uv = {(static_cast<float>(i) + 0.5f) / kGrid, (static_cast<float>(j) + 0.5f) / kGrid};
      const Rgb c = evaluate(scene, handle, at);
      sum += Vec3d(c.x, c.y, c.z);
    }
  }
  return toRgb(sum, double{kGrid} * kGrid);
}

// Bilinear filtering keeps the mean of the texels when the image repeats.
Rgb texelMean(const Texture& t, const Image& image) {
  const auto channels = static_cast<size_t>(image.channels);
  const bool hasAlpha = channels % 2 == 0;
  if (!t.alphaChannel && t.channel >= 3 && !hasAlpha) return Rgb(1.f);
  const bool alpha = hasAlpha && (t.alphaChannel || t.channel >= 3);
  const bool colour = channels >= 3 && !alpha && t.channel < 0;
  const size_t chosen = t.channel > 0 && channels >= 3 ? static_cast<size_t>(t.channel) : 0;
  const size_t first = alpha ? channels - 1 : chosen;
  Vec3d sum;
  for (size_t i = first; i < image.pixels.size(); i += channels) {
    const float* const p = &image.pixels[i];
    sum += colour ? Vec3d(p[0], p[1], p[2]) : Vec3d(p[0]);
  }
  return toRgb(sum, double(image.width) * image.height);
}

// A mesh attribute is not a function of uv: the mean of its values over all meshes that have it.
Rgb attributeMean(const Scene& scene, const Texture& t) {
  Vec3d sum;
  double count = 0;
  for (const Mesh& mesh : scene.meshes) {
    for (const MeshAttribute& a : mesh.attributes) {
      if (a.name != t.attribute) continue;
      const auto size = static_cast<size_t>(a.size);
      for (size_t i = 0; i + size <= a.values.size(); i += size) {
        const float* const v = &a.values[i];
        if (t.channel >= 3)
          sum += Vec3d(size >= 4 ? v[3] : 1.f);
        else if (t.channel >= 0)
          sum += Vec3d(v[t.channel < a.size ? t.channel : 0]);
        else
          sum += size >= 3 ? Vec3d(v[0], v[1], v[2]) : Vec3d(v[0]);
        ++count;
      }
    }
  }
  return count > 0 ? toRgb(sum, count) * t.scale : Rgb(0.f);
}

bool dependsOnMesh(const Scene& scene, TextureHandle handle) {
  if (!handle.valid()) return false;
  const Texture& t = scene[handle];
  switch (t.type) {
    case TextureType::meshAttribute:
      return true;
    case TextureType::constant:
    case TextureType::bitmap:
      return false;
    case TextureType::checkerboard:
    case TextureType::scale:
    case TextureType::product:
    case TextureType::mix:
    case TextureType::power:
      break;
  }
  return dependsOnMesh(scene, t.a) || dependsOnMesh(scene, t.b) || dependsOnMesh(scene, t.c);
}

Rgb mean(const Scene& scene, TextureHandle handle) {
  const Texture& t = scene[handle];
  switch (t.type) {
    case TextureType::constant:
      return t.value;
    case TextureType::bitmap:
      return isPlain(t) && repeatsTexels(t.wrapU) && repeatsTexels(t.wrapV)
                 ? texelMean(t, scene[t.image])
                 : gridMean(scene, handle);
    case TextureType::scale:
      return mean(scene, t.a) * t.scale;
    case TextureType::meshAttribute:
      return attributeMean(scene, t);
    case TextureType::checkerboard:
      if (dependsOnMesh(scene, handle)) return (mean(scene, t.a) + mean(scene, t.b)) * 0.5f;
      break;
    case TextureType::product:
      if (dependsOnMesh(scene, handle)) return mean(scene, t.a) * mean(scene, t.b);
      break;
    case TextureType::mix:
      if (dependsOnMesh(scene, handle)) {
        const Rgb amount = mean(scene, t.c);
        return mean(scene, t.a) * (Rgb(1.f) - amount) + mean(scene, t.b) * amount;
      }
      break;
    case TextureType::power:
      if (dependsOnMesh(scene, handle)) {
        const Rgb base = max(mean(scene, t.a), Rgb(0.f));
        return {std::pow(base.x, t.scale), std::pow(base.y, t.scale), std::pow(base.z, t.scale)};
      }
      break;
  }
  return gridMean(scene, handle);
}

}  // namespace

Rgb mean(const Scene& scene, const ColorParam& param) {
  return param.texture.valid() ? mean(scene, param.texture) : param.value;
}

}  // namespace lobelia
