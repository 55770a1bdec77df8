// The picture by path tracing: samples are added in passes over the image, tile by tile in
// parallel, so that a time limit or a cancellation leaves an unbiased mean of what each pixel has.
// A pixel belongs to one tile and its samples are added in order: the result does not depend on the
// number of threads. Between tiles the sums can be saved, and another run goes on from them.
#include "lobelia/path/path_tracer.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "lobelia/base/checkpoints.h"
#include "lobelia/base/parallel.h"
#include "lobelia/path/path_walk.h"

namespace lobelia {
namespace {

constexpr int kTile = 16;
constexpr int kSamplesPerPass = 16;
constexpr size_t kBatch = 64;                       // paths that go side by side
constexpr int64_t kProgressInterval = 200'000'000;  // nanoseconds

struct PixelSum {
  double direct[3] = {}, indirect[3] = {}, square[3] = {};
  uint32_t count = 0;
};
struct GuideSum {  // layers that describe the first surface
  float albedo[3] = {}, normal[3] = {}, depth = 0;
};

struct Place {  // where a path's light goes
  uint32_t pixel;
  float weight;
};

// What some pictures want besides, kept apart from what all pictures need: doubles of a pixel,
// three for every light group, then one for the rays traced.
struct ExtraSums {
  std::vector<std::string> groupLayers;  // empty: no groups
  bool cost = false;
  std::vector<double> values;

  ExtraSums(const EmitterSampler& emitters, const Film& film) {
    const LightGroups& groups = emitters.groups();
    for (size_t g = 0; g < groups.size(); ++g) groupLayers.push_back(groups.layer(g));
    const auto has = [&](const std::string& name) { return film.layers.contains(name); };
    if (std::none_of(groupLayers.begin(), groupLayers.end(), has)) groupLayers.clear();
    cost = has("cost");
    values.resize(film.pixelCount() * perPixel());
  }
  size_t perPixel() const { return 3 * groupLayers.size() + (cost ? 1 : 0); }
  void add(uint32_t pixel, const PathState& path, float weight) {
    double* out = values.data() + pixel * perPixel();
    const Rgb* sums = path.groups.sums;
    bool finite = true;  // a path that is not is left out as a whole
    for (size_t g = 0; g < groupLayers.size(); ++g) finite &= isFinite(sums[g]);
    for (size_t g = 0; g < groupLayers.size(); ++g)
      for (int c = 0; c < 3; ++c) *out++ += finite ? static_cast<double>(weight * sums[g][c]) : 0;
    if (cost) *out += static_cast<double>(path.depth) + path.shadowRays;
  }
};

// Has the film layers that describe the first surface?
bool describes(const Film& film) {
  return film.layers.contains("albedo") || film.layers.contains("normal") ||
         film.layers.contains("depth");
}

class PathPasses {
 public:
  PathPasses(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
             const PathSettings& settings, Film& film, Context& context)
      : walk_(tracer, emitters, settings, describes(film)),
        emitters_(emitters),
        camera_(camera),
        settings_(settings),
        film_(film),
        context_(context),
        checkpoints_(settings.checkpoints),
        sums_(film.pixelCount()),
        extra_(emitters, film),
        start_(nanosecondsNow()) {
    if (describes(film)) guides_.resize(film.pixelCount());
    makeTiles();
    tileSamples_.assign(tiles_.size(), 0);
  }

  // False when stopped before all samples were added.
  bool run() {
    if (checkpoints_ && checkpoints_->load(kStage, state())) {
      checkpoints_->restoreCounts();
      const double known = context_.statistics.value("first_nonfinite_pixel");
      if (known > 0) firstBad_ = static_cast<uint32_t>(known - 1);
    }
    // The first passes are short: a limited render should have every pixel soon.
    for (int first = 0, size = 1; first < settings_.spp && !stopped(first > 0); first += size) {
      if (first > 0) size = std::min(3 * first, kSamplesPerPass);
      const int last = std::min(first + size, settings_.spp);
      while (!complete(last) && !stopped(first > 0)) {
        addPass(first, last);
        if (due()) save();
      }
    }
    save();
    noteFirstBad();
    if (complete(settings_.spp)) return true;
    context_.info(fmt::format("stopped: {} of {} samples per pixel are complete",
                              *std::min_element(tileSamples_.begin(), tileSamples_.end()),
                              settings_.spp));
    return false;
  }

