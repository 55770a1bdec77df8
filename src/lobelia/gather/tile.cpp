#include "lobelia/gather/tile.h"

#include <algorithm>
#include <map>

#include "lobelia/bsdf/lobe_kind.h"
#include "lobelia/scene/shading.h"

namespace lobelia::gather {
namespace {

struct Sides {
  bool above = false, below = false;
};

// From which side of the frame can light be scattered to wo?
Sides litSides(const Receivers& receivers, const ReceiverPoint& point, float cosWo) {
  Sides sides;
  for (size_t i = 0; i < point.lobeCount; ++i) {
    const Lobe& lobe = receivers.lobes[point.firstLobe + i];
    const bool behind = cosWo < 0;
    if (cosWo == 0 || (behind && !lobe.twoSided && !lobe.interface)) continue;
    (isTransmission(lobe.type) == behind ? sides.above : sides.below) = true;
  }
  return sides;
}

void setPoint(const Receivers& receivers, size_t index, int lane, PointStrip* strip) {
  const ReceiverPoint& point = receivers.points[index];
  strip->p.set(lane, point.p);
  strip->s.set(lane, point.frame.s);
  strip->t.set(lane, point.frame.t);
  strip->n.set(lane, point.frame.n);
  strip->ng.set(lane, point.ng);
  const bool perturbed = point.bumpAlpha2 > 0;
  strip->base.set(lane, perturbed ? point.baseNormal : point.frame.n);
  strip->bumpAlpha2[lane] = point.bumpAlpha2;
  strip->perturbed = strip->perturbed || perturbed;
  const float nearest = 0.5f * point.nearDistance;
  strip->nearScale[lane] = nearest > 0 ? 1 / nearest : 1e30f;
  strip->squaredNear[lane] = nearest * nearest;
  strip->near = strip->near || nearest > 0;
  const Vec3f wo = point.frame.toLocal(point.wo);
  strip->wo.set(lane, wo);
  strip->front.set(lane, offsetOrigin(point.p, point.ng, point.error, point.ng));
  strip->back.set(lane, offsetOrigin(point.p, point.ng, point.error, -point.ng));
  const Sides sides = litSides(receivers, point, wo.z);
  strip->above[lane] = sides.above ? 1.f : 0.f;
  strip->below[lane] = sides.below ? 1.f : 0.f;
  strip->point[lane] = static_cast<uint32_t>(index);
  strip->depth[lane] = point.depth;
}

void setLobe(const Lobe& lobe, int lane, float tableOffset, LobeStrip* strip) {
  strip->alphaX[lane] = lobe.alphaX;
  strip->alphaY[lane] = lobe.alphaY;
  strip->weight.set(lane, lobe.weight);
  strip->eta.set(lane, lobe.eta);
  strip->k.set(lane, lobe.k);
  strip->parameters.set(lane, lobe.parameters);
  strip->tint.set(lane, lobe.tint);
  strip->sides[lane] = lobe.interface ? 2.f : lobe.twoSided ? 1.f : 0.f;
  strip->tableOffset[lane] = tableOffset;
}

// Copies transmittance tables into one array, each once: lanes then differ by an offset.
class Tables {
 public:
  explicit Tables(std::vector<float>* values) : values_(values) {}
  float offset(const float* table) {
    if (table == nullptr) return 0;
    const auto [it, isNew] = offsets_.try_emplace(table, values_->size());
    if (isNew) values_->insert(values_->end(), table, table + kTransmittanceSize);
    return static_cast<float>(it->second);
  }

 private:
  std::vector<float>* values_;
  std::map<const float*, size_t> offsets_;
};

}  // namespace

LobeKinds kindsOf(const Receivers& receivers, const ReceiverPoint& point) {
  LobeKinds kind{};
  for (size_t i = 0; i < point.lobeCount; ++i) {
    const Lobe& lobe = receivers.lobes[point.firstLobe + i];
    kind[4 * i] = static_cast<uint8_t>(lobe.type);
    kind[4 * i + 1] = static_cast<uint8_t>(lobe.distribution);
    kind[4 * i + 2] = static_cast<uint8_t>(lobe.fresnel);
    // Of microfacets only layers above them matter: their pairing is for sampling.
    const bool whole = lobe.type == LobeType::ward || lobe.type == LobeType::coatedDiffuse;
    kind[4 * i + 3] = whole ? lobe.variant : static_cast<uint8_t>(lobe.variant & kCoated);
  }
  kind.back() = point.lobeCount;
  return kind;
}

Tile makeTile(const Receivers& receivers, size_t begin, size_t end) {
  std::vector<std::pair<LobeKinds, size_t>> order;
  for (size_t i = begin; i < end; ++i) {
    const ReceiverPoint& point = receivers.points[i];
    if (point.lobeCount > 0) order.emplace_back(kindsOf(receivers, point), i);
  }
  std::sort(order.begin(), order.end());

  Tile tile;
  Tables tables(&tile.tables);
  for (size_t i = 0; i < order.size();) {
    PointStrip& strip = tile.strips.emplace_back();
    const LobeKinds& kind = order[i].first;
    size_t count = 0;
    while (count < kStrip && i + count < order.size() && order[i + count].first == kind) ++count;
    strip.active = (1u << count) - 1;
    strip.lobeCount = kind.back();
    strip.firstLobe = tile.lobes.size();
    tile.lobes.resize(tile.lobes.size() + strip.lobeCount);
    for (size_t l = 0; l < strip.lobeCount; ++l) {
      LobeStrip& lobes = tile.lobes[strip.firstLobe + l];
      lobes.type = static_cast<LobeType>(kind[4 * l]);
      lobes.distribution = static_cast<Distribution>(kind[4 * l + 1]);
      lobes.fresnel = static_cast<Fresnel>(kind[4 * l + 2]);
      lobes.variant = kind[4 * l + 3];
    }
    for (size_t lane = 0; lane < kStrip; ++lane) {
      const size_t index = order[i + std::min(lane, count - 1)].second;
      setPoint(receivers, index, static_cast<int>(lane), &strip);
      const ReceiverPoint& point = receivers.points[index];
      for (size_t l = 0; l < strip.lobeCount; ++l) {
        const Lobe& lobe = receivers.lobes[point.firstLobe + l];
        setLobe(lobe, static_cast<int>(lane), tables.offset(lobe.table),
                &tile.lobes[strip.firstLobe + l]);
      }
    }
    i += count;
  }
  return tile;
}

}  // namespace lobelia::gather
