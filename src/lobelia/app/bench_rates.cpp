// Rays per second. Bare Embree in three patterns; the gather and the path tracer against bare loops
// over the same rays. What is compared is measured in turns and the median of the turns' ratios is
// given, as other programs on a machine come and go. Rates by processor time (rays over processor
// seconds per thread) stand beside those by the clock: what an otherwise idle machine would do.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <memory>

#include "lobelia/app/bench_rays.h"
#include "lobelia/app/bench_studies.h"
#include "lobelia/app/frame_setup.h"
#include "lobelia/app/load_scene.h"
#include "lobelia/base/parallel.h"
#include "lobelia/builtin/closed_room.h"
#include "lobelia/gather/gather.h"
#include "lobelia/lights/light_pass.h"

namespace lobelia::app {
namespace {

constexpr size_t kReceivers = 15360, kLights = 1024, kPackets = 1 << 15;
constexpr int kTurns = 5, kSpp = 16, kPathWidth = 160;

// Seconds by the clock, and of processor per thread.
struct Seconds {
  double clock = 0, processor = 0;
};
Seconds now() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  const double processor = static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  return {1e-9 * static_cast<double>(nanosecondsNow()), processor / threadCount()};
}
template <class F>
Seconds timed(const F& f) {
  const Seconds start = now();
  f();
  const Seconds end = now();
  return {end.clock - start.clock, end.processor - start.processor};
}

struct Measured {
  double rays = 0, visible = 0;
  Seconds seconds;
  double rate() const { return rays / seconds.clock; }
  double processorRate() const { return rays / seconds.processor; }
};

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t n = values.size();
  return n % 2 == 1 ? values[n / 2] : 0.5 * (values[n / 2 - 1] + values[n / 2]);
}

// A scene with what sees and lights it; or one of the kinds of the closed room.
class RateScene {
 public:
  RateScene(Scene scene, const BenchOptions& options, Context& context)
      : scene_(std::move(scene)), tracer_(scene_, context), emitters_(scene_, tracer_.bounds()) {
    RenderOptions render;
    render.size = options.size;
    render.camera = options.camera;
    camera_ = chooseCamera(scene_, render);
    maxDepth_ = options.maxDepth > 0 ? options.maxDepth : scene_.maxDepth;
  }
  const Scene& scene() const { return scene_; }
  const Tracer& tracer() const { return tracer_; }
  const EmitterSampler& emitters() const { return emitters_; }
  const Camera& camera() const { return camera_; }
  int maxDepth() const { return maxDepth_; }

  Receivers receivers(Context& context) const {
    RenderOptions render;
    Film film = makeFilm(camera_, render);
    EyeSettings eye;
    eye.maxDepth = maxDepth_;
    eye.directSamples = 0;
    return spreadReceivers(
        traceReceivers(tracer_, emitters_, camera_, eye, 0, film.height, film, context),
        kReceivers);
  }
  VirtualLights lights(size_t count, Context& context) const {
    LightSettings settings;
    settings.count = count;
    settings.maxDepth = maxDepth_;
    return makeLights(tracer_, emitters_, settings, context);
  }

 private:
  Scene scene_;
  Tracer tracer_;
  EmitterSampler emitters_;
  Camera camera_;
  int maxDepth_;
};

Measured traceAll(const BareRays& bare, const Packets& packets, bool coherent) {
  constexpr size_t kGrain = 64;
  std::atomic<uint64_t> visible{0};
  Measured result;
  result.seconds = timed([&] {
    parallelRanges(packets.size(), kGrain, [&](size_t begin, size_t end) {
      visible += bare.visible(std::span(packets).subspan(begin, end - begin), coherent);
    });
  });
  result.rays = static_cast<double>(packets.size() * ShadowPacket::kSize);
  result.visible = static_cast<double>(visible);
  return result;
}

// Builds the packets of some lights at a time (memory), times only their tracing.
Measured traceGatherRays(const BareRays& bare, const Receivers& receivers,
                         const std::vector<PointNormal>& lights) {
  constexpr size_t kTile = 256, kSome = 128;
  const size_t count = receivers.points.size();
  std::vector<Packets> tiles((count + kTile - 1) / kTile);
  std::vector<uint64_t> visible(tiles.size());
  Measured result;
  for (size_t first = 0; first < lights.size(); first += kSome) {
    const std::span some(lights.data() + first, std::min(kSome, lights.size() - first));
    parallelFor(tiles.size(), 1, [&](size_t t) {
      tiles[t] = tileToLights(
          std::span(receivers.points.data() + t * kTile, std::min(kTile, count - t * kTile)), some);
    });
    const Seconds seconds = timed([&] {
      parallelFor(tiles.size(), 1, [&](size_t t) { visible[t] += bare.visible(tiles[t], true); });
    });
    result.seconds.clock += seconds.clock, result.seconds.processor += seconds.processor;
    for (const Packets& packets : tiles)
      result.rays += static_cast<double>(packets.size() * ShadowPacket::kSize);
  }
  for (const uint64_t n : visible) result.visible += static_cast<double>(n);
  return result;
}

