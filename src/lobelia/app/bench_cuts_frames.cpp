#include "lobelia/app/bench_cuts_frames.h"

namespace lobelia::app {

Film objectsOf(const Tracer& tracer, const Camera& camera) {
  Film mask = emptyFrame(camera);
  const int width = camera.width, height = camera.height;
  std::vector<uint8_t> seen(static_cast<size_t>(width) * static_cast<size_t>(height));
  const auto at = [&](int x, int y) -> uint8_t& {
    return seen[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vec2f place{static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f};
      at(x, y) = tracer.intersect(generateRay(camera, place, {0.5f, 0.5f})) ? 1 : 0;
    }
  std::vector<float>& values = mask.layers.at("").values;
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      bool inside = true;
      for (int k = 0; k < 9; ++k) inside = inside && at(x + k % 3 - 1, y + k / 3 - 1) != 0;
      const size_t pixel =
          static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x);
      for (size_t c = 0; c < 3; ++c) values[3 * pixel + c] = inside ? 1.f : 0.f;
    }
  return mask;
}

Film cutsFrame(relight::FrameRenderer& renderer, const BenchScene& scene,
               const FrameOptions& options, Context& context) {
  Film film = emptyFrame(scene.camera());
  const relight::FrameLight light = renderer.light(0, {.nodeCount = options.nodes}, context);
  renderer.render(light, scene.camera(),
                  {.spp = options.spp,
                   .refined = options.refined,
                   .hideEmitters = scene.tracer().scene().hideEmitters},
                  film, context);
  return film;
}

}  // namespace lobelia::app
