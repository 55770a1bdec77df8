#include "lobelia/relight/pixel_shader.h"

#include <algorithm>
#include <cmath>

#include "lobelia/bsdf/albedo.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/relight/lobe_reach.h"

namespace lobelia::relight {
namespace {

constexpr uint32_t kAbsent = 0xffffffffu;

Vec3f mirrorDirection(const LobeQuery& query) {
  const Vec3f n = query.frame->n;
  return n * (2 * dot(n, query.wo)) - query.wo;
}

// Of a mirror; what evaluation asks of directions at bump and normal maps (bsdf/bsdf.cpp).
float bumpFactor(const LobeQuery& query, Vec3f wi) {
  if (!query.frame->perturbed) return 1;
  if (dot(wi, query.baseNormal) * dot(wi, query.frame->n) <= 0) return 0;
  return bumpShadow(query.baseNormal, query.frame->bumpAlpha2, wi);
}

}  // namespace

void PixelShader::begin(const FrameLight& light, const EmitterSampler& emitters,
                        const DirectionLookup& lookup, bool refined, VertexCache* vertices) {
  light_ = &light;
  emitters_ = &emitters;
  lookup_ = &lookup;
  refined_ = refined;
  vertices_ = vertices;
  const size_t chunks = light.cut.padded() / kChunk;
  coarse_.reserve(chunks);
  masks_.resize(chunks);
  position_.resize(chunks);
}

Rgb PixelShader::reflected(const Bsdf& bsdf, Vec3f wo, const PixelPlace& place) {
  place_ = place;
  normal_ = dot(bsdf.ng, wo) < 0 ? -bsdf.ng : bsdf.ng;
  VertexLights lights{
      {light_->cut.x.data(), light_->cut.y.data(), light_->cut.z.data()}, {}, {}, {}};
  for (size_t v = 0; v < 3; ++v) {
    lights.rows[v] = vertices_->rows(place.slot[v]);
    lights.lit[v] = vertices_->lit(place.slot[v]);
    lights.weight[v] = place.weight[v];
  }
  coarse_.chunkCount = 0;
  appendLight(lights, light_->cut.padded() / kChunk, normal_, &coarse_);
  std::fill(position_.begin(), position_.end(), kAbsent);
  for (uint32_t i = 0; i < coarse_.chunkCount; ++i) position_[coarse_.chunk[i]] = i;

  Rgb sum{};
  for (int l = 0; l < bsdf.lobeCount; ++l) {
    const Lobe& lobe = bsdf.lobes[l];
    const LobeQuery query{&lobe, &bsdf.frameOf(lobe), bsdf.baseNormal, wo};
    const bool seen = dot(query.frame->n, wo) > 0 || lobe.twoSided || lobe.interface;
    if (isTransmission(lobe.type) || !seen) continue;
    sum += isMirror(lobe) ? mirrored(query) : lobeSum(query);
  }
  return sum;
}

Rgb PixelShader::lobeSum(const LobeQuery& query) {
  Lobe widened;
  const std::optional<LobeReach> reach = lobeReach(*query.lobe, light_->sums.levels, &widened);
  LobeQuery smooth = query;
  smooth.lobe = &widened;
  if (reach && reach->end < kPi) {
    smooth.mirror = mirrorDirection(query);
    smooth.leastCosine = std::cos(reach->end);
  }
  if (refined_ && reach && static_cast<size_t>(reach->level) < light_->fine.size()) {
    const FineUnits& units = light_->fine[static_cast<size_t>(reach->level)];
    if (units.count > 0) return refinedSum(smooth, units, reach->radius);
  }
  return sumLobe(refined_ ? smooth : query, coarse_, coarse_.lit.data(), &counts.evaluations);
}

Rgb PixelShader::refinedSum(const LobeQuery& query, const FineUnits& units, float radius) {
  units_.clear();
  findUnits(units, mirrorDirection(query), radius, &units_);
  std::copy_n(coarse_.lit.begin(), coarse_.chunkCount, masks_.begin());
  size_t chunks = 0;
  for (const uint32_t unit : units_) chunks += units.chunkCount[unit];
  fine_.reserve(chunks);
  fine_.chunkCount = 0;
  for (const uint32_t unit : units_) {
    if (!isLit(units, unit)) continue;
    excludeNodes(units.cutBegin[unit], units.cutEnd[unit]);
    appendFine(units, unit);
  }
  counts.fineChunks += fine_.chunkCount;
  return sumLobe(query, coarse_, masks_.data(), &counts.evaluations) +
         sumLobe(query, fine_, fine_.lit.data(), &counts.evaluations);
}

// Do the vertices see any light of the unit, on whatever side of the pixel?
bool PixelShader::isLit(const FineUnits& units, uint32_t unit) const {
  return std::any_of(std::begin(place_.slot), std::end(place_.slot), [&](uint32_t slot) {
    return vertices_->isLit(slot, units.cutBegin[unit], units.cutEnd[unit]);
  });
}

void PixelShader::excludeNodes(uint32_t begin, uint32_t end) {
  for (uint32_t chunk = begin / kChunk; chunk * kChunk < end; ++chunk) {
    const uint32_t at = position_[chunk];
    if (at == kAbsent) continue;
    masks_[at] = static_cast<uint16_t>(masks_[at] & ~chunkMask(chunk, begin, end));
  }
}

void PixelShader::appendFine(const FineUnits& units, uint32_t unit) {
  const LightSums& sums = light_->sums;
  const uint32_t first = units.firstNode[unit];
  VertexLights lights{
      {sums.x.data() + first, sums.y.data() + first, sums.z.data() + first}, {}, {}, {}};
  VertexCache::Fine fine[3];
  for (size_t v = 0; v < 3; ++v) fine[v] = vertices_->fineOf(place_.slot[v], units, unit);
  for (size_t v = 0; v < 3; ++v) {
    lights.rows[v] = vertices_->fineRows(fine[v], units, unit);
    lights.weight[v] = place_.weight[v] * fine[v].seen;
  }
  appendLight(lights, units.chunkCount[unit], normal_, &fine_);
}

Rgb PixelShader::mirrored(const LobeQuery& query) {
  const Vec3f d = mirrorDirection(query);
  if (!(dot(d, normal_) > 0)) return {};
  const float factor = bumpFactor(query, d);
  if (factor == 0) return {};
  const uint32_t leaf = lookup_->nearest(d);
  float seen = 0;
  for (size_t v = 0; v < 3; ++v)
    seen += place_.weight[v] * vertices_->visibility(place_.slot[v], leaf);
  const float cosine = dot(query.frame->n, query.wo);
  const Vec3f inScene = normalize(light_->toScene.vector(d));
  return emitters_->escaped(inScene) * lobeAlbedo(*query.lobe, cosine) * (seen * factor);
}

}  // namespace lobelia::relight