Measured traceGather(const Tracer& tracer, const Receivers& receivers, const VirtualLights& lights,
                     Context& context) {
  std::vector<Rgb> radiance(receivers.points.size());
  const uint64_t before = context.statistics.count("shadow_rays");
  Measured result;
  result.seconds = timed([&] { gatherAll(tracer, receivers, lights, {}, radiance, context); });
  result.rays = static_cast<double>(context.statistics.count("shadow_rays") - before);
  return result;
}

// The light that most receivers see, of some: the best case of a tile-order pattern.
PointNormal bestSeen(const BareRays& bare, const Receivers& receivers,
                     const std::vector<PointNormal>& lights) {
  PointNormal best = lights.front();
  double most = -1;
  const size_t some = std::min<size_t>(16, lights.size());
  for (size_t i = 0; i < some; ++i) {  // neighbours in the array are neighbours in the scene
    const PointNormal& light = lights[i * lights.size() / some];
    const double visible = traceGatherRays(bare, receivers, {light}).visible;
    if (visible > most) most = visible, best = light;
  }
  return best;
}

struct Subject {  // a gather to be timed
  std::string lightKind, receiverKind;
  const Receivers* receivers;
  VirtualLights lights;
};

// Receivers in tile order to the one light that most of them see.
Packets tileOrder(const BareRays& bare, const Receivers& receivers,
                  const std::vector<PointNormal>& lights) {
  Packets packets =
      tileToLights(receivers.points, std::vector<PointNormal>{bestSeen(bare, receivers, lights)});
  const size_t once = packets.size();
  packets.reserve(kPackets + once);
  while (once > 0 && packets.size() < kPackets)
    for (size_t i = 0; i < once; ++i) packets.push_back(packets[i]);
  return packets;
}

BenchTable barePatterns(const BareRays& bare, const Packets& tiles,
                        const std::vector<PointNormal>& lights, uint64_t triangles, int turns,
                        const BenchOptions& options, Context& context) {
  BenchTable table{"bare",
                   "Bare Embree, shadow rays in packets of 16",
                   {{"pattern", "pattern"},
                    {"mrays_per_second", "million rays/s", "{:.1f}"},
                    {"mrays_per_second_processor", "by processor time", "{:.1f}"},
                    {"visible", "unblocked", "{:.2f}"}},
                   {},
                   {fmt::format("{} triangles, {} threads; medians of {} turns.", triangles,
                                threadCount(), turns)}};
  std::vector<double> rates[3], processorRates[3];
  double visible[3] = {};
  const Packets patterns[2] = {randomToRandom(lights, kPackets, options.seed + 1),
                               pointToSorted(lights, kPackets, options.seed + 2)};
  for (int turn = 0; turn < turns && !context.cancelled(); ++turn) {
    for (int k = 0; k < 3; ++k) {
      const Measured m = traceAll(bare, k < 2 ? patterns[k] : tiles, k == 2);
      rates[k].push_back(m.rate());
      processorRates[k].push_back(m.processorRate());
      visible[k] = m.visible / m.rays;
    }
  }
  if (context.cancelled()) return table;
  const char* names[] = {"random points to random lights", "one point to sorted lights",
                         "pixels in tile order to one light"};
  for (int k = 0; k < 3; ++k)
    table.rows.push_back(
        {names[k], 1e-6 * median(rates[k]), 1e-6 * median(processorRates[k]), visible[k]});
  return table;
}

// Rates of something and of bare loops, turn by turn.
struct Turns {
  std::vector<double> clock, processor;
  void add(const Measured& m) {
    clock.push_back(1e-6 * m.rate()), processor.push_back(1e-6 * m.processorRate());
  }
};
double medianRatio(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  return median(ratios);
}

