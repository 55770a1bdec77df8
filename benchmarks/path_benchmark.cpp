// The path tracer against a bare loop over the same rays, all threads: the counter "of_bare" is the
// share of the bare rate that renderPath() reaches with shading, sampling and all, the two timed in
// turn in one run; "of_bare_cpu" the same in processor time, for machines that do other work too.
// The bare loop calls Embree over prepared rays, in the order in which the paths traced them. And
// emitter sampling: build and draws with 10^6 emissive triangles.
#include <benchmark/benchmark.h>

#include <atomic>
#include <cmath>
#include <ctime>

#include "lobelia/app/bench_rays.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/builtin/closed_room.h"

namespace lobelia {
namespace {

constexpr int kWidth = 320, kHeight = 240, kSamples = 4;

void path(benchmark::State& state, builtin::RoomKind kind) {
  Scene scene = builtin::closedRoom(kind);
  scene.cameras[0].width = kWidth, scene.cameras[0].height = kHeight;
  Context context;
  const Tracer tracer(scene, context);
  const BareRays bare(scene, context);
  const EmitterSampler emitters(scene, tracer.bounds());
  PathSettings settings;
  settings.spp = kSamples;
  const auto tiles = app::recordPathRays(tracer, emitters, scene.cameras[0], settings, 0);
  double rays = 0;
  for (const auto& tile : tiles) rays += static_cast<double>(tile.rays.size());
  double pathSeconds = 0, bareSeconds = 0, pathRays = 0, bareRays = 0, pathCpu = 0, bareCpu = 0;
  for (auto _ : state) {
    Film film;
    film.fullWidth = film.width = kWidth;
    film.fullHeight = film.height = kHeight;
    film.addLayer("");
    Context counted;
    const std::clock_t cpuStart = std::clock();
    const int64_t start = nanosecondsNow();
    renderPath(tracer, emitters, scene.cameras[0], settings, film, counted);
    const int64_t middle = nanosecondsNow();
    const std::clock_t cpuMiddle = std::clock();
    std::atomic<uint64_t> hits{0};
    parallelFor(tiles.size(), 1, [&](size_t t) { hits += bare.hits(tiles[t]); });
    benchmark::DoNotOptimize(hits.load());
    const int64_t end = nanosecondsNow();
    pathCpu += static_cast<double>(cpuMiddle - cpuStart);
    bareCpu += static_cast<double>(std::clock() - cpuMiddle);
    pathSeconds += static_cast<double>(middle - start) * 1e-9;
    bareSeconds += static_cast<double>(end - middle) * 1e-9;
    pathRays += static_cast<double>(counted.statistics.count("path_rays") +
                                    counted.statistics.count("shadow_rays"));
    bareRays += rays;
    state.SetIterationTime(static_cast<double>(middle - start) * 1e-9);
  }
  state.counters["path_Mrays/s"] = pathRays / pathSeconds * 1e-6;
  state.counters["bare_Mrays/s"] = bareRays / bareSeconds * 1e-6;
  state.counters["of_bare_cpu"] = (pathRays / pathCpu) / (bareRays / bareCpu);
  state.counters["of_bare"] = (pathRays / pathSeconds) / (bareRays / bareSeconds);
}
BENCHMARK_CAPTURE(path, diffuse, builtin::RoomKind::diffuse)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(path, mixed, builtin::RoomKind::mixed)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(path, manyLights, builtin::RoomKind::manyLights)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

// A wavy ceiling of `cells`^2 quads that shines on a point one metre below it.
Scene shiningCeiling(int64_t cells) {
  Scene scene;
  scene.materials.emplace_back();
  Emitter emitter;
  emitter.type = EmitterType::area;
  emitter.radiance = Rgb(1);
  scene.emitters.push_back(emitter);
  scene.meshes.push_back(builtin::wavyWall({-2, -2, 1}, {0, 4, 0}, {4, 0, 0}, {0, 0, -1},
                                      static_cast<uint32_t>(cells), 0.1f));
  Instance instance;
  instance.mesh = {0};
  instance.material = {0};
  instance.emitter = {0};
  scene.instances.push_back(instance);
  return scene;
}

void emitterBuild(benchmark::State& state) {
  const Scene scene = shiningCeiling(state.range(0));
  for (auto _ : state) {
    const EmitterSampler emitters(scene, bounds(scene));
    benchmark::DoNotOptimize(emitters.power());
  }
  state.counters["triangles"] = static_cast<double>(triangleCount(scene));
}
BENCHMARK(emitterBuild)->Arg(22)->Arg(708)->UseRealTime()->Unit(benchmark::kMillisecond);

// One thread; "deviation" is that of one sample of the irradiance over its mean.
void emitterSample(benchmark::State& state) {
  const Scene scene = shiningCeiling(state.range(0));
  const EmitterSampler emitters(scene, bounds(scene));
  Rng random(1);
  double sum = 0, square = 0, count = 0;
  for (auto _ : state) {
    const float select = random.next1D();
    const Vec2f u = random.next2D();
    const auto s = emitters.sampleDirection({}, {0, 0, 1}, {select, u.x, u.y});
    const double v = s ? static_cast<double>(s->weight.x * std::max(0.f, s->wi.z)) : 0;
    sum += v, square += v * v, count += 1;
  }
  const double mean = sum / count;
  state.counters["deviation"] = std::sqrt(std::max(0.0, square / count - mean * mean)) / mean;
  state.SetItemsProcessed(static_cast<int64_t>(count));
}
BENCHMARK(emitterSample)->Arg(1)->Arg(22)->Arg(708);

}  // namespace
}  // namespace lobelia
