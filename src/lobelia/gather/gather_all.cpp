// Brute force: all virtual lights at all receivers, the reference of every other strategy.
//
// Receivers are taken in tiles of neighbours (tile.h), lights in blocks; per tile and block, shadow
// rays are traced in full coherent packets (visibility-inl.h) and visible pairs are shaded in SIMD
// registers with the exact lobes of the receivers (shading-inl.h).
//
// The light of virtual light y at receiver x is
//   weight * f(x; wo, wi) * V(x, y) * L(y -> x),  f with its cosine,
//   L = intensity * lobe / d^2: lobe = 1 (omni), [n.w]+ (diffuse), exp(sharpness (axis.w - 1)) for
//   n.w > 0 (glossy); L = irradiance for directional lights,
// and with a clamp c > 0 the product (lobe / d^2) * f is scaled so that its largest channel is at
// most c (one factor for the three, which keeps the hue; the papers clamp grey values [Hasan09
// section 2]); directional lights have no singularity and are never clamped.
//
// The sum at a point runs over the lights in their order, in float within a block of 32 and in
// double over the blocks: it does not depend on threads. Nor does it on how points share tiles, but
// for spherical lights, whose directions are drawn by what the points of a strip have in common.
#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/facing_pairs.h"
#include "lobelia/gather/gather.h"
#include "lobelia/gather/kernels.h"
#include "lobelia/gather/light_range.h"
#include "lobelia/gather/rich_radiance.h"
#include "lobelia/gather/shadow_choice.h"
#include "lobelia/gather/tile_parts.h"

namespace lobelia {
namespace {

using namespace gather;

constexpr uint64_t kShadowStream = 0x736861646f77;

struct Tally {
  uint64_t rays = 0, pairs = 0, nonfinite = 0;
  std::optional<uint32_t> firstBad;  // the smallest pixel with a pair that was not finite
  int64_t visibilityNs = 0, shadeNs = 0;
};

class TileGather {
 public:
  TileGather(const Tracer& tracer, const Receivers& receivers, const VirtualLights& lights,
             const GatherSettings& settings, GatherParts* parts, const Context& context)
      : tracer_(tracer),
        receivers_(receivers),
        lights_(lights),
        settings_(settings),
        parts_(parts),
        context_(context),
        near_(lights, rangeForDepth(lights, LightClass::spherical, settings, 0).begin) {
    // Of the near field a tile prepares what reaches it.
    prepared_ = prepareLights(lights, tracer.scene(), !near_.used());
  }

  // False when cancelled before the end: then nothing was added to radiance.
  bool run(size_t begin, size_t end, std::span<Rgb> radiance, Tally* tally) const {
    Tile tile = makeTile(receivers_, begin, end);
    if (tile.strips.empty()) return true;
    if (!lights_.spherical.empty()) addSampling(receivers_, &tile);
    TileSums sums;
    sums.strips.resize(tile.strips.size());
    std::optional<TileParts> parts;
    if (parts_ != nullptr) parts.emplace(receivers_, lights_, tile, parts_);
    for (const LightClass lightClass : kLightClasses) {
      if (parts) parts->beginClass(sums);
      if (!addClass(tile, lightClass, &sums, parts ? &*parts : nullptr, tally)) return false;
      if (parts) parts->endClass(lightClass, sums);
    }
    if (parts) parts->write();
    tally->pairs += sums.pairs;
    tally->nonfinite += sums.nonfinite;
    for (size_t s = 0; s < tile.strips.size(); ++s) {
      write(tile.strips[s], sums.strips[s], radiance);
      if (sums.strips[s].nonfinite != 0) noteFirstBad(tile.strips[s], sums.strips[s], tally);
    }
    return true;
  }

 private:
  bool addClass(const Tile& tile, LightClass lightClass, TileSums* sums, TileParts* parts,
                Tally* tally) const {
    int smallestDepth = 255;
    for (const PointStrip& strip : tile.strips)
      for (const uint8_t depth : strip.depth) smallestDepth = std::min<int>(smallestDepth, depth);
    const LightRange range = rangeForDepth(lights_, lightClass, settings_, smallestDepth);
    const bool near = near_.used() && lightClass == LightClass::spherical;
    const std::vector<Bounds3f> bounds = near ? NearField::boundsOf(tile) : std::vector<Bounds3f>();
    const bool gaussian = lightClass == LightClass::gaussian;
    if (gaussian && settings_.shadowRays > 0 && range.size() > 0)
      return addByChoice(tile, range, sums, tally);
    LightBlock block;
    PairMasks pairs;
    for (size_t first = range.begin; first < range.end; first += kBlockLights) {
      if (context_.cancelled()) return false;
      const size_t count = std::min(kBlockLights, range.end - first);
      const uint32_t wanted = near ? near_.reaching(bounds, first, count) : ~0u;
      if (wanted == 0) continue;
      prepare(lights_, tracer_.scene(), lightClass, first, count, &block, prepared_, wanted);
      if (settings_.rich != nullptr && lightClass == LightClass::diffuse)
        settings_.rich->unpack(&block);
      block.depthMaps = settings_.depthMaps;
      allowPairs(tile, block, lights_, settings_, &pairs);
      if (parts != nullptr) parts->watchRays(&pairs);
      const int64_t start = nanosecondsNow();
      if (gaussian && settings_.shadowRays == 0) {
        keepFacing(tile, block, &pairs);
      } else {
        tally->rays += keepVisible(tile, block, tracer_, &pairs);
      }
      const int64_t traced = nanosecondsNow();
      shade(tile, block, settings_.clamp, pairs, sums);
      if (parts != nullptr) parts->add(block, settings_.clamp, pairs);
      tally->visibilityNs += traced - start;
      tally->shadeNs += nanosecondsNow() - traced;
    }
    return true;
  }