  void write() {
    write("", [](const PixelSum& s, size_t c) { return s.direct[c] + s.indirect[c]; });
    write("direct", [](const PixelSum& s, size_t c) { return s.direct[c]; });
    write("indirect", [](const PixelSum& s, size_t c) { return s.indirect[c]; });
    // Of the mean: sum (x - mean)^2 / (n (n - 1)); times n, as write() divides by it.
    write("variance", [](const PixelSum& s, size_t c) {
      if (s.count < 2) return 0.0;
      const double sum = s.direct[c] + s.indirect[c], n = s.count;
      return std::max(0.0, s.square[c] - sum * sum / n) / (n - 1);
    });
    for (size_t g = 0; g < extra_.groupLayers.size(); ++g) writeExtra(extra_.groupLayers[g], 3 * g);
    if (extra_.cost) writeExtra("cost", extra_.perPixel() - 1);
    if (guides_.empty()) return;
    writeGuide("albedo", [](const GuideSum& g, size_t c) { return g.albedo[c]; });
    writeGuide("normal", [](const GuideSum& g, size_t c) { return g.normal[c]; });
    writeGuide("depth", [](const GuideSum& g, size_t) { return g.depth; });
  }

 private:
  void makeTiles() {
    const uint32_t width = static_cast<uint32_t>(film_.width);
    const uint32_t height = static_cast<uint32_t>(film_.height);
    const std::vector<uint32_t>& chosen = settings_.pixels.pixels;
    if (!chosen.empty()) {
      constexpr size_t kGroup = 64;
      for (size_t i = 0; i < chosen.size(); i += kGroup) {
        tiles_.emplace_back(
            chosen.begin() + static_cast<ptrdiff_t>(i),
            chosen.begin() + static_cast<ptrdiff_t>(std::min(i + kGroup, chosen.size())));
      }
      return;
    }
    for (uint32_t ty = 0; ty < height; ty += kTile) {
      for (uint32_t tx = 0; tx < width; tx += kTile) {
        auto& tile = tiles_.emplace_back();
        for (uint32_t y = ty; y < std::min(ty + kTile, height); ++y) {
          for (uint32_t x = tx; x < std::min(tx + kTile, width); ++x) tile.push_back(y * width + x);
        }
      }
    }
  }

  double seconds() const { return static_cast<double>(nanosecondsNow() - start_) * 1e-9; }
  bool stopped(bool timed) const {
    return context_.cancelled() ||
           (timed && settings_.timeLimit > 0 && seconds() > settings_.timeLimit);
  }

  bool complete(int samples) const {
    return std::all_of(tileSamples_.begin(), tileSamples_.end(),
                       [&](int has) { return has >= samples; });
  }

  // Adds samples to the tiles that lack them, until a checkpoint is due: that changes when a tile
  // gets its samples, not what they are.
  void addPass(int first, int last) {
    std::atomic<size_t> done{0}, added{0};
    parallelFor(tiles_.size(), 1, [&](size_t t) {
      const double part = static_cast<double>(++done) / static_cast<double>(tiles_.size());
      if (tileSamples_[t] >= last || stopped(first > 0) || (added > 0 && due())) return;
      addSamples(tiles_[t], first, last);
      tileSamples_[t] = last;
      ++added;
      report((first + part * (last - first)) / settings_.spp);
    });
  }

  bool due() const { return checkpoints_ && checkpoints_->due(); }
  void save() {
    if (!checkpoints_) return;
    noteFirstBad();
    checkpoints_->markCounts();
    checkpoints_->save(kStage, state());
  }
  void noteFirstBad() {
    if (firstBad_ != PathCounts{}.firstBad)
      context_.statistics.setValue("first_nonfinite_pixel", 1.0 + firstBad_);
  }
  StateFields state() {
    StateFields fields;
    fields.add("tile-samples", tileSamples_);
    fields.add("sums", sums_);
    fields.add("extra", extra_.values);
    fields.add("guides", guides_);
    return fields;
  }

  void report(double fraction) {
    const int64_t now = nanosecondsNow();
    int64_t last = reported_.load(std::memory_order_relaxed);
    if (now - last < kProgressInterval || !reported_.compare_exchange_strong(last, now)) return;
    if (settings_.timeLimit > 0) fraction = std::max(fraction, seconds() / settings_.timeLimit);
    context_.progress("path", std::min(fraction, 1.0));
  }

  // Paths go side by side in batches and are added in order.
  void addSamples(const std::vector<uint32_t>& tile, int first, int last) {
    PathCounts counts;
    std::vector<PathState> paths;
    std::vector<Place> places;
    paths.reserve(kBatch);
    places.reserve(kBatch);
    std::vector<Rgb> groupSums;
    const auto flush = [&] {
      const size_t groups = extra_.groupLayers.size();
      groupSums.assign(paths.size() * groups, Rgb{});
      for (size_t i = 0; i < paths.size() && groups > 0; ++i)
        paths[i].groups = {&emitters_, settings_.component, groupSums.data() + i * groups};
      walk_.trace(paths, counts);
      for (size_t i = 0; i < paths.size(); ++i) {
        add(places[i].pixel, paths[i].result, places[i].weight);
        if (extra_.perPixel() > 0) extra_.add(places[i].pixel, paths[i], places[i].weight);
      }
      paths.clear();
      places.clear();
    };
    for (const uint32_t pixel : tile) {
      for (int sample = first; sample < last; ++sample) {
        start(pixel, sample, paths, places);
      }
      if (paths.size() + static_cast<size_t>(last - first) > kBatch) flush();
    }
    flush();
    if (settings_.preview) show(tile);
    context_.statistics.addCount("path_rays", counts.pathRays);
    context_.statistics.addCount("shadow_rays", counts.shadowRays);
    context_.statistics.addCount("nonfinite", counts.nonFinite);
    uint32_t least = firstBad_;
    while (counts.firstBad < least && !firstBad_.compare_exchange_weak(least, counts.firstBad)) {
    }
  }

