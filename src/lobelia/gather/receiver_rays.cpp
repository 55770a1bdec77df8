#include "lobelia/gather/receiver_rays.h"

#include <atomic>
#include <unordered_map>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"

namespace lobelia {
namespace {

constexpr size_t kChunk = 32;  // points that a thread takes in a row

// A pixel's first receiver, its second ... have streams of their own.
std::vector<uint64_t> streamsOf(const Receivers& receivers, const ReceiverRaySettings& settings) {
  std::unordered_map<uint32_t, uint32_t> seen;
  std::vector<uint64_t> streams;
  streams.reserve(receivers.points.size());
  const uint32_t width = static_cast<uint32_t>(settings.width);
  for (const ReceiverPoint& point : receivers.points) {
    const uint32_t x = static_cast<uint32_t>(settings.x0) + point.pixel % width;
    const uint32_t y = static_cast<uint32_t>(settings.y0) + point.pixel / width;
    streams.push_back(
        hashCombine((static_cast<uint64_t>(y) << 32) | x, uint64_t{seen[point.pixel]++}));
  }
  return streams;
}

}  // namespace

void lightReceivers(const Receivers& receivers, const ReceiverRaySettings& settings,
                    const ReceiverLight& light, const char* stage, std::span<Rgb> radiance,
                    Context& context, GatherParts* parts) {
  const StageTimer timer(context, stage);
  const size_t points = receivers.points.size(), groups = parts ? parts->groupCount : 0;
  if (radiance.size() != points)
    throw std::invalid_argument("lightReceivers: one radiance value per receiver point");
  if (parts != nullptr) {
    parts->groups.assign(groups * points, Rgb{});
    parts->rays.assign(parts->countRays ? points : 0, 0);
  }
  const std::vector<uint64_t> streams = streamsOf(receivers, settings);
  std::vector<uint8_t> bad(points);
  std::atomic<uint64_t> pathRays{0}, shadowRays{0}, nonFinite{0};
  std::atomic<size_t> done{0};
  parallelRanges(points, kChunk, [&](size_t begin, size_t end) {
    if (context.cancelled()) return;
    ReceiverRayCounts counts;
    std::vector<Rgb> byGroup(groups);
    for (size_t i = begin; i < end; ++i) {
      const ReceiverPoint& point = receivers.points[i];
      if (settings.onlyPixel != GatherSettings::kAllPixels && point.pixel != settings.onlyPixel)
        continue;
      const uint64_t raysBefore = counts.pathRays + counts.shadowRays, badBefore = counts.nonFinite;
      std::fill(byGroup.begin(), byGroup.end(), Rgb{});
      const Rgb value =
          point.weight * light(point, streams[i], groups > 0 ? byGroup.data() : nullptr, &counts);
      if (isFinite(value)) {
        radiance[i] += value;
        for (size_t g = 0; g < groups; ++g)
          parts->groups[g * points + i] = point.weight * byGroup[g];
      } else {
        ++counts.nonFinite;
      }
      bad[i] = counts.nonFinite > badBefore;
      if (parts != nullptr && parts->countRays)
        parts->rays[i] = static_cast<uint32_t>(counts.pathRays + counts.shadowRays - raysBefore);
    }
    pathRays += counts.pathRays, shadowRays += counts.shadowRays, nonFinite += counts.nonFinite;
    const size_t finished = done += end - begin;
    if (finished / 4096 != (finished - (end - begin)) / 4096)
      context.progress(stage, static_cast<double>(finished) / static_cast<double>(points));
  });
  context.statistics.addCount("path_rays", pathRays);
  context.statistics.addCount("shadow_rays", shadowRays);
  context.statistics.addCount("nonfinite", nonFinite);
  for (size_t i = 0; i < points; ++i)
    if (bad[i] != 0) noteNonFinitePixel(receivers.points[i].pixel, context);
}

}  // namespace lobelia
