// How much of Embree's speed is left when a gather does its other work too: brute force over tiles
// of receivers and blocks of lights, against the bare time of the same shadow rays in the same
// packets (tracer.visible alone), measured in turns in one run.
//
// Counters: gather and bare in million rays per second of all threads, ratio = gather / bare.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <span>

#include "lit_room.h"
#include "lobelia/app/bench_rays.h"
#include "lobelia/base/parallel.h"
#include "lobelia/gather/gather.h"

namespace lobelia {
namespace {

using app::places;
using app::PointNormal;
using benchmark_support::Room;

struct BareResult {
  double seconds = 0, rays = 0, visible = 0;
};

// Builds the packets of some lights at a time (memory), times only their tracing.
BareResult traceBare(const Tracer& tracer, const Receivers& receivers,
                     const std::vector<PointNormal>& lights) {
  constexpr size_t kTile = 256, kLights = 100;
  const size_t count = receivers.points.size();
  std::vector<std::vector<ShadowPacket>> tiles((count + kTile - 1) / kTile);
  std::vector<uint64_t> visible(tiles.size());
  BareResult result;
  for (size_t first = 0; first < lights.size(); first += kLights) {
    const std::span some(lights.data() + first, std::min(kLights, lights.size() - first));
    parallelFor(tiles.size(), 1, [&](size_t t) {
      const std::span tile(receivers.points.data() + t * kTile, std::min(kTile, count - t * kTile));
      tiles[t] = app::tileToLights(tile, some);
    });
    const int64_t start = nanosecondsNow();
    parallelFor(tiles.size(), 1, [&](size_t t) {
      for (ShadowPacket& packet : tiles[t])
        visible[t] += static_cast<uint64_t>(__builtin_popcount(tracer.visible(packet, true)));
    });
    result.seconds += 1e-9 * static_cast<double>(nanosecondsNow() - start);
    for (const auto& packets : tiles)
      result.rays += static_cast<double>(packets.size() * ShadowPacket::kSize);
  }
  for (const uint64_t n : visible) result.visible += static_cast<double>(n);
  return result;
}

enum class Lights { diffuse, glossy };

// lobes 1: Lambert; 2: Lambert and a GGX conductor.
void gatherRoom(benchmark::State& state, Lights kind, int lobes) {
  static const Room room;
  const Receivers receivers = room.receivers(60, lobes);
  VirtualLights lights = room.lights(1000);
  (kind == Lights::diffuse ? lights.glossy.clear() : lights.diffuse.clear());
  BareResult bare;
  double gatherSeconds = 0, gatherRays = 0;
  for (auto _ : state) {
    const BareResult turn = traceBare(room.tracer(), receivers, places(lights));
    bare.seconds += turn.seconds, bare.rays += turn.rays, bare.visible += turn.visible;
    Context context;
    std::vector<Rgb> radiance(receivers.points.size());
    const int64_t start = nanosecondsNow();
    gatherAll(room.tracer(), receivers, lights, {}, radiance, context);
    const double seconds = 1e-9 * static_cast<double>(nanosecondsNow() - start);
    gatherSeconds += seconds;
    gatherRays += static_cast<double>(context.statistics.count("shadow_rays"));
    state.counters["visibility_share"] = context.statistics.seconds("visibility") / seconds;
    state.counters["shade_share"] = context.statistics.seconds("shade") / seconds;
    state.SetIterationTime(seconds);
    benchmark::DoNotOptimize(radiance.data());
  }
  state.counters["gather_Mrays"] = 1e-6 * gatherRays / gatherSeconds;
  state.counters["bare_Mrays"] = 1e-6 * bare.rays / bare.seconds;
  state.counters["ratio"] = gatherRays / gatherSeconds / (bare.rays / bare.seconds);
  state.counters["visible_share"] = bare.visible / bare.rays;
  state.counters["triangles"] = static_cast<double>(triangleCount(room.scene()));
}

void diffuseLightsLambert(benchmark::State& state) { gatherRoom(state, Lights::diffuse, 1); }
void diffuseLightsLambertGgx(benchmark::State& state) { gatherRoom(state, Lights::diffuse, 2); }
void glossyLightsLambert(benchmark::State& state) { gatherRoom(state, Lights::glossy, 1); }
void glossyLightsLambertGgx(benchmark::State& state) { gatherRoom(state, Lights::glossy, 2); }
BENCHMARK(diffuseLightsLambert)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(diffuseLightsLambertGgx)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(glossyLightsLambert)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);
BENCHMARK(glossyLightsLambertGgx)->UseManualTime()->Unit(benchmark::kMillisecond)->Iterations(3);

}  // namespace
}  // namespace lobelia
