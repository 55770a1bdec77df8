#include "lobelia/gather/chosen_gather.h"

#include <algorithm>
#include <mutex>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/cut_kernels.h"
#include "lobelia/gather/facing_pairs.h"
#include "lobelia/gather/light_range.h"
#include "lobelia/gather/tile_parts.h"

namespace lobelia::gather {

void GatherTally::noteBad(uint32_t pixel) {
  if (!firstBad || pixel < *firstBad) firstBad = pixel;
}

void GatherTally::add(const GatherTally& o) {
  rays += o.rays, sharedRays += o.sharedRays, pairs += o.pairs, nonfinite += o.nonfinite,
      evaluations += o.evaluations;
  clusters += o.clusters, clusteredReceivers += o.clusteredReceivers;
  lights += o.lights, clusteredLights += o.clusteredLights, missed += o.missed;
  traverseNs += o.traverseNs, visibilityNs += o.visibilityNs, shadeNs += o.shadeNs;
  if (o.firstBad) noteBad(*o.firstBad);
}

void GatherTally::book(Context& context) const {
  const double toSeconds = 1e-9 / threadCount();
  Statistics& s = context.statistics;
  s.addCount("shadow_rays", rays);
  s.addCount("shared_rays", sharedRays);
  s.addCount("node_pairs_visited", evaluations);
  s.addCount("node_pairs_shaded", pairs);
  s.addCount("nonfinite", nonfinite);
  s.addCount("cut_lights", lights);
  s.addCount("receiver_clusters", clusters);
  s.addCount("clustered_receivers", clusteredReceivers);
  s.addCount("clustered_lights", clusteredLights);
  s.addCount("error_missed", missed);
  s.addSeconds("traverse", static_cast<double>(traverseNs) * toSeconds);
  s.addSeconds("visibility", static_cast<double>(visibilityNs) * toSeconds);
  s.addSeconds("shade", static_cast<double>(shadeNs) * toSeconds);
  if (firstBad) noteNonFinitePixel(*firstBad, context);
}

void gatherInParallel(size_t count, size_t grain, Context& context,
                      const std::function<void(size_t, size_t, GatherTally*)>& run) {
  GatherTally all;
  std::mutex mutex;
  size_t done = 0;
  parallelRanges(count, grain, [&](size_t begin, size_t end) {
    GatherTally tally;
    run(begin, end, &tally);
    const std::lock_guard lock(mutex);
    all.add(tally);
    done += end - begin;
    context.progress("gather", static_cast<double>(done) / static_cast<double>(count));
  });
  all.book(context);
}

// Do the receivers of a strip see the same of the lights? Of each, for how many lights it is unlike
// most.
class ChosenGather::Agreement {
 public:
  // Bits per receiver: those that a light faces, and those that it reaches.
  void add(uint32_t facing, uint32_t visible) {
    ++asked_;
    const bool mostly = 2 * __builtin_popcount(visible) >= __builtin_popcount(facing);
    const uint32_t unlike = mostly ? facing & ~visible : visible;
    const uint32_t lit = mostly ? facing : visible;
    for (int lane = 0; lane < kStrip; ++lane) {
      unlike_[lane] += unlike >> lane & 1;
      lit_[lane] += lit >> lane & 1;
    }
  }
  bool agree() const {
    if (asked_ < 2) return false;
    for (int lane = 0; lane < kStrip; ++lane)
      if (unlike_[lane] > 1 &&
          static_cast<float>(unlike_[lane]) > kUnlike * static_cast<float>(lit_[lane]))
        return false;
    return true;
  }