BenchTable gatherRates(const BareRays& bare, const Tracer& tracer, const Packets& tiles,
                       const std::vector<Subject>& subjects, int turns, Context& context) {
  BenchTable table{"gather",
                   "Brute-force gather, shading included, million rays/s",
                   {{"lights", "lights"},
                    {"receivers", "receivers"},
                    {"gather_mrays_per_second", "gather", "{:.1f}"},
                    {"gather_mrays_per_second_processor", "by processor time", "{:.1f}"},
                    {"bare_mrays_per_second_processor", "bare, the same rays", "{:.1f}"},
                    {"ratio", "ratio (clock)", "{:.2f}"},
                    {"ratio_processor", "ratio (processor)", "{:.2f}"},
                    {"one_light_mrays_per_second_processor", "bare, to one light", "{:.1f}"},
                    {"ratio_one_light", "ratio (clock)", "{:.2f}"},
                    {"ratio_one_light_processor", "ratio (processor)", "{:.2f}"},
                    {"shading_share", "shading's share of time", "{:.2f}"}},
                   {},
                   {"Bare rates by processor time. The same rays: the gather's own shadow rays, "
                    "receivers in tile order to one light after another, by Embree alone. To one "
                    "light: the best-seen light only."}};
  for (size_t i = 0; i < subjects.size() && !context.cancelled(); ++i) {
    const Subject& subject = subjects[i];
    const std::vector<PointNormal> lights = places(subject.lights);
    if (lights.empty() || subject.receivers->points.empty()) continue;
    Turns gather, same, one;
    const double shadeBefore = context.statistics.seconds("shade"),
                 visibilityBefore = context.statistics.seconds("visibility");
    for (int turn = 0; turn < turns && !context.cancelled(); ++turn) {
      context.progress(fmt::format("{}gather", kBenchStage),
                       (static_cast<double>(i) + static_cast<double>(turn) / turns) /
                           static_cast<double>(subjects.size()));
      same.add(traceGatherRays(bare, *subject.receivers, lights));
      gather.add(traceGather(tracer, *subject.receivers, subject.lights, context));
      one.add(traceAll(bare, tiles, true));
    }
    if (context.cancelled()) break;
    const double shade = context.statistics.seconds("shade") - shadeBefore,
                 visibility = context.statistics.seconds("visibility") - visibilityBefore;
    table.rows.push_back(
        {subject.lightKind, subject.receiverKind, median(gather.clock), median(gather.processor),
         median(same.processor), medianRatio(gather.clock, same.clock),
         medianRatio(gather.processor, same.processor), median(one.processor),
         medianRatio(gather.clock, one.clock), medianRatio(gather.processor, one.processor),
         shade / (shade + visibility)});
  }
  return table;
}

struct PathSubject {
  std::string name;
  const RateScene* scene;
};

BenchTable pathRates(const std::vector<PathSubject>& subjects, int spp, int turns,
                     const BenchOptions& options, Context& context) {
  BenchTable table{"path",
                   "Path tracer, million rays/s",
                   {{"scene", "scene"},
                    {"path_mrays_per_second", "path tracer", "{:.2f}"},
                    {"path_mrays_per_second_processor", "by processor time", "{:.2f}"},
                    {"bare_mrays_per_second_processor", "bare, the same rays", "{:.2f}"},
                    {"ratio", "ratio (clock)", "{:.2f}"},
                    {"ratio_processor", "ratio (processor)", "{:.2f}"},
                    {"packets_mrays_per_second_processor", "bare, in packets", "{:.2f}"},
                    {"ratio_packets_processor", "ratio (processor)", "{:.2f}"}},
                   {},
                   {"Bare, by processor time: the rays of the same paths, nearest hits and shadow "
                    "rays, one by one by Embree alone; and by Embree alone in the packets that the "
                    "path tracer forms of those that leave or light what the eye sees."}};
  for (size_t i = 0; i < subjects.size() && !context.cancelled(); ++i) {
    const RateScene& scene = *subjects[i].scene;
    const BareRays bare(scene.scene(), context);
    PathSettings settings;
    settings.spp = spp;
    settings.maxDepth = scene.maxDepth();
    Camera camera = scene.camera();
    if (options.size.empty()) {  // recorded rays fill memory
      camera.height = std::max(1, kPathWidth * camera.height / camera.width);
      camera.width = kPathWidth;
    }
    camera.cropX0 = camera.cropY0 = 0, camera.cropX1 = camera.width, camera.cropY1 = camera.height;
    const auto tiles = recordPathRays(scene.tracer(), scene.emitters(), camera, settings, 0);
    double rays = 0;
    for (const TracedRays& tile : tiles) rays += static_cast<double>(tile.rays.size());
    Turns path, same, packets;
    for (int turn = 0; turn < turns && !context.cancelled(); ++turn) {
      context.progress(fmt::format("{}path tracer", kBenchStage),
                       (static_cast<double>(i) + static_cast<double>(turn) / turns) /
                           static_cast<double>(subjects.size()));
      RenderOptions render;
      Film film = makeFilm(camera, render);
      const auto counted = [&] {
        return static_cast<double>(context.statistics.count("path_rays") +
                                   context.statistics.count("shadow_rays"));
      };
      Measured p;
      const double before = counted();
      p.seconds = timed(
          [&] { renderPath(scene.tracer(), scene.emitters(), camera, settings, film, context); });
      p.rays = counted() - before;
      const auto bareRate = [&](const auto& hitsOf) {
        Measured m;
        std::atomic<uint64_t> hits{0};
        m.seconds = timed(
            [&] { parallelFor(tiles.size(), 1, [&](size_t t) { hits += hitsOf(tiles[t]); }); });
        m.rays = rays;
        return m;
      };
      path.add(p);
      same.add(bareRate([&](const TracedRays& tile) { return bare.hits(tile.rays); }));
      packets.add(bareRate([&](const TracedRays& tile) { return bare.hits(tile); }));
    }
    if (context.cancelled()) break;
    table.rows.push_back({subjects[i].name, median(path.clock), median(path.processor),
                          median(same.processor), medianRatio(path.clock, same.clock),
                          medianRatio(path.processor, same.processor), median(packets.processor),
                          medianRatio(path.processor, packets.processor)});
  }
  return table;
}