  void show(const std::vector<uint32_t>& tile) const {
    std::vector<Rgb> values(tile.size());
    for (size_t i = 0; i < tile.size(); ++i) {
      const PixelSum& sum = sums_[tile[i]];
      for (int c = 0; c < 3; ++c)
        values[i][c] = static_cast<float>((sum.direct[c] + sum.indirect[c]) / sum.count);
    }
    settings_.preview->update(tile, values);
  }

  void start(uint32_t pixel, int sample, std::vector<PathState>& paths,
             std::vector<Place>& places) const {
    const uint32_t width = static_cast<uint32_t>(film_.width);
    const uint32_t x = static_cast<uint32_t>(film_.x0) + pixel % width;
    const uint32_t y = static_cast<uint32_t>(film_.y0) + pixel / width;
    const uint64_t stream = (static_cast<uint64_t>(y) << 32) | x;
    PathRandom random(context_.seed, stream, static_cast<uint32_t>(sample));
    float weight;
    const Vec2f offset =
        sampleFilter(camera_.filter, camera_.filterRadius, random.next2D(), &weight);
    const Vec2f position{static_cast<float>(x) + 0.5f + offset.x,
                         static_cast<float>(y) + 0.5f + offset.y};
    const Ray ray = generateRay(camera_, position, random.next2D());
    paths.emplace_back(ray, random, pixel);
    places.push_back({pixel, weight});
  }

  void add(uint32_t pixel, const PathResult& result, float weight) {
    PixelSum& sum = sums_[pixel];
    ++sum.count;
    for (int c = 0; c < 3; ++c) {
      const double direct = static_cast<double>(weight * result.direct[c]);
      const double indirect = static_cast<double>(weight * result.indirect[c]);
      sum.direct[c] += direct;
      sum.indirect[c] += indirect;
      sum.square[c] += (direct + indirect) * (direct + indirect);
    }
    if (guides_.empty()) return;
    GuideSum& guide = guides_[pixel];
    for (int c = 0; c < 3; ++c) {
      guide.albedo[c] += weight * result.albedo[c];
      guide.normal[c] += weight * result.normal[c];
    }
    guide.depth += weight * result.depth;
  }

  template <class F>
  void writeLayer(const std::string& name, const F& value) {
    const auto layer = film_.layers.find(name);
    if (layer == film_.layers.end()) return;
    const size_t channels = static_cast<size_t>(layer->second.channels);
    for (size_t i = 0; i < sums_.size(); ++i) {
      if (sums_[i].count == 0) continue;
      for (size_t c = 0; c < std::min<size_t>(channels, 3); ++c) {
        layer->second.values[i * channels + c] +=
            static_cast<float>(static_cast<double>(value(i, c)) / sums_[i].count);
      }
    }
  }
  template <class F>
  void write(const char* name, const F& value) {
    writeLayer(name, [&](size_t i, size_t c) { return value(sums_[i], c); });
  }
  void writeExtra(const std::string& name, size_t first) {
    writeLayer(
        name, [&](size_t i, size_t c) { return extra_.values[i * extra_.perPixel() + first + c]; });
  }
  template <class F>
  void writeGuide(const char* name, const F& value) {
    writeLayer(name, [&](size_t i, size_t c) { return value(guides_[i], c); });
  }

  static constexpr const char* kStage = "path";
  const PathWalk<Tracer> walk_;
  const EmitterSampler& emitters_;
  const Camera& camera_;
  const PathSettings& settings_;
  Film& film_;
  Context& context_;
  Checkpoints* const checkpoints_;
  std::vector<std::vector<uint32_t>> tiles_;  // pixels
  std::vector<int32_t> tileSamples_;          // that a tile's pixels have
  std::vector<PixelSum> sums_;
  ExtraSums extra_;
  std::vector<GuideSum> guides_;
  const int64_t start_;
  std::atomic<int64_t> reported_{0};
  std::atomic<uint32_t> firstBad_{0xffffffffu};  // PathCounts
};

}  // namespace

bool renderPath(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                const PathSettings& settings, Film& film, Context& context) {
  const StageTimer timer(context, "path");
  markPixels(film, settings.pixels);
  PathPasses passes(tracer, emitters, camera, settings, film, context);
  const bool complete = passes.run();
  passes.write();
  return complete;
}

}  // namespace lobelia
