#include "lobelia/app/band_plan.h"

#include <algorithm>

#include "lobelia/app/gather_options.h"
#include "lobelia/app/light_layers.h"
#include "lobelia/app/vsgl_options.h"

namespace lobelia::app {
namespace {

// Receivers of a band are traced at once: enough of them to keep all threads busy, few enough for
// memory.
constexpr size_t kBandPixels = 1 << 17;
// Pairs of receiver and light between looks at the clock: about 15 s of two cores.
constexpr size_t kPairs = 300'000'000;
constexpr size_t kRunStep = 128;      // receivers: whole packets of them
constexpr int kSamplesTogether = 64;  // of a pixel, at most: memory for a band's receivers

}  // namespace

BandPlan planBands(const Tracer& tracer, const PixelSet& pixels, int maxDepth, size_t lights,
                   const RenderOptions& options, const Film& film) {
  BandPlan plan;
  plan.gather.clamp = clampValue(options, tracer.bounds().radius());
  plan.gather.maxDepth = maxDepth;
  plan.gather.direct = options.direct == "lights";
  plan.gather.shadowRays = shadowRaysOf(options);

  plan.eye.sampleCount = virtualLightSamples(options);
  plan.eye.maxDepth = maxDepth;
  plan.eye.specularLimit = options.specularLimit;
  if (options.direct == "lights") plan.eye.directSamples = 0;
  plan.eye.hideEmitters = tracer.scene().hideEmitters;
  plan.eye.component = componentOf(options);
  plan.eye.pixels = pixels;

  plan.sets = lightSetCount(options, plan.eye.sampleCount);
  plan.wholePixels = gathersPixels(options);
  if (plan.wholePixels)
    plan.samplesTogether =
        std::min((plan.eye.sampleCount + plan.sets - 1) / plan.sets, kSamplesTogether);
  const size_t bandPixels = std::min(kBandPixels, kPairs / std::max<size_t>(lights, 1)) /
                            static_cast<size_t>(plan.samplesTogether);
  const double width = std::max(film.width, 1);
  const double share = pixels.pixels.empty()  // of the rows' pixels
                           ? 1
                           : static_cast<double>(pixels.pixels.size()) / (width * film.height);
  const double rows = static_cast<double>(bandPixels) / (width * share);
  // Layers are kept for as many rows.
  const int most = std::clamp((film.height + 7) / 8 * 8, 8, 4096);
  plan.bandRows = std::clamp(static_cast<int>(std::min(rows, 4096.0)) / 8 * 8, 8, most);
  plan.bands = (film.height + plan.bandRows - 1) / plan.bandRows;
  return plan;
}

int BandPlan::samplesEnd(int sample) const {
  int end = sample + 1;
  while (end < eye.sampleCount && end - sample < samplesTogether && set(end) == set(sample)) ++end;
  return end;
}
int BandPlan::groupsOf(int samples) const {
  int groups = 0;
  for (int sample = 0; sample < samples; sample = samplesEnd(sample)) ++groups;
  return groups;
}

size_t runLength(size_t lights) {
  return std::max<size_t>(kPairs / std::max<size_t>(lights, 1) / kRunStep, 1) * kRunStep;
}

size_t endOfRun(const Receivers& receivers, size_t begin, size_t length, const BandPlan& plan) {
  const std::vector<ReceiverPoint>& points = receivers.points;
  size_t end = std::min(begin + length, points.size());
  while (plan.wholePixels && end < points.size() && points[end].pixel == points[end - 1].pixel)
    ++end;
  return end;
}

void append(const Receivers& more, Receivers* all) {
  const uint32_t lobes = static_cast<uint32_t>(all->lobes.size());
  all->lobes.insert(all->lobes.end(), more.lobes.begin(), more.lobes.end());
  for (ReceiverPoint point : more.points) {
    point.firstLobe += lobes;
    all->points.push_back(point);
  }
}

void sortByPixel(Receivers* receivers) {
  std::stable_sort(
      receivers->points.begin(), receivers->points.end(),
      [](const ReceiverPoint& a, const ReceiverPoint& b) { return a.pixel < b.pixel; });
}

Receivers slice(const Receivers& all, size_t begin, size_t end) {
  Receivers part;
  part.points.assign(all.points.begin() + static_cast<ptrdiff_t>(begin),
                     all.points.begin() + static_cast<ptrdiff_t>(end));
  for (ReceiverPoint& point : part.points) {
    const auto first = all.lobes.begin() + static_cast<ptrdiff_t>(point.firstLobe);
    point.firstLobe = static_cast<uint32_t>(part.lobes.size());
    part.lobes.insert(part.lobes.end(), first, first + point.lobeCount);
  }
  return part;
}

}  // namespace lobelia::app
