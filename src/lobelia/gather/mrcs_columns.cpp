#include "lobelia/gather/mrcs_columns.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"

namespace lobelia::gather {
namespace {

// The lights are dealt out in so many shares, whose sums are added in their order.
constexpr size_t kShares = 256;
// Shorter columns count as not seen.
constexpr float kLeastLength = 1e-36f;

size_t padded(size_t n) { return (n + kMrcsLanes - 1) / kMrcsLanes * kMrcsLanes; }

AlignedFloats randomSigns(size_t count, float size, uint64_t seed) {
  AlignedFloats signs(count);
  for (size_t i = 0; i < count; ++i)
    signs[i] = (hashCombine(seed, i / 64) >> (i % 64) & 1) != 0 ? size : -size;
  return signs;
}

double square(double x) { return x * x; }
Vec3d square(Vec3d v) { return v * v; }

double squaredLength(const float* v, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; ++i) sum += double{v[i]} * double{v[i]};
  return sum;
}

struct Share {
  std::vector<double> total;  // sum of the columns
  double hardlySeen = 0;      // sum of lengths of the columns that at most one row sees
  size_t hardlySeenCount = 0;
  float least = 3e38f;  // length of a column
  uint64_t rays = 0, pairs = 0, nonfinite = 0;
};

class Maker {
 public:
  Maker(const Tracer& tracer, const Rows& rows, const VirtualLights& lights,
        const LightNumbers& numbers, const ColumnSettings& settings, LightColumns* out)
      : tracer_(tracer),
        rows_(rows),
        lights_(lights),
        numbers_(numbers),
        settings_(settings),
        rowValues_(3 * rows.rowCount),
        values_(rowValues_ + 3 * rows.checkCount),
        out_(*out) {
    const size_t points = rows.receivers.points.size();
    for (size_t begin = 0; begin < points; begin += kMaxTilePoints) {
      tiles_.push_back(makeTile(rows.receivers, begin, std::min(points, begin + kMaxTilePoints)));
      if (!lights.spherical.empty()) addSampling(rows.receivers, &tiles_.back());
    }
    if (settings.dims == 0) {
      out_.dims = padded(rowValues_);
      out_.checkDims = padded(values_ - rowValues_);
      out_.whole.assign(numbers.count() * out_.stride(), 0.f);
    } else {
      out_.dims = padded(settings.dims);
      out_.checkDims = kCheckDims;
      out_.halves.assign(numbers.count() * out_.stride(), 0);
      signs_ = randomSigns(rowValues_ * out_.dims, 1 / std::sqrt(static_cast<float>(out_.dims)),
                           settings.seed);
      checkSigns_ = randomSigns((values_ - rowValues_) * kCheckDims,
                                1 / std::sqrt(static_cast<float>(kCheckDims)), ~settings.seed);
    }
    out_.count = numbers.count();
    out_.weight.resize(out_.count);
    out_.scale.resize(out_.count);
    if (settings.channels) out_.channels.resize(out_.count);
  }

  void run(size_t firstBlock, size_t lastBlock, Share* share, const Context& context) {
    Scratch scratch;
    scratch.columns.resize(kBlockLights * values_);
    scratch.sketch.resize(out_.stride());
    share->total.assign(values_, 0.0);
    for (size_t i = firstBlock; i < lastBlock && !context.cancelled(); ++i) {
      const LightNumbers::Block block = numbers_.block(i);
      makeBlock(block, &scratch, share);
      for (size_t l = 0; l < block.count; ++l)
        keep(block.number + l, &scratch.columns[l * values_], &scratch, share);
    }
    share->pairs = scratch.values.pairs;
    share->nonfinite = scratch.values.nonfinite;
  }

 private:
  struct Scratch {
    LightBlock block;
    PairMasks pairs;
    PairValues values;
    std::vector<float> columns;  // [light][rows, then checks, three channels each]
    AlignedFloats sketch;
  };