// Only the lights of one class.
VirtualLights onlyDiffuse(VirtualLights lights) {
  lights.glossy.clear(), lights.glossyDepthEnds.clear();
  return lights;
}
VirtualLights onlyGlossy(VirtualLights lights) {
  lights.diffuse.clear(), lights.diffuseDepthEnds.clear();
  return lights;
}

std::unique_ptr<RateScene> room(builtin::RoomKind kind, const BenchOptions& options,
                                Context& context) {
  return std::make_unique<RateScene>(builtin::closedRoom(kind, options.scene.detail), options,
                                     context);
}

}  // namespace

std::vector<BenchTable> benchRates(const BenchOptions& options, Context& context) {
  const int turns = options.sets > 0 ? options.sets : kTurns,
            spp = options.spp > 0 ? options.spp : kSpp;
  const size_t lightCount = options.lightCount > 0 ? options.lightCount : kLights;
  // The rooms differ in their materials only: lights of one can shine on receivers of another.
  std::unique_ptr<RateScene> scene, ggx, plastic, mixed, manyLights;
  std::vector<Subject> subjects;
  std::vector<PathSubject> paths;
  std::vector<Receivers> receivers;
  receivers.reserve(3);
  const bool own = !options.scene.scene.empty();
  if (own) {
    scene = std::make_unique<RateScene>(loadScene(options.scene, context), options, context);
    receivers.push_back(scene->receivers(context));
    const VirtualLights lights = scene->lights(lightCount, context);
    subjects = {{"diffuse", "the scene's", &receivers[0], onlyDiffuse(lights)},
                {"glossy", "the scene's", &receivers[0], onlyGlossy(lights)}};
    paths = {{options.scene.scene, scene.get()}};
  } else {
    scene = room(builtin::RoomKind::diffuse, options, context);
    ggx = room(builtin::RoomKind::ggx, options, context);
    plastic = room(builtin::RoomKind::plastic, options, context);
    mixed = room(builtin::RoomKind::mixed, options, context);
    manyLights = room(builtin::RoomKind::manyLights, options, context);
    for (const RateScene* s : {scene.get(), ggx.get(), plastic.get()})
      receivers.push_back(s->receivers(context));
    const VirtualLights diffuse = onlyDiffuse(scene->lights(lightCount, context)),
                        glossy = onlyGlossy(ggx->lights(lightCount, context));
    const char* kinds[] = {"diffuse", "GGX metal", "plastic (GGX coat)"};
    for (const bool glossyLights : {false, true})
      for (size_t k = 0; k < 3; ++k)
        subjects.push_back({glossyLights ? "glossy" : "diffuse", kinds[k], &receivers[k],
                            glossyLights ? glossy : diffuse});
    paths = {{"closed room, diffuse", scene.get()},
             {"closed room, mixed", mixed.get()},
             {"closed room, lit by spheres", manyLights.get()}};
  }
  std::vector<PointNormal> points =
      places(scene->lights(std::max<size_t>(4096, lightCount), context));
  std::vector<BenchTable> tables;
  const BareRays bare(scene->scene(), context);
  if (!points.empty() && !receivers[0].points.empty()) {
    const Packets tiles = tileOrder(bare, receivers[0], points);
    tables.push_back(
        barePatterns(bare, tiles, points, triangleCount(scene->scene()), turns, options, context));
    tables.push_back(gatherRates(bare, scene->tracer(), tiles, subjects, turns, context));
  }
  tables.push_back(pathRates(paths, spp, turns, options, context));
  return tables;
}

}  // namespace lobelia::app
