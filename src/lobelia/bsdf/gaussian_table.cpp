// Tables of mixtures for isotropic lobes without Fresnel factor, over alpha and the angle of
// incidence. Between the table's angles two mixtures are blended, each turned so that its mirror
// direction is the lobe's; between its alphas a mixture is scaled about the mirror direction.
//
// An entry is fitted when it is first looked up: a scene of a few materials needs a small part of a
// table, whose fits would take longer than a small picture.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <vector>

#include "lobelia/bsdf/gaussian_mixture.h"
#include "lobelia/bsdf/lobe_sampling.h"
#include "lobelia/bsdf/scalar_lobe.h"

namespace lobelia {
namespace {

constexpr int kAlphas = 18, kAngles = 24;
constexpr float kAlphaMin = 0.03f, kAlphaMax = 1.f;
constexpr uint32_t kFitSamples = 256, kTestSamples = 1024;
constexpr int kIterations = 16;

// A Gaussian of the table, its axis in the plane of incidence, at an angle from the mirror
// direction (positive: away from the normal).
struct TablePart {
  float offset, sharpness, share;
};
using Entry = std::array<TablePart, kTableParts>;

// Denser than logarithmic towards rough lobes, whose shape changes with alpha; small alphas only
// change its scale.
float alphaAt(int i) {
  const float x = static_cast<float>(i) / static_cast<float>(kAlphas - 1);
  return kAlphaMin + (kAlphaMax - kAlphaMin) * x * x;
}
// Uniform in the square root of the cosine, which resolves grazing angles; the last is almost
// there.
float cosineAt(int i) {
  const float s = 1 - 0.97f * static_cast<float>(i) / static_cast<float>(kAngles - 1);
  return s * s;
}

std::vector<LobeSample> drawSamples(const Lobe& lobe, Vec3f wo, uint32_t count) {
  const float n = static_cast<float>(count);
  std::vector<LobeSample> samples;
  for (uint32_t i = 0; i < count; ++i) {
    uint32_t reversed = 0;
    for (uint32_t bit = 1, to = count >> 1; to > 0; bit <<= 1, to >>= 1) {
      if (i & bit) reversed |= to;
    }
    const auto w = sampleLobe(
        lobe, wo, {(static_cast<float>(i) + 0.5f) / n, (static_cast<float>(reversed) + 0.5f) / n});
    if (!w || !(w->z > 0)) continue;
    const float density = lobePdf(lobe, wo, *w);
    const float weight = density > 0 ? evaluateLobe(lobe, wo, *w).x / density : 0.f;
    if (weight > 0) samples.push_back({*w, weight, 1 / (n * density)});
  }
  return samples;
}

// Start of a fit: half of the parts narrow, half wide, spread over the plane of incidence by
// quantiles.
std::array<ShapePart, kTableParts> spreadParts(std::span<const LobeSample> samples, float alpha) {
  std::vector<float> angles;
  for (const LobeSample& s : samples) angles.push_back(std::atan2(-s.w.x, s.w.z));
  std::sort(angles.begin(), angles.end());
  std::array<ShapePart, kTableParts> parts;
  constexpr size_t kHalf = kTableParts / 2;
  for (size_t j = 0; j < kTableParts; ++j) {
    const float at = angles[angles.size() * (2 * (j % kHalf) + 1) / (2 * kHalf)];
    parts[j] = {{-std::sin(at), 0, std::cos(at)},
                (j < kHalf ? 1.5f : 0.2f) / (alpha * alpha),
                1.f / kTableParts};
  }
  return parts;
}

Entry fitEntry(Lobe lobe, float alpha, float cosine) {
  lobe.alphaX = lobe.alphaY = alpha;
  const Vec3f wo(std::sqrt(1 - cosine * cosine), 0, cosine);
  const std::vector<LobeSample> samples = drawSamples(lobe, wo, kFitSamples);
  const std::vector<LobeSample> tests = drawSamples(lobe, wo, kTestSamples);
  // Expectation maximisation finds local optima of a likelihood; the best of several by the
  // distance that counts, the closed form among them.
  std::array<ShapePart, kTableParts> row{}, best{};
  const int rowCount = rowShape(lobe, wo, false, row);
  float bestError = 1e30f;
  for (int candidate = 0; candidate < 5; ++candidate) {
    const bool fromRow = candidate < 3;
    std::array<ShapePart, kTableParts> parts = fromRow ? row : spreadParts(samples, alpha);
    const auto used = std::span(parts).first(fromRow ? static_cast<size_t>(rowCount)
                                                     : static_cast<size_t>(kTableParts));
    if (candidate > 0) fitMixture(samples, kIterations, candidate % 2 == 1, used);
    const float error = mixtureError(tests, used);
    if (error < bestError) bestError = error, best = parts;
  }
  Entry entry;
  const float mirror = std::acos(cosine);
  for (size_t j = 0; j < kTableParts; ++j) {
    if (!(best[j].share > 0)) {
      entry[j] = {0, 1, 0};
      continue;
    }
    entry[j] = {std::atan2(-best[j].axis.x, best[j].axis.z) - mirror, best[j].sharpness,
                best[j].share};
  }
  return entry;
}

class ShapeTable {
 public:
  explicit ShapeTable(const Lobe& lobe) : lobe_(lobe) {}
  ShapeTable(const ShapeTable&) = delete;
  ShapeTable& operator=(const ShapeTable&) = delete;
  ~ShapeTable() {
    for (std::atomic<const Entry*>& entry : entries_) delete entry.load();
  }

