#include "lobelia/gather/light_slices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lobelia/base/error.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/chosen_gather.h"
#include "lobelia/gather/light_forest.h"
#include "lobelia/gather/mrcs_sampling.h"
#include "lobelia/gather/slice_clusters.h"

namespace lobelia::gather {
namespace {

enum : uint64_t { kSliceStream = 1, kClusterStream, kSplitStream, kPowerStream };

// The representatives' rows, without rows to check.
Rows rowsOf(const Receivers& sample, const ReceiverSlices& slices) {
  Rows rows;
  rows.rowCount = slices.count();
  rows.receivers.lobes = sample.lobes;
  for (uint32_t r = 0; r < rows.rowCount; ++r) {
    rows.receivers.points.push_back(sample.points[slices.representative(r)]);
    rows.row.push_back(r);
    rows.check.push_back(RowPixels::kNone);
  }
  return rows;
}

// The rows, the order of the clusters and, of one slice at a time, what is made of its rows.
void requireMemory(const Rows& rows, size_t lights, size_t sliceRows, uint64_t memory) {
  const uint64_t needed =
      (columnBytes(rows, 0) + sizeof(uint32_t) + sliceBytes(std::min(sliceRows, rows.rowCount))) *
      lights;
  if (needed <= memory) return;
  const auto mebibytes = [](uint64_t bytes) { return static_cast<double>(bytes) / (1 << 20); };
  throw UsageError(fmt::format(
      "--memory {:.3g} MiB is too little for the light of {} lights in {} slices, which takes "
      "{:.0f} MiB; allow more, or use fewer --slices or lights, or --gather sglc",
      mebibytes(memory), lights, rows.rowCount, std::ceil(mebibytes(needed))));
}

// Receivers slice by slice, each in the order in which they were given.
struct Sliced {
  Receivers receivers;
  std::vector<uint32_t> order, slice;
};
Sliced bySlice(const Receivers& receivers, const std::optional<ReceiverSlices>& slices) {
  Sliced out;
  std::vector<uint32_t> sliceOf(receivers.points.size(), 0);
  if (slices) {
    parallelFor(sliceOf.size(), 1024,
                [&](size_t i) { sliceOf[i] = slices->sliceOf(receivers.points[i]); });
  }
  out.order.resize(sliceOf.size());
  std::iota(out.order.begin(), out.order.end(), 0u);
  std::stable_sort(out.order.begin(), out.order.end(),
                   [&](uint32_t a, uint32_t b) { return sliceOf[a] < sliceOf[b]; });
  out.receivers.lobes = receivers.lobes;
  for (const uint32_t i : out.order) {
    out.receivers.points.push_back(receivers.points[i]);
    out.slice.push_back(sliceOf[i]);
  }
  return out;
}

// Runs of receivers of one slice that make a tile.
struct TileRange {
  size_t begin, end;
  bool first;  // of its slice
};
std::vector<TileRange> tilesOf(const std::vector<uint32_t>& slice) {
  std::vector<TileRange> tiles;
  for (size_t begin = 0; begin < slice.size();) {
    size_t end = begin;
    while (end < slice.size() && end - begin < kMaxTilePoints && slice[end] == slice[begin]) ++end;
    tiles.push_back({begin, end, begin == 0 || slice[begin - 1] != slice[begin]});
    begin = end;
  }
  return tiles;
}

}  // namespace

LightSlices::LightSlices(const Tracer& tracer, const Receivers& sample, const VirtualLights& lights,
                         const SliceSettings& settings, Context& context)
    : tracer_(tracer), lights_(lights), settings_(settings), numbers_(lights, settings.gather) {
  Receivers lit;  // that gather at all
  lit.lobes = sample.lobes;
  std::copy_if(sample.points.begin(), sample.points.end(), std::back_inserter(lit.points),
               [](const ReceiverPoint& p) { return p.lobeCount > 0; });
  if (numbers_.count() <= settings.columns) {
    chooseAll();
  } else if (lit.points.empty()) {
    chooseByPower();
  } else {
    choose(tracer, lit, context);
  }
  prepared_ = prepareLights(lights, tracer.scene());
}

void LightSlices::chooseAll() {
  std::vector<ChosenLight>& all = chosen_.emplace_back();
  for (size_t i = 0; i < numbers_.count(); ++i) all.push_back(numbers_.at(i));
}

// Evenly spaced draws, half of their probability by power.
void LightSlices::chooseByPower() {
  constexpr double kPowerShare = 0.5;
  std::vector<ChosenLight>& chosen = chosen_.emplace_back();
  const auto powerOf = [&](const ChosenLight& light) {
    return double{luminance(lightPower(lights_, light.lightClass, light.index))};
  };
  const double count = static_cast<double>(numbers_.count());
  const double draws = static_cast<double>(settings_.columns);
  double total = 0;
  for (size_t i = 0; i < numbers_.count(); ++i) total += powerOf(numbers_.at(i));
  double left = uniformNumber(hashCombine(settings_.seed, kPowerStream), 0);  // to the next draw
  for (size_t i = 0; i < numbers_.count(); ++i) {
    ChosenLight light = numbers_.at(i);
    const double even = 1 / count;
    const double probability =
        total > 0 ? kPowerShare * powerOf(light) / total + (1 - kPowerShare) * even : even;
    double times = 0;
    for (left -= draws * probability; left < 0; ++left) ++times;
    if (times == 0) continue;
    light.scale = Rgb(static_cast<float>(times / (draws * probability)));
    chosen.push_back(light);
  }
}

void LightSlices::choose(const Tracer& tracer, const Receivers& sample, Context& context) {
  slices_.emplace(sample, settings_.slices, 2 * tracer.bounds().radius(),
                  hashCombine(settings_.seed, kSliceStream));
  const Rows rows = rowsOf(sample, *slices_);
  requireMemory(rows, numbers_.count(), settings_.rows, settings_.memory);
  ColumnSettings columnSettings;
  columnSettings.gather = settings_.gather;
  columnSettings.dims = 0;
  const LightColumns columns =
      computeColumns(tracer, rows, lights_, numbers_, columnSettings, context);
  if (context.cancelled()) return;
  ClusterSettings clusterSettings;
  clusterSettings.count = std::max<size_t>(
      1, static_cast<size_t>(settings_.globalShare * static_cast<double>(settings_.columns)));
  clusterSettings.seed = hashCombine(settings_.seed, kClusterStream);
  const Clustering global = clusterLights(columns, clusterSettings, context);
  const StageTimer timer(context, "cluster");
  chosen_.resize(slices_->count());
  for (size_t s = 0; s < chosen_.size() && !context.cancelled(); ++s) {
    const uint64_t seed = hashCombine(hashCombine(settings_.seed, kSplitStream), s);
    for (const Representative& r : chooseForSlice(
             columns, global, rowsOfSlice(*slices_, s, settings_.rows), settings_.columns, seed)) {
      chosen_[s].push_back(numbers_.at(r.light));
      chosen_[s].back().scale = r.scale;
    }
    context.progress("cluster", static_cast<double>(s + 1) / static_cast<double>(chosen_.size()));
  }
}

double LightSlices::lightsPerSlice() const {
  size_t sum = 0;
  for (const auto& chosen : chosen_) sum += chosen.size();
  return static_cast<double>(sum) / static_cast<double>(chosen_.size());
}

void LightSlices::gather(const Receivers& receivers, uint32_t onlyPixel, std::span<Rgb> radiance,
                         Context& context, GatherParts* parts) const {
  const size_t points = receivers.points.size();
  if (radiance.size() != points)
    throw std::invalid_argument("LightSlices::gather: one radiance value per receiver point");
  const Sliced sliced = bySlice(receivers, slices_);
  const std::vector<TileRange> tiles = tilesOf(sliced.slice);
  std::optional<GatherParts> ordered;
  if (parts != nullptr) {
    ordered = *parts;
    ordered->reset(points);
  }
  gatherInParallel(tiles.size(), 1, context, [&](size_t begin, size_t end, GatherTally* tally) {
    ChosenGather gather(tracer_, sliced.receivers, sliced.order, lights_, prepared_,
                        settings_.gather, ordered ? &*ordered : nullptr);
    for (size_t t = begin; t < end && !context.cancelled(); ++t) {
      const TileRange& range = tiles[t];
      if (!holdsPixel(sliced.receivers, range.begin, range.end, onlyPixel)) continue;
      const std::vector<ChosenLight>& chosen = chosen_[sliced.slice[range.begin]];
      if (range.first) {
        ++tally->clusters;
        tally->lights += chosen.size();
        tally->clusteredLights += numbers_.count();
      }
      tally->clusteredReceivers += range.end - range.begin;
      gather.add(gather.tileOf(range.begin, range.end), chosen, radiance, tally);
    }
  });
  if (parts != nullptr) parts->setOrdered(*ordered, sliced.order, points);
}

}  // namespace lobelia::gather