  void makeBlock(const LightNumbers::Block& lights, Scratch* s, Share* share) const {
    prepare(lights_, tracer_.scene(), lights.lightClass, lights.first, lights.count, &s->block);
    std::fill_n(s->columns.begin(), lights.count * values_, 0.f);
    for (const Tile& tile : tiles_) {
      allowPairs(tile, s->block, lights_, settings_.gather, &s->pairs);
      share->rays += keepVisible(tile, s->block, tracer_, &s->pairs);
      s->values.reset(lights.count, tile.strips.size());
      shadePairs(tile, s->block, settings_.gather.clamp, s->pairs, &s->values);
      for (size_t l = 0; l < lights.count; ++l)
        for (size_t i = 0; i < tile.strips.size(); ++i)
          if (const uint32_t lit = s->pairs.at(l, i); lit != 0)
            addStrip(tile.strips[i], s->values, (l * tile.strips.size() + i) * kStrip, lit,
                     &s->columns[l * values_]);
    }
  }

  void addStrip(const PointStrip& strip, const PairValues& values, size_t first, uint32_t lit,
                float* column) const {
    for (size_t lane = 0; lane < kStrip; ++lane) {
      if (!(lit >> lane & 1)) continue;
      const size_t point = strip.point[lane], i = first + lane;
      const Rgb value =
          rows_.receivers.points[point].weight * Rgb(values.x[i], values.y[i], values.z[i]);
      if (rows_.row[point] != RowPixels::kNone) addTo(column + 3 * rows_.row[point], value);
      if (rows_.check[point] != RowPixels::kNone)
        addTo(column + rowValues_ + 3 * rows_.check[point], value);
    }
  }
  static void addTo(float* sum, Rgb value) {
    sum[0] += value.x, sum[1] += value.y, sum[2] += value.z;
  }

  void keep(size_t number, const float* column, Scratch* s, Share* share) {
    size_t seen = 0;
    for (size_t r = 0; r < rowValues_; r += 3)
      seen += column[r] != 0 || column[r + 1] != 0 || column[r + 2] != 0;
    for (size_t r = 0; r < values_; ++r) share->total[r] += double{column[r]};
    const double squared = squaredLength(column, rowValues_);
    const double all = squared + squaredLength(column + rowValues_, values_ - rowValues_);
    if (seen <= 1 || !(squared >= square(double{kLeastLength})))
      share->hardlySeen += std::sqrt(squared), ++share->hardlySeenCount;
    out_.weight[number] = static_cast<float>(std::sqrt(squared));
    if (out_.weight[number] >= kLeastLength)
      share->least = std::min(share->least, out_.weight[number]);
    out_.scale[number] = static_cast<float>(std::sqrt(all));
    if (settings_.channels) out_.channels[number] = channelLengths(column);
    if (out_.scale[number] < kLeastLength) {  // its reciprocal is not finite, or nearly so
      out_.weight[number] = out_.scale[number] = 0;
      return;
    }
    store(number, column, 1 / out_.scale[number], s);
  }

  Rgb channelLengths(const float* column) const {
    Vec3d sum;
    for (size_t r = 0; r < rowValues_; r += 3)
      sum += square({double{column[r]}, double{column[r + 1]}, double{column[r + 2]}});
    return {static_cast<float>(std::sqrt(sum.x)), static_cast<float>(std::sqrt(sum.y)),
            static_cast<float>(std::sqrt(sum.z))};
  }

  void store(size_t number, const float* column, float scale, Scratch* s) {
    const size_t first = number * out_.stride();
    if (!out_.whole.empty()) {
      for (size_t r = 0; r < rowValues_; ++r) out_.whole[first + r] = column[r] * scale;
      for (size_t r = rowValues_; r < values_; ++r)
        out_.whole[first + out_.dims + r - rowValues_] = column[r] * scale;
      return;
    }
    sketchRow(column, rowValues_, signs_.data(), out_.dims, s->sketch.data());
    sketchRow(column + rowValues_, values_ - rowValues_, checkSigns_.data(), kCheckDims,
              s->sketch.data() + out_.dims);
    for (float& value : s->sketch) value *= scale;
    packHalves(s->sketch.data(), out_.stride(), &out_.halves[first]);
  }

