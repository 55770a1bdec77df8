// Using Lobelia as a library: the mean brightness of a scene, by virtual lights and by path tracing.
//
//   cmake --install build/release --prefix PREFIX
//   cmake -S examples/library -B build/example -DCMAKE_PREFIX_PATH=PREFIX && cmake --build build/example
//   build/example/brightness scene.xml
#include <cstdio>

#include "lobelia/gather/gather.h"
#include "lobelia/io/scene_io.h"
#include "lobelia/lights/light_pass.h"

using namespace lobelia;

static double mean(const Film& film) {
  double sum = 0;
  for (const char* layer : {"direct", "indirect"}) {
    for (size_t i = 0; i < film.pixelCount(); ++i) sum += luminance(film.rgb(i, layer));
  }
  return sum / static_cast<double>(film.pixelCount());
}

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: brightness SCENE\n"), 2;
  Context context;
  const Scene scene = io::readScene(argv[1], {}, context);
  const Tracer tracer(scene, context);
  const EmitterSampler emitters(scene, tracer.bounds());
  Camera camera = scene.cameras.at(0);
  camera.width = camera.cropX1 = camera.height = camera.cropY1 = 64;
  camera.cropX0 = camera.cropY0 = 0;

  Film film;
  film.fullWidth = film.width = film.fullHeight = film.height = 64;
  for (const char* layer : {"", "direct", "indirect"}) film.addLayer(layer);
  Film reference = film;
  renderPath(tracer, emitters, camera, {.spp = 64}, reference, context);

  const VirtualLights lights = makeLights(tracer, emitters, {.count = 2000}, context);
  const Receivers receivers = traceReceivers(tracer, emitters, camera, {}, 0, 64, film, context);
  std::vector<Rgb> radiance(receivers.points.size());
  gatherAll(tracer, receivers, lights, {}, radiance, context);
  Layer& indirect = film.layers.at("indirect");
  for (size_t i = 0; i < radiance.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      indirect.values[receivers.points[i].pixel * 3 + static_cast<size_t>(c)] += radiance[i][c];
    }
  }
  std::printf("virtual lights %.4f, path tracing %.4f\n", mean(film), mean(reference));
}
