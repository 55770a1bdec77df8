#include "lobelia/gather/mrcs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lobelia/base/error.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/mrcs_sampling.h"

namespace lobelia {
namespace gather {
namespace {

constexpr uint64_t kWholeBytes = 64 << 20;  // whole columns that are kept without being asked for
constexpr size_t kDims = 64, kFewestDims = 16;

enum : uint64_t { kSignStream = 1, kClusterStream, kDrawStream };

double megabytes(double bytes) { return bytes / (1 << 20); }

// 0: whole columns.
size_t chooseDims(const Rows& rows, size_t lights, const MrcsSettings& settings) {
  const auto needed = [&](size_t dims) { return columnBytes(rows, dims) * lights; };
  const auto fits = [&](size_t dims) { return needed(dims) <= settings.memory; };
  if (settings.sketch == MrcsSettings::kChosen) {
    if (needed(0) <= std::min(kWholeBytes, settings.memory)) return 0;
    for (size_t dims = kDims; dims >= kFewestDims; dims -= kFewestDims)
      if (fits(dims)) return dims;
  } else if (fits(static_cast<size_t>(settings.sketch))) {
    return static_cast<size_t>(settings.sketch);
  }
  const size_t dims =
      settings.sketch == MrcsSettings::kChosen ? kFewestDims : static_cast<size_t>(settings.sketch);
  throw UsageError(fmt::format(
      "--memory {:.3g} MiB is too little for {} of {} lights, which take {:.0f} MiB; allow more{}",
      megabytes(static_cast<double>(settings.memory)),
      dims == 0 ? std::string("the whole columns") : fmt::format("sketches of {} numbers", dims),
      lights, std::ceil(megabytes(static_cast<double>(needed(dims)))),
      dims > kFewestDims || dims == 0 ? ", or choose a smaller --sketch" : ", or fewer lights"));
}

// The scale with the colour that the cluster's lengths have together over the light's own. Where a
// light is drawn in proportion to its weight, that is the paper's sum of lengths over its length,
// channel by channel. Each channel has a third of the unseen part.
Rgb scaleByChannel(const LightColumns& columns, std::span<const uint32_t> lights, size_t light,
                   const LightCluster& cluster, float scale) {
  const auto length = [&](size_t i, int c) {
    const double seen = double{columns.channels[i][c]};
    return std::sqrt(seen * seen + columns.unseen / 3);
  };
  Rgb out(scale);
  for (int c = 0; c < 3; ++c) {
    double sum = 0;
    for (const uint32_t i : lights) sum += length(i, c);
    const double own = length(light, c) / double{columns.weight[light]};
    if (own > 0) out[c] *= static_cast<float>(sum / cluster.weight / own);
  }
  return out;
}

}  // namespace

std::vector<Representative> drawRepresentatives(const LightColumns& columns,
                                                const Clustering& clustering, uint64_t seed) {
  std::vector<Representative> out;
  for (size_t k = 0; k < clustering.clusters.size(); ++k) {
    const LightCluster& cluster = clustering.clusters[k];
    const auto lights =
        std::span<const uint32_t>(clustering.order).subspan(cluster.begin, cluster.size());
    const auto probability = [&](uint32_t i) {
      return drawProbability(double{columns.weight[i]}, cluster);
    };
    double left = uniformNumber(seed, k);
    uint32_t light = lights.back();
    for (const uint32_t i : lights) {
      if ((left -= probability(i)) >= 0) continue;
      light = i;
      break;
    }
    if (lights.size() == 1) {
      out.push_back({light, Rgb(1.f)});
      continue;
    }
    const auto scale = static_cast<float>(1 / probability(light));
    out.push_back({light, columns.channels.empty()
                              ? Rgb(scale)
                              : scaleByChannel(columns, lights, light, cluster, scale)});
  }
  std::sort(out.begin(), out.end(),
            [](const Representative& a, const Representative& b) { return a.light < b.light; });
  return out;
}

}  // namespace gather

VirtualLights reduceLights(const Tracer& tracer, const gather::Rows& rows,
                           const VirtualLights& lights, const MrcsSettings& settings,
                           MrcsReport* report, Context& context) {
  using namespace gather;
  const LightNumbers numbers(lights, settings.gather);
  *report = {};
  report->lights = report->columns = numbers.count();
  if (numbers.count() <= settings.columns && settings.errorLimit <= 0) return lights;
  report->rows = rows.rowCount, report->checkRows = rows.checkCount;
  ColumnSettings columnSettings;
  columnSettings.gather = settings.gather;
  columnSettings.dims = chooseDims(rows, numbers.count(), settings);
  columnSettings.seed = hashCombine(settings.seed, kSignStream);
  columnSettings.channels = settings.scalePerChannel;
  const LightColumns columns =
      computeColumns(tracer, rows, lights, numbers, columnSettings, context);
  if (context.cancelled()) return {};
  ClusterSettings clusterSettings;
  clusterSettings.count = settings.columns;
  clusterSettings.errorLimit = settings.errorLimit;
  clusterSettings.seed = hashCombine(settings.seed, kClusterStream);
  const Clustering clustering = clusterLights(columns, clusterSettings, context);
  if (context.cancelled()) return {};
  std::vector<ChosenLight> chosen;
  for (const Representative& r :
       drawRepresentatives(columns, clustering, hashCombine(settings.seed, kDrawStream))) {
    chosen.push_back(numbers.at(r.light));
    chosen.back().scale = r.scale;
  }
  report->columns = chosen.size();
  report->sketch = columns.whole.empty() ? columns.dims : 0;
  if (chosen.size() < numbers.count()) {
    report->error = clustering.checkError(columns);
    report->rowError = clustering.rowError(columns);
  }
  return chooseLights(lights, chosen);
}

}  // namespace lobelia
