#include "lobelia/relight/pixel_groups.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/lobe_kind.h"

namespace lobelia::relight {
namespace {

constexpr float kBroadest = 0.5f;  // roughness of lobes that need no more than diffuse ones

struct MirrorLobe {
  Vec3f axis;
  float alpha = 1;
  float peak = 0;
};

// The lobe with the largest peak, if it is glossy.
std::optional<MirrorLobe> narrowestLobe(const LitPixel& pixel) {
  MirrorLobe narrowest;
  for (int l = 0; l < pixel.bsdf.lobeCount; ++l) {
    const Lobe& lobe = pixel.bsdf.lobes[l];
    const float alpha = roughness(lobe);
    if (lobe.sharp || isTransmission(lobe.type) || isDiffuse(lobe.type) || alpha > kBroadest)
      continue;
    const Vec3f n = pixel.bsdf.frameOf(lobe).n;
    const float cosine = dot(n, pixel.wo);
    const float peak = luminance(lobeAlbedo(lobe, cosine)) / (4 * alpha * alpha);
    if (peak > narrowest.peak) narrowest = {n * (2 * cosine) - pixel.wo, alpha, peak};
  }
  if (narrowest.peak > 0) return narrowest;
  return std::nullopt;
}

PixelGroup groupOf(std::span<const LitPixel> pixels) {
  PixelGroup group;
  Vec3f normals{}, axes{};
  MirrorLobe lobes[kGroupPixels];
  size_t glossy = 0;
  float alpha = 1;
  for (const LitPixel& pixel : pixels) {
    group.box.add(pixel.at.p);
    normals += pixel.normal;
    const std::optional<MirrorLobe> lobe = narrowestLobe(pixel);
    if (!lobe) continue;
    lobes[glossy++] = *lobe;
    axes += lobe->axis;
    alpha = std::min(alpha, lobe->alpha);
    group.peak = std::max(group.peak, lobe->peak);
  }
  group.normal = lengthSquared(normals) > 1e-12f ? normalize(normals) : pixels[0].normal;
  float least = 1;
  for (const LitPixel& pixel : pixels) least = std::min(least, dot(pixel.normal, group.normal));
  group.bend = least > 0 ? std::sqrt(std::max(1 - least * least, 0.f)) : 1.f;
  if (glossy == 0) return group;
  group.axis = lengthSquared(axes) > 1e-12f ? normalize(axes) : lobes[0].axis;
  group.width = 2 * alpha;
  for (size_t i = 0; i < glossy; ++i)
    group.chord = std::max(group.chord, length(lobes[i].axis - group.axis) + 3 * lobes[i].alpha);
  return group;
}

}  // namespace

void makePixelGroups(std::span<const LitPixel> pixels, std::vector<PixelGroup>* groups) {
  groups->clear();
  for (size_t first = 0; first < pixels.size(); first += kGroupPixels)
    groups->push_back(
        groupOf(pixels.subspan(first, std::min(kGroupPixels, pixels.size() - first))));
}

}  // namespace lobelia::relight
