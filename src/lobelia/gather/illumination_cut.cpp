#include "lobelia/gather/illumination_cut.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/gather/illumination_tile.h"
#include "lobelia/gather/pixel_range.h"

namespace lobelia::gather {
namespace {

constexpr float kFloorShare = 0.05f;

}  // namespace

// One call of gather().
class IlluminationCut::Run {
 public:
  Run(const IlluminationCut& cut, const Receivers& receivers, GatherParts* parts, Context& context)
      : cut_(cut), context_(context) {
    {
      const StageTimer timer(context, "trees");
      whole_ = plantWholeReceivers(receivers, 2 * cut.tracer_.bounds().radius());
    }
    for (const WholeReceivers::Tree& tree : whole_.trees)
      for (const uint32_t node : tree.tiles) tiles_.push_back({&tree, node});
    radiance_.resize(whole_.order.size());
    if (parts == nullptr) return;
    ordered_ = *parts;
    ordered_->reset(whole_.order.size());
  }

  // False when cancelled.
  bool run() {
    std::vector<float> thresholds(whole_.order.size());
    if (cut_.settings_.threshold > 0) thresholds = estimate();
    if (context_.cancelled()) return false;
    forTiles("gather",
             [&](IlluminationTile* tile, size_t) { tile->gather(thresholds, radiance_); });
    for (size_t i = 0; i < estimateRays_.size() && ordered_ && ordered_->countRays; ++i)
      ordered_->rays[i] += estimateRays_[i];
    return !context_.cancelled();
  }

  void write(std::span<Rgb> radiance) const {
    for (size_t i = 0; i < whole_.order.size(); ++i) radiance[whole_.order[i]] += radiance_[i];
    tally_.book(context_);
  }
  void write(size_t points, GatherParts* parts) const {
    parts->setOrdered(*ordered_, whole_.order, points);
  }

 private:
  struct Place {
    const WholeReceivers::Tree* tree;
    uint32_t node;
  };

  template <class F>
  void forTiles(const char* stage, const F& f) {
    const IlluminationScene scene{
        cut_.tracer_,          cut_.lights_,
        cut_.prepared_,        cut_.forest_,
        cut_.representatives_, whole_.receivers,
        cut_.settings_.gather, cut_.settings_.sampled && cut_.settings_.threshold > 0,
        cut_.settings_.seed};
    std::vector<GatherTally> tallies(tiles_.size());
    std::atomic<size_t> done{0};
    parallelFor(tiles_.size(), 1, [&](size_t i) {
      if (context_.cancelled()) return;
      IlluminationTile tile(scene, *tiles_[i].tree, tiles_[i].node, ordered_ ? &*ordered_ : nullptr,
                            &tallies[i], context_);
      f(&tile, i);
      context_.progress(stage, static_cast<double>(++done) / static_cast<double>(tiles_.size()));
    });
    for (const GatherTally& tally : tallies) tally_.add(tally);
  }

  // Thresholds of the receivers: shares of the light of their pixels in the coarse picture.
  std::vector<float> estimate() {
    std::vector<double> light(whole_.order.size());
    estimateRays_.assign(whole_.order.size(), 0);
    forTiles("coarse picture",
             [&](IlluminationTile* tile, size_t) { tile->estimate(light, estimateRays_); });
    const PixelRange range = pixelRangeOf(whole_.receivers);
    std::vector<double> pixels(range.size);
    std::vector<uint8_t> used(pixels.size());
    for (size_t i = 0; i < light.size(); ++i) {
      const size_t pixel = range.at(whole_.receivers.points[i].pixel);
      pixels[pixel] += light[i];
      used[pixel] = 1;
    }
    const double mean = std::accumulate(pixels.begin(), pixels.end(), 0.0) /
                        static_cast<double>(std::max<ptrdiff_t>(
                            std::count(used.begin(), used.end(), uint8_t{1}), 1));
    std::vector<float> thresholds;
    for (const ReceiverPoint& point : whole_.receivers.points)
      thresholds.push_back(static_cast<float>(
          cut_.settings_.threshold *
          std::max(std::abs(pixels[range.at(point.pixel)]), double{kFloorShare} * mean)));
    return thresholds;
  }

  const IlluminationCut& cut_;
  Context& context_;
  WholeReceivers whole_;
  std::vector<Place> tiles_;
  std::vector<Rgb> radiance_;
  std::vector<uint32_t> estimateRays_;
  std::optional<GatherParts> ordered_;
  GatherTally tally_;
};

IlluminationCut::IlluminationCut(const Tracer& tracer, const VirtualLights& lights,
                                 const IlluminationCutSettings& settings, Context& context)
    : tracer_(tracer),
      lights_(lights),
      settings_(settings),
      prepared_(prepareLights(lights, tracer.scene())) {
  const StageTimer timer(context, "trees");
  forest_ = plantLights(lights, settings.gather, 1, tracer.scene(), tracer.bounds(), prepared_);
  representatives_ = Representatives(forest_, settings.seed);
}

void IlluminationCut::gather(const Receivers& receivers, uint32_t, std::span<Rgb> radiance,
                             Context& context, GatherParts* parts) const {
  const size_t points = receivers.points.size();
  if (radiance.size() != points)
    throw std::invalid_argument("IlluminationCut::gather: one radiance value per receiver point");
  if (parts != nullptr) parts->reset(points);
  if (points == 0) return;
  Run run(*this, receivers, parts, context);
  if (!run.run()) return;
  run.write(radiance);
  if (parts != nullptr) run.write(points, parts);
}

}  // namespace lobelia::gather