  bool addByChoice(const Tile& tile, const LightRange& range, TileSums* sums, Tally* tally) const {
    if (context_.cancelled()) return false;
    const ShadowScene scene{tracer_, lights_, prepared_, settings_};
    ShadowChoice choice(scene, tile, hashCombine(kShadowStream, lights_.seed));
    tally->rays += choice.add(range.begin, range.end, sums);
    tally->visibilityNs += choice.visibilityNs;
    tally->shadeNs += choice.shadeNs;
    return true;
  }

  void write(const PointStrip& strip, const TileSums::Strip& sum, std::span<Rgb> radiance) const {
    for (size_t lane = 0; lane < kStrip; ++lane) {
      if (!(strip.active >> lane & 1)) continue;
      const size_t i = strip.point[lane];
      radiance[i] += receivers_.points[i].weight * Rgb(static_cast<float>(sum.x[lane]),
                                                       static_cast<float>(sum.y[lane]),
                                                       static_cast<float>(sum.z[lane]));
    }
  }

  void noteFirstBad(const PointStrip& strip, const TileSums::Strip& sum, Tally* tally) const {
    for (size_t lane = 0; lane < kStrip; ++lane) {
      if (!((strip.active & sum.nonfinite) >> lane & 1)) continue;
      const uint32_t pixel = receivers_.points[strip.point[lane]].pixel;
      if (!tally->firstBad || pixel < *tally->firstBad) tally->firstBad = pixel;
    }
  }

  const Tracer& tracer_;
  const Receivers& receivers_;
  const VirtualLights& lights_;
  const GatherSettings& settings_;
  GatherParts* parts_;
  const Context& context_;
  const NearField near_;
  PreparedLights prepared_;
};

// Layers of values, [layer][point].
template <class T>
void reorder(const std::vector<T>& from, const std::vector<uint32_t>& order, size_t count,
             std::vector<T>* to) {
  for (size_t i = 0; i < from.size(); ++i)
    (*to)[i / order.size() * count + order[i % order.size()]] = from[i];
}

// Few points in smaller tiles, so that all threads get some. By the points alone: a ray's answer
// may, in rare rounding cases, depend on its companions in a packet.
size_t tilePoints(size_t points) {
  size_t size = kMaxTilePoints;
  while (size > kStrip && points / size < 32) size /= 2;
  return size;
}

}  // namespace

bool holdsPixel(const Receivers& receivers, size_t begin, size_t end, uint32_t pixel) {
  if (pixel == GatherSettings::kAllPixels) return true;
  return std::any_of(receivers.points.begin() + static_cast<ptrdiff_t>(begin),
                     receivers.points.begin() + static_cast<ptrdiff_t>(end),
                     [&](const ReceiverPoint& r) { return r.pixel == pixel; });
}

void GatherParts::reset(size_t points) {
  groups.assign(groupCount * points, Rgb{});
  types.assign(byType ? kTypes * points : 0, Rgb{});
  rays.assign(countRays ? points : 0, 0);
}

void GatherParts::setOrdered(const GatherParts& from, const std::vector<uint32_t>& order,
                             size_t points) {
  reset(points);
  reorder(from.groups, order, points, &groups);
  reorder(from.types, order, points, &types);
  reorder(from.rays, order, points, &rays);
}

void gatherAll(const Tracer& tracer, const Receivers& receivers, const VirtualLights& lights,
               const GatherSettings& settings, std::span<Rgb> radiance, Context& context,
               GatherParts* parts) {
  const size_t points = receivers.points.size();
  if (radiance.size() != points)
    throw std::invalid_argument("gatherAll: one radiance value per receiver point");
  const size_t size = tilePoints(points);
  const size_t tiles = (points + size - 1) / size;
  if (parts != nullptr) parts->reset(points);
  const TileGather tileGather(tracer, receivers, lights, settings, parts, context);
  std::atomic<uint64_t> rays{0}, pairs{0}, nonfinite{0};
  std::atomic<int64_t> visibilityNs{0}, shadeNs{0};
  std::atomic<size_t> done{0};
  std::mutex badMutex;
  parallelFor(tiles, 1, [&](size_t i) {
    if (context.cancelled()) return;
    if (!holdsPixel(receivers, i * size, std::min(points, (i + 1) * size), settings.onlyPixel))
      return;
    Tally tally;
    tileGather.run(i * size, std::min(points, (i + 1) * size), radiance, &tally);
    rays += tally.rays;
    pairs += tally.pairs;
    nonfinite += tally.nonfinite;
    if (tally.firstBad) {
      const std::lock_guard lock(badMutex);
      noteNonFinitePixel(*tally.firstBad, context);
    }
    visibilityNs += tally.visibilityNs;
    shadeNs += tally.shadeNs;
    context.progress("gather", static_cast<double>(++done) / static_cast<double>(tiles));
  });
  const double toSeconds = 1e-9 / threadCount();
  context.statistics.addCount("shadow_rays", rays);
  context.statistics.addCount("node_pairs_shaded", pairs);
  context.statistics.addCount("nonfinite", nonfinite);
  context.statistics.addSeconds("visibility", static_cast<double>(visibilityNs) * toSeconds);
  context.statistics.addSeconds("shade", static_cast<double>(shadeNs) * toSeconds);
}

}  // namespace lobelia