  const Tracer& tracer_;
  const Rows& rows_;
  const VirtualLights& lights_;
  const LightNumbers& numbers_;
  const ColumnSettings& settings_;
  const size_t rowValues_, values_;  // of a column: of rows, with checks
  std::vector<Tile> tiles_;
  AlignedFloats signs_, checkSigns_;
  LightColumns& out_;
};

double norm(const std::vector<double>& total, size_t begin, size_t end) {
  double sum = 0;
  for (size_t i = begin; i < end; ++i) sum += total[i] * total[i];
  return std::sqrt(sum);
}

}  // namespace

size_t LightColumns::bytes() const {
  return halves.size() * sizeof(uint16_t) + whole.size() * sizeof(float) +
         count * 2 * sizeof(float) + channels.size() * sizeof(Rgb);
}

void LightColumns::load(size_t i, float* out) const {
  if (whole.empty()) return unpackHalves(&halves[i * stride()], stride(), scale[i], out);
  const float* values = &whole[i * stride()];
  for (size_t k = 0; k < stride(); ++k) out[k] = values[k] * scale[i];
}

double squaredUnseen(double hardlySeen, size_t hardlySeenCount, float leastSeen) {
  // So that no weight, a float, vanishes: a row may see as little of a light as the tail of a
  // Gaussian.
  constexpr double kLeast = 1e-30;
  if (hardlySeenCount == 0) return square(kLeast);
  const double unseen = square(kUnseenShare * hardlySeen / static_cast<double>(hardlySeenCount));
  if (unseen > 0) return std::max(unseen, square(kLeast));
  // No light was seen by one row only: as little as the least of those that were seen, or, where
  // the rows see nothing, all alike.
  return leastSeen < kNoneSeen ? square(double{leastSeen}) : 1.0;
}

size_t columnBytes(const Rows& rows, size_t dims) {
  const size_t vector =
      dims == 0 ? (padded(3 * rows.rowCount) + padded(3 * rows.checkCount)) * sizeof(float)
                : (padded(dims) + kCheckDims) * sizeof(uint16_t);
  return vector + 2 * sizeof(float);
}

LightColumns computeColumns(const Tracer& tracer, const Rows& rows, const VirtualLights& lights,
                            const LightNumbers& numbers, const ColumnSettings& settings,
                            Context& context) {
  const StageTimer timer(context, "rows");
  LightColumns columns;
  Maker maker(tracer, rows, lights, numbers, settings, &columns);
  const size_t blocks = numbers.blockCount();
  std::vector<Share> shares(kShares);
  std::atomic<size_t> done{0};
  parallelFor(kShares, 1, [&](size_t i) {
    maker.run(i * blocks / kShares, (i + 1) * blocks / kShares, &shares[i], context);
    context.progress("rows", static_cast<double>(++done) / kShares);
  });

  Share all;
  all.total.assign(3 * (rows.rowCount + rows.checkCount), 0.0);
  for (const Share& share : shares) {
    for (size_t r = 0; r < all.total.size(); ++r) all.total[r] += share.total[r];
    all.hardlySeen += share.hardlySeen, all.hardlySeenCount += share.hardlySeenCount;
    all.least = std::min(all.least, share.least);
    all.rays += share.rays, all.pairs += share.pairs, all.nonfinite += share.nonfinite;
  }
  context.statistics.addCount("shadow_rays", all.rays);
  context.statistics.addCount("node_pairs_shaded", all.pairs);
  context.statistics.addCount("nonfinite", all.nonfinite);
  columns.rowNorm = norm(all.total, 0, 3 * rows.rowCount);
  columns.checkNorm = norm(all.total, 3 * rows.rowCount, all.total.size());
  columns.unseen = squaredUnseen(all.hardlySeen, all.hardlySeenCount, all.least);
  parallelFor(columns.count, 4096, [&](size_t i) {
    const double weight = std::sqrt(square(double{columns.weight[i]}) + columns.unseen);
    columns.weight[i] = static_cast<float>(weight);
    columns.scale[i] = static_cast<float>(double{columns.scale[i]} / weight);
  });
  return columns;
}

}  // namespace lobelia::gather
