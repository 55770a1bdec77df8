#include "lobelia/transfer/prefiltered_light.h"

#include <cassert>
#include <cmath>
#include <span>

#include "lobelia/base/parallel.h"
#include "lobelia/bsdf/scalar_lobe.h"
#include "lobelia/transfer/cube_map.h"
#include "lobelia/transfer/interpolation-inl.h"
#include "lobelia/transfer/lump_kernels.h"

namespace lobelia::transfer {
namespace {

// A lobe whose deviation is the spacing of the powers that DistantLight makes of images, 2 pi /
// 512: there their sum is smooth to within 1e-8.
constexpr float kSharpest = 6640;
constexpr float kWidest = 0.25f;

// Of a face, with its border. Bilinear interpolation errs by kappa (h_x^2 + h_y^2) / 8 of the peak
// at most, where texels are h apart: 2 / 1.2664 / n in the middle of a face, the worst place. Light
// from one direction errs by kError there, a lobe three times as wide as the level's by a quarter
// of it.
int sizeOf(float kappa) {
  constexpr float kError = 0.02f;
  const int size = static_cast<int>(std::sqrt(kappa * sqr(1 / 1.2664f) / kError));
  return (std::max(size, 24) + 2 + 3) / 4 * 4;
}

// Of lumps: half a lobe's deviation; of wide ones little enough for their shape to be none.
float lumpWidth(float kappa) { return std::min(0.5f / std::sqrt(kappa), 0.1f); }

// Beyond it a lobe has less than 1e-5 of its peak.
float reachOf(float kappa) {
  const float chord = std::sqrt(23 / kappa);
  return chord >= 2 ? kPi : 2 * std::asin(chord / 2);
}

// Face coordinates of texels: those of the border lie beyond 1.
std::vector<float> texelCoordinates(int size) {
  std::vector<float> out(static_cast<size_t>(size));
  for (int i = 0; i < size; ++i)
    out[static_cast<size_t>(i)] =
        unwarped((2 * static_cast<float>(i) - 1) / static_cast<float>(size - 2) - 1);
  return out;
}

constexpr size_t kBlock = 4;  // texels along an edge, whose lumps are looked for together
static_assert(kBlock * kBlock == kBlockTexels);

// The lumps that reach the block whose face coordinates begin at u and v.
void findAround(size_t face, const float* u, const float* v, const LightLumps& lumps, float reach,
                std::vector<std::pair<uint32_t, uint32_t>>* ranges) {
  constexpr size_t kLast = kBlock - 1;
  const Vec3f middle = cubeDirection(face, 0.5f * (u[0] + u[kLast]), 0.5f * (v[0] + v[kLast]));
  float most = 0;  // chord to a corner
  for (const float cornerU : {u[0], u[kLast]})
    for (const float cornerV : {v[0], v[kLast]})
      most = std::max(most, length(cubeDirection(face, cornerU, cornerV) - middle));
  ranges->clear();
  lumps.find(middle, std::min(reach + 2 * std::asin(most / 2), kPi), ranges);
}

// That block, with all that reaches it.
TexelBlock blockAt(size_t face, const float* u, const float* v, const LumpLobes& lobes,
                   std::span<const std::pair<uint32_t, uint32_t>> ranges, Rgb everywhere) {
  TexelBlock block;
  for (size_t t = 0; t < kBlockTexels; ++t) {
    const Vec3f d = cubeDirection(face, u[t % kBlock], v[t / kBlock]);
    block.x[t] = d.x, block.y[t] = d.y, block.z[t] = d.z;
    block.r[t] = everywhere.x, block.g[t] = everywhere.y, block.b[t] = everywhere.z;
  }
  for (const auto& [begin, end] : ranges) addLumps(lobes, begin, end, &block);
  return block;
}

}  // namespace

PrefilteredLight::PrefilteredLight(const relight::DistantLight& light) {
  for (int i = 0;; ++i) {
    const float kappa = kSharpest * std::exp2(-static_cast<float>(i) / kLevelsPerOctave);
    Level& level = levels_.emplace_back();
    level.kappa = kappa;
    level.size = sizeOf(kappa);
    if (kappa <= kWidest) break;
  }
  assert(6 * sqr(static_cast<float>(levels_[0].size)) < 0x1p22f);  // texels are numbered by floats
  // Side by side, because each begins with what one thread does: sorting the powers.
  parallelFor(levels_.size(), 1, [&](size_t l) { fill(light, &levels_[l]); });
  for (const Level& level : levels_) {
    texels_.push_back(level.texels.data()->value);
    sizes_.push_back(static_cast<float>(level.size));
  }
}

void PrefilteredLight::fill(const relight::DistantLight& light, Level* level) const {
  const auto size = static_cast<size_t>(level->size);
  const Texel nothing{{light.everywhere.x, light.everywhere.y, light.everywhere.z, 0}};
  level->texels.assign(6 * size * size, nothing);
  if (light.powers.empty()) return;
  const std::vector<float> at = texelCoordinates(level->size);
  const LightLumps lumps(light.powers, level->kappa, lumpWidth(level->kappa));
  const float reach = reachOf(level->kappa);
  const size_t rows = size / kBlock;  // of blocks
  parallelFor(6 * rows, 1, [&](size_t row) {
    std::vector<std::pair<uint32_t, uint32_t>> ranges;
    const size_t face = row / rows, y = row % rows * kBlock;
    for (size_t x = 0; x < size; x += kBlock) {
      findAround(face, at.data() + x, at.data() + y, lumps, reach, &ranges);
      if (ranges.empty()) continue;
      const TexelBlock block =
          blockAt(face, at.data() + x, at.data() + y, lumps.lobes(), ranges, light.everywhere);
      Texel* const out = level->texels.data() + (face * size + y) * size + x;
      for (size_t t = 0; t < kBlockTexels; ++t)
        out[t / kBlock * size + t % kBlock] = {{block.r[t], block.g[t], block.b[t], 0}};
    }
  });
}

LightLevels PrefilteredLight::levels() const {
  return {texels_.data(), sizes_.data(), sharpest(), static_cast<float>(levels_.size() - 1)};
}

float PrefilteredLight::levelOf(float kappa) const {
  return core::levelOfKappa(kappa, sharpest(), kLevelsPerOctave,
                            static_cast<float>(levels_.size() - 1));
}

Rgb PrefilteredLight::lookUpAt(Vec3f axis, float level) const {
  const auto sharper = static_cast<size_t>(level);
  const float share = level - static_cast<float>(sharper);
  const core::CubeSpot<float> spot = core::cubeSpot(toCore(axis));
  float sum[4] = {};
  const auto add = [&](const Level& from, float weight) {
    const auto [index, u, v] = core::texelPlace(spot, static_cast<float>(from.size));
    const Texel* const t = from.texels.data() + static_cast<size_t>(index);
    const Texel* const below = t + from.size;
    const float w[4] = {weight * (1 - u) * (1 - v), weight * u * (1 - v), weight * (1 - u) * v,
                        weight * u * v};
    for (size_t c = 0; c < 4; ++c)
      sum[c] += w[0] * t[0].value[c] + w[1] * t[1].value[c] + w[2] * below[0].value[c] +
                w[3] * below[1].value[c];
  };
  add(levels_[sharper], 1 - share);
  if (share > 0) add(levels_[sharper + 1], share);
  return {sum[0], sum[1], sum[2]};
}

}  // namespace lobelia::transfer