  int lookUp(float alpha, Vec3f wo, std::span<ShapePart> parts) const {
    const Node row =
        nodeOf(std::sqrt(std::max(alpha - kAlphaMin, 0.f) / (kAlphaMax - kAlphaMin)), kAlphas);
    const Node column = nodeOf((1 - std::sqrt(wo.z)) / 0.97f, kAngles);
    const float sine = std::sqrt(wo.x * wo.x + wo.y * wo.y);
    const Place place{std::atan2(sine, wo.z), alpha,
                      sine > 0 ? Vec3f(-wo.x / sine, -wo.y / sine, 0) : Vec3f(1, 0, 0)};
    // As many of the four entries around as there is room for.
    const bool blendRows = parts.size() >= 4 * kTableParts;
    const bool blendColumns = parts.size() >= 2 * kTableParts;
    int count = 0;
    for (int i = 0; i < 2; ++i) {
      const float wa = blendRows ? row.weight(i) : row.nearest(i);
      for (int j = 0; j < 2; ++j) {
        const float wc = blendColumns ? column.weight(j) : column.nearest(j);
        if (wa * wc > 0) put(row.index + i, column.index + j, place, wa * wc, parts, &count);
      }
    }
    return count;
  }

 private:
  struct Node {
    int index;  // and index + 1
    float t;
    float weight(int i) const { return i == 0 ? 1 - t : t; }
    float nearest(int i) const { return (i == 1) == (t >= 0.5f) ? 1.f : 0.f; }
  };
  static Node nodeOf(float x, int count) {
    const float scaled = std::clamp(x, 0.f, 1.f) * static_cast<float>(count - 1);
    const int i = std::min(static_cast<int>(scaled), count - 2);
    return {i, scaled - static_cast<float>(i)};
  }
  struct Place {
    float mirror, alpha;
    Vec3f side;
  };
  // Threads that want an entry at once all fit it, and the same: none waits for another, which may
  // be at work for it.
  const Entry& entry(int row, int column) const {
    std::atomic<const Entry*>& place = entries_[static_cast<size_t>(row * kAngles + column)];
    const Entry* known = place.load(std::memory_order_acquire);
    if (known != nullptr) return *known;
    auto own = std::make_unique<const Entry>(fitEntry(lobe_, alphaAt(row), cosineAt(column)));
    if (place.compare_exchange_strong(known, own.get(), std::memory_order_acq_rel))
      known = own.release();
    return *known;
  }
  void put(int row, int column, const Place& place, float weight, std::span<ShapePart> parts,
           int* count) const {
    const float scale = place.alpha / alphaAt(row);
    for (const TablePart& p : entry(row, column)) {
      if (!(p.share * weight > 1e-4f)) continue;
      const float angle = std::clamp(place.mirror + p.offset * scale, -1.56f, 1.56f);
      parts[static_cast<size_t>((*count)++)] = {
          place.side * std::sin(angle) + Vec3f(0, 0, std::cos(angle)),
          p.sharpness / (scale * scale), p.share * weight};
    }
  }
  const Lobe lobe_;
  mutable std::array<std::atomic<const Entry*>, kAlphas * kAngles> entries_{};
};

Lobe prototype(LobeType type, Distribution distribution, uint8_t variant) {
  Lobe lobe;
  lobe.type = type;
  lobe.distribution = distribution;
  lobe.variant = variant;
  return lobe;
}

// Of the process. The phong distribution of micro-normals is Beckmann's for
// this purpose, as are the two weights of Ward's model each other's.
const ShapeTable* tableOf(const Lobe& lobe) {
  using enum LobeType;
  if (lobe.type == ward) {
    static const ShapeTable table(prototype(ward, Distribution::beckmann, 1));
    return &table;
  }
  if (lobe.type != microfacetReflection) return nullptr;
  if (lobe.distribution == Distribution::ggx) {
    static const ShapeTable table(prototype(microfacetReflection, Distribution::ggx, 0));
    return &table;
  }
  if (lobe.distribution == Distribution::sphericalGaussian) {
    static const ShapeTable table(
        prototype(microfacetReflection, Distribution::sphericalGaussian, 0));
    return &table;
  }
  if (lobe.distribution == Distribution::gtr1) return nullptr;
  static const ShapeTable table(prototype(microfacetReflection, Distribution::beckmann, 0));
  return &table;
}

}  // namespace

int tabulatedShape(const Lobe& lobe, Vec3f wo, std::span<ShapePart> parts) {
  if (parts.size() < kTableParts || lobe.alphaX != lobe.alphaY) return 0;
  const ShapeTable* table = tableOf(lobe);
  if (!table) return 0;
  const int count = table->lookUp(std::max(lobe.alphaX, 1e-4f), wo, parts);
  float sum = 0;
  for (int i = 0; i < count; ++i) {
    ShapePart& p = parts[static_cast<size_t>(i)];
    // Fresnel at the micro-normal that reflects to the axis.
    if (lobe.type == LobeType::microfacetReflection && lobe.fresnel != Fresnel::one) {
      const Rgb f = fresnelOf(lobe, dot(wo, normalize(wo + p.axis)), false);
      p.share *= f.x + f.y + f.z;
    }
    sum += p.share;
  }
  if (!(sum > 0)) return 0;
  for (int i = 0; i < count; ++i) parts[static_cast<size_t>(i)].share /= sum;
  return count;
}

}  // namespace lobelia
