// The path tracer against a bare loop over the same rays, all threads: the counter "of_bare" is the
// share of the bare rate that renderPath() reaches with shading, sampling and all, the two timed in
// turn in one run; "of_bare_cpu" the same in processor time, for machines that do other work too.
// The bare loop calls Embree over prepared rays, in the order in which the paths traced them. And
// emitter sampling: build and draws with 10^6 emissive triangles.
#include <benchmark/benchmark.h>

#include <ctime>

#include "closed_room.h"
#include "lobelia/base/parallel.h"
#include "lobelia/path/path_walk-inl.h"
#include "lobelia/trace/accel.h"

namespace lobelia {
namespace {

constexpr int kTile = 16, kWidth = 320, kHeight = 240, kSamples = 4;

struct TracedRay {
  Ray ray;
  bool shadow;
};

// Answers as Tracer does and keeps what it was asked.
struct Recorder {
  const Tracer& tracer;
  mutable std::vector<TracedRay> rays;
  std::optional<Hit> intersect(const Ray& ray) const {
    rays.push_back({ray, false});
    return tracer.intersect(ray);
  }
  bool occluded(const Ray& ray) const {
    rays.push_back({ray, true});
    return tracer.occluded(ray);
  }
  bool visible(Vec3f a, Vec3f b) const {
    rays.push_back({{a, b - a, 0, 0.9999f}, true});
    return tracer.visible(a, b);
  }
};

enum Room { diffuse, glossy, manyLights };

// The closed room under a lamp: all diffuse, with glossy spheres and walls, or lit by its spheres.
Scene litRoom(Room kind) {
  Scene scene = benchmark_support::closedRoom();
  scene.materials[0].diffuse = Rgb(0.7f);
  Emitter lamp;
  lamp.type = EmitterType::area;
  lamp.radiance = Rgb(10);
  scene.emitters.push_back(lamp);
  if (kind == manyLights) {
    for (size_t i = 6; i < scene.instances.size(); ++i) scene.instances[i].emitter = {0};
  } else {
    Mesh mesh;
    mesh.positions = {{2, 1, 2.9f}, {2, 3, 2.9f}, {4, 3, 2.9f}, {4, 1, 2.9f}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    Instance instance;
    instance.mesh = {static_cast<uint32_t>(scene.meshes.size())};
    instance.material = {0};
    instance.emitter = {0};
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back(instance);
  }
  if (kind == glossy) {
    Material metal;
    metal.type = MaterialType::roughConductor;
    metal.alphaU = metal.alphaV = 0.2f;
    Material coat;
    coat.type = MaterialType::roughPlastic;
    scene.materials.push_back(metal);
    scene.materials.push_back(coat);
    for (size_t i = 0; i + 1 < scene.instances.size(); i += 2) {
      scene.instances[i].material = {i % 4 == 0 ? 1u : 2u};
    }
  }
  Camera camera;
  camera.toWorld = Transform(*lookAt({0.3, 2, 1.6}, {3, 2, 1.2}, {0, 0, 1}));
  camera.fovX = 1.2f;
  camera.width = kWidth, camera.height = kHeight;
  camera.filter = PixelFilter::box;
  scene.cameras.push_back(camera);
  return scene;
}

// Rays of one rendering, by tiles.
std::vector<std::vector<TracedRay>> record(const Tracer& tracer, const EmitterSampler& emitters,
                                           const Camera& camera, const PathSettings& settings) {
  constexpr int kAcross = kWidth / kTile, kDown = kHeight / kTile;
  std::vector<std::vector<TracedRay>> tiles(kAcross * kDown);
  parallelFor(tiles.size(), 1, [&](size_t t) {
    const Recorder recorder{tracer, {}};
    const PathWalk<Recorder> walk(recorder, emitters, settings);
    PathCounts counts;
    std::vector<PathState> paths;
    for (int i = 0; i < kTile * kTile; ++i) {
      const int x = static_cast<int>(t) % kAcross * kTile + i % kTile;
      const int y = static_cast<int>(t) / kAcross * kTile + i / kTile;
      for (int s = 0; s < kSamples; ++s) {
        PathRandom random(0, static_cast<uint64_t>(y * kWidth + x), static_cast<uint32_t>(s));
        const Vec2f u = random.next2D();
        const Vec2f film{static_cast<float>(x) + u.x, static_cast<float>(y) + u.y};
        const Ray ray = generateRay(camera, film, random.next2D());
        paths.emplace_back(ray, random);
      }
      if (paths.size() < 32) continue;
      walk.trace(paths, counts);
      paths.clear();
    }
    tiles[t] = std::move(recorder.rays);
  });
  return tiles;
}

uint64_t replay(const embree::Accel& accel, const std::vector<std::vector<TracedRay>>& tiles) {
  std::vector<uint64_t> hits(tiles.size());
  parallelFor(tiles.size(), 1, [&](size_t t) {
    for (const TracedRay& traced : tiles[t]) {
      embree::QueryContext context;
      context.ray = &traced.ray;
      RTCRayHit query;
      const Ray& r = traced.ray;
      query.ray = {r.o.x, r.o.y, r.o.z, r.tMin, r.d.x, r.d.y, r.d.z, 0, r.tMax, 0xffffffffu, 0, 0};
      query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
      if (traced.shadow) {
        embree::occluded1(accel.top(), context, query.ray);
      } else {
        embree::intersect1(accel.top(), context, query);
      }
      hits[t] += query.ray.tfar < r.tMax;
    }
  });
  uint64_t sum = 0;
  for (const uint64_t h : hits) sum += h;
  return sum;
}

void path(benchmark::State& state, Room kind) {
  const Scene scene = litRoom(kind);
  Context context;
  const Tracer tracer(scene, context);
  const embree::Accel accel(scene, context);
  const EmitterSampler emitters(scene, tracer.bounds());
  PathSettings settings;
  settings.spp = kSamples;
  const auto tiles = record(tracer, emitters, scene.cameras[0], settings);
  double rays = 0;
  for (const auto& tile : tiles) rays += static_cast<double>(tile.size());
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
    benchmark::DoNotOptimize(replay(accel, tiles));
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
BENCHMARK_CAPTURE(path, diffuse, diffuse)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(path, glossy, glossy)->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(path, manyLights, manyLights)->UseManualTime()->Unit(benchmark::kMillisecond);

// A wavy ceiling of `cells`^2 quads that shines on a point one metre below it.
Scene shiningCeiling(int64_t cells) {
  Scene scene;
  scene.materials.emplace_back();
  Emitter emitter;
  emitter.type = EmitterType::area;
  emitter.radiance = Rgb(1);
  scene.emitters.push_back(emitter);
  scene.meshes.push_back(benchmark_support::wavyWall({-2, -2, 1}, {0, 4, 0}, {4, 0, 0}, {0, 0, -1},
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