 private:
  // Of the lights that most or this one see. One light alone tells of nothing.
  static constexpr float kUnlike = 0.2f;
  uint32_t asked_ = 0;
  uint32_t unlike_[kStrip] = {}, lit_[kStrip] = {};
};

ChosenGather::ChosenGather(const Tracer& tracer, const Receivers& receivers,
                           std::span<const uint32_t> order, const VirtualLights& lights,
                           const PreparedLights& prepared, const GatherSettings& settings,
                           GatherParts* parts)
    : tracer_(tracer),
      receivers_(receivers),
      order_(order),
      lights_(lights),
      prepared_(prepared),
      settings_(settings),
      parts_(parts) {}

Tile ChosenGather::tileOf(size_t begin, size_t end) const {
  Tile tile = makeTile(receivers_, begin, end);
  if (!lights_.spherical.empty()) addSampling(receivers_, &tile);
  return tile;
}

void ChosenGather::add(const Tile& tile, std::span<const ChosenLight> chosen,
                       std::span<Rgb> radiance, GatherTally* tally, uint64_t seed) {
  if (tile.strips.empty()) return;
  TileSums sums;
  sums.strips.resize(tile.strips.size());
  std::optional<TileParts> parts;
  if (parts_ != nullptr) parts.emplace(receivers_, lights_, tile, parts_);
  for (const LightClass lightClass : kLightClasses) {
    if (parts) parts->beginClass(sums);
    Agreement agreement;
    while (!chosen.empty() && chosen[0].lightClass == lightClass) {
      size_t count = 1;
      while (count < std::min(kBlockLights, chosen.size()) &&
             chosen[count].lightClass == lightClass && chosen[count].rays == chosen[0].rays)
        ++count;
      addBlock(tile, chosen.first(count), seed, &agreement, &sums, parts ? &*parts : nullptr,
               tally);
      chosen = chosen.subspan(count);
    }
    if (parts) parts->endClass(lightClass, sums);
  }
  if (parts) parts->write();
  tally->pairs += sums.pairs;
  tally->nonfinite += sums.nonfinite;
  write(tile, sums, radiance, tally);
}

void ChosenGather::addBlock(const Tile& tile, std::span<const ChosenLight> chosen, uint64_t seed,
                            Agreement* agreement, TileSums* sums, TileParts* parts,
                            GatherTally* tally) {
  const int64_t start = nanosecondsNow();
  uint32_t indices[kBlockLights];
  for (size_t i = 0; i < chosen.size(); ++i) indices[i] = static_cast<uint32_t>(chosen[i].index);
  prepareChosen(lights_, tracer_.scene(), chosen[0].lightClass, {indices, chosen.size()}, &block_,
                prepared_);
  for (size_t i = 0; i < chosen.size(); ++i) block_.lights[i].intensity *= chosen[i].scale;
  allowPairs(tile, block_, lights_, settings_, &pairs_);
  if (parts != nullptr) parts->watchRays(&pairs_);
  const int64_t prepared = nanosecondsNow();
  const uint64_t own =
      hashCombine(hashCombine(seed, static_cast<uint64_t>(chosen[0].lightClass)), indices[0]);
  const ChosenLight::Rays rays = chosen[0].rays;
  uint16_t facing[kBlockLights];
  if (rays == ChosenLight::Rays::pilot) {
    keepFacing(tile, block_, &pairs_);
    for (size_t i = 0; i < chosen.size(); ++i) facing[i] = pairs_.at(i, 0);
  }
  const bool byOne = rays == ChosenLight::Rays::shared && agreement->agree();
  const size_t rayCount = byOne ? keepVisibleByOne(tile, block_, tracer_, own, &pairs_)
                                : keepVisible(tile, block_, tracer_, &pairs_);
  tally->rays += rayCount;
  if (byOne) tally->sharedRays += rayCount;
  if (rays == ChosenLight::Rays::pilot)
    for (size_t i = 0; i < chosen.size(); ++i) agreement->add(facing[i], pairs_.at(i, 0));
  const int64_t traced = nanosecondsNow();
  shade(tile, block_, settings_.clamp, pairs_, sums);
  if (parts != nullptr) parts->add(block_, settings_.clamp, pairs_);
  tally->traverseNs += prepared - start;
  tally->visibilityNs += traced - prepared;
  tally->shadeNs += nanosecondsNow() - traced;
}

void ChosenGather::write(const Tile& tile, const TileSums& sums, std::span<Rgb> radiance,
                         GatherTally* tally) const {
  for (size_t s = 0; s < tile.strips.size(); ++s) {
    const PointStrip& strip = tile.strips[s];
    const TileSums::Strip& sum = sums.strips[s];
    for (size_t lane = 0; lane < kStrip; ++lane) {
      if (!(strip.active >> lane & 1)) continue;
      const size_t i = strip.point[lane];
      const ReceiverPoint& point = receivers_.points[i];
      radiance[order_[i]] +=
          point.weight * Rgb(static_cast<float>(sum.x[lane]), static_cast<float>(sum.y[lane]),
                             static_cast<float>(sum.z[lane]));
      if ((sum.nonfinite >> lane & 1) != 0) tally->noteBad(point.pixel);
    }
  }
}

}  // namespace lobelia::gather
