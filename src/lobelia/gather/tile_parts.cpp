#include "lobelia/gather/tile_parts.h"

#include <algorithm>
#include <bit>

#include "lobelia/bsdf/lobe_kind.h"

namespace lobelia::gather {
namespace {

bool isDiffuseReceiver(LobeType type) {
  return isDiffuse(type) || type == LobeType::diffuseTransmission;
}

TileSums emptySums(const Tile& tile) {
  TileSums sums;
  sums.strips.resize(tile.strips.size());
  return sums;
}

}  // namespace

TileParts::TileParts(const Receivers& receivers, const VirtualLights& lights, const Tile& tile,
                     GatherParts* parts)
    : receivers_(receivers), lights_(lights), tile_(tile), parts_(parts) {
  groups_.resize(parts->groupCount);
  if (parts->countRays) rays_.assign(tile.strips.size() * kStrip, 0);
  if (!parts->byType) return;
  types_.assign(GatherParts::kTypes, emptySums(tile));
  for (const PointStrip& strip : tile.strips) {
    size_t diffuse = 0;
    for (size_t l = 0; l < strip.lobeCount; ++l)
      diffuse += isDiffuseReceiver(tile.lobes[strip.firstLobe + l].type) ? 1 : 0;
    lobes_.push_back(diffuse == strip.lobeCount ? Lobes::diffuse
                     : diffuse == 0             ? Lobes::glossy
                                                : Lobes::mixed);
    anyMixed_ |= lobes_.back() == Lobes::mixed;
  }
  if (!anyMixed_) return;
  diffuse_.strips = tile.strips;
  diffuse_.tables = tile.tables;
  // Spherical lights: directions by the same Gaussians, but for half vectors of lobes that are
  // gone.
  diffuse_.receivers = tile.receivers;
  diffuse_.gaussians = tile.gaussians;
  diffuse_.sampling = tile.sampling;
  for (SamplingStrip& sampling : diffuse_.sampling) sampling.halfLobe = -1;
  for (PointStrip& strip : diffuse_.strips) {
    const size_t first = diffuse_.lobes.size();
    for (size_t l = 0; l < strip.lobeCount; ++l) {
      const LobeStrip& lobe = tile.lobes[strip.firstLobe + l];
      if (isDiffuseReceiver(lobe.type)) diffuse_.lobes.push_back(lobe);
    }
    strip.firstLobe = first;
    strip.lobeCount = diffuse_.lobes.size() - first;
  }
}

void TileParts::beginClass(const TileSums& sums) {
  if (!parts_->byType) return;
  before_ = sums;
  diffuseSums_ = emptySums(tile_);
}

void TileParts::endClass(LightClass lightClass, const TileSums& sums) {
  if (!parts_->byType) return;
  TileSums& diffuse = types_[2 * static_cast<size_t>(lightClass)];
  TileSums& glossy = types_[2 * static_cast<size_t>(lightClass) + 1];
  for (size_t s = 0; s < tile_.strips.size(); ++s) {
    for (auto channel : {&TileSums::Strip::x, &TileSums::Strip::y, &TileSums::Strip::z}) {
      for (size_t lane = 0; lane < kStrip; ++lane) {
        const double whole = (sums.strips[s].*channel)[lane] - (before_.strips[s].*channel)[lane];
        const double part = lobes_[s] == Lobes::diffuse ? whole
                            : lobes_[s] == Lobes::glossy
                                ? 0
                                : std::min((diffuseSums_.strips[s].*channel)[lane], whole);
        (diffuse.strips[s].*channel)[lane] = part;
        (glossy.strips[s].*channel)[lane] = whole - part;
      }
    }
  }
}

void TileParts::watchRays(PairMasks* pairs) {
  if (!parts_->countRays) return;
  traced_.assign(pairs->bits.size(), 0);
  pairs->traced = &traced_;
}

void TileParts::add(const LightBlock& block, float clamp, const PairMasks& visible) {
  for (size_t i = 0; parts_->countRays && i < traced_.size(); ++i) {
    uint32_t* out = &rays_[i % visible.strips * kStrip];
    for (uint32_t bits = traced_[i]; bits != 0; bits &= bits - 1) ++out[std::countr_zero(bits)];
  }
  if (!groups_.empty()) addGroups(block, clamp, visible);
  if (anyMixed_) addDiffuseLobes(block, clamp, visible);
}

void TileParts::addGroups(const LightBlock& block, float clamp, const PairMasks& visible) {
  const size_t count = static_cast<size_t>(block.count);
  uint16_t group[kBlockLights];
  for (size_t l = 0; l < count; ++l) group[l] = groupOf(lights_, block.lightClass, block.index[l]);
  std::vector<uint16_t> present(group, group + count);
  std::sort(present.begin(), present.end());
  present.erase(std::unique(present.begin(), present.end()), present.end());
  for (const uint16_t g : present) {
    PairMasks pairs = visible;
    for (size_t l = 0; l < count; ++l)
      if (group[l] != g)
        std::fill_n(pairs.bits.begin() + static_cast<ptrdiff_t>(l * pairs.strips), pairs.strips,
                    uint16_t{0});
    if (groups_[g].strips.empty()) groups_[g] = emptySums(tile_);
    shade(tile_, block, clamp, pairs, &groups_[g]);
  }
}

void TileParts::addDiffuseLobes(const LightBlock& block, float clamp, const PairMasks& visible) {
  PairMasks pairs = visible;
  for (size_t i = 0; i < static_cast<size_t>(block.count) * pairs.strips; ++i)
    if (lobes_[i % pairs.strips] != Lobes::mixed) pairs.bits[i] = 0;
  shade(diffuse_, block, clamp, pairs, &diffuseSums_);
}

void TileParts::write(const TileSums& sums, size_t layer, std::vector<Rgb>* out) const {
  const size_t points = receivers_.points.size();
  for (size_t s = 0; s < sums.strips.size(); ++s) {
    const PointStrip& strip = tile_.strips[s];
    const TileSums::Strip& sum = sums.strips[s];
    for (size_t lane = 0; lane < kStrip; ++lane) {
      if (!(strip.active >> lane & 1)) continue;
      const size_t i = strip.point[lane];
      (*out)[layer * points + i] =
          receivers_.points[i].weight * Rgb(static_cast<float>(sum.x[lane]),
                                            static_cast<float>(sum.y[lane]),
                                            static_cast<float>(sum.z[lane]));
    }
  }
}

void TileParts::write() const {
  for (size_t g = 0; g < groups_.size(); ++g) write(groups_[g], g, &parts_->groups);
  for (size_t t = 0; t < types_.size(); ++t) write(types_[t], t, &parts_->types);
  for (size_t s = 0; parts_->countRays && s < tile_.strips.size(); ++s)
    for (size_t lane = 0; lane < kStrip; ++lane)
      if (tile_.strips[s].active >> lane & 1)
        parts_->rays[tile_.strips[s].point[lane]] = rays_[s * kStrip + lane];
}

}  // namespace lobelia::gather
