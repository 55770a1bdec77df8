#include "lobelia/relight/frame.h"

#include "lobelia/relight/frame_tile.h"
#include "lobelia/relight/tile_counts.h"
#include "lobelia/relight/tile_pool.h"

namespace lobelia::relight {
namespace {

// Environments are turned about what is their vertical: +y of their own axes (scene/emitter.h).
Vec3d verticalOf(const Scene& scene) {
  for (const Emitter& emitter : scene.emitters) {
    if (emitter.type != EmitterType::environment) continue;
    const Vec3f up = emitter.toWorld.vector({0, 1, 0});
    return {static_cast<double>(up.x), static_cast<double>(up.y), static_cast<double>(up.z)};
  }
  return {0, 1, 0};
}

const VisibilityData& requireEnvironment(const VisibilityData& data) {
  if (data.samples.kind == LightSamples::Kind::environment) return data;
  throw UsageError(
      "the data are of light from surfaces; make data of an environment with `lobelia precompute`");
}

void addCounts(const TileCounts& counts, uint64_t pixels, double seconds, Context& context) {
  addTileCounts(counts, pixels, seconds, context);
  Statistics& s = context.statistics;
  s.addCount("merged_nodes", counts.mergedNodes);
  s.addCount("evaluations", counts.pixels.evaluations);
  s.addCount("fine_chunks", counts.pixels.fineChunks);
}

}  // namespace

struct FrameRenderer::Impl {
  Impl(const Tracer& t, const EmitterSampler& e, const VisibilityData& d)
      : tracer(t),
        emitters(&e),
        data(requireEnvironment(d)),
        lookup(data.samples.p),
        light(distantLight(t.scene())) {}

  const Tracer& tracer;
  const EmitterSampler* emitters;
  const VisibilityData& data;
  DirectionLookup lookup;
  DistantLight light;
  TilePool<FrameTile> tiles;
};

Mat4 turnOfLight(const Scene& scene, double degrees) {
  return rotation(verticalOf(scene), degrees);
}

FrameRenderer::FrameRenderer(const Tracer& tracer, const EmitterSampler& emitters,
                             const VisibilityData& data)
    : impl_(std::make_unique<Impl>(tracer, emitters, data)) {}
FrameRenderer::~FrameRenderer() = default;

void FrameRenderer::relight(const EmitterSampler& emitters) {
  impl_->emitters = &emitters;
  impl_->light = distantLight(impl_->tracer.scene());
}

FrameLight FrameRenderer::light(double degrees, const LightCutSettings& settings,
                                Context& context) const {
  const StageTimer timer(context, "light");
  const Mat4 turned = turnOfLight(impl_->tracer.scene(), degrees);
  return makeFrameLight(impl_->light, turned, impl_->data.samples, impl_->data.tree, impl_->lookup,
                        settings);
}

void FrameRenderer::render(const FrameLight& light, const Camera& camera,
                           const FrameSettings& settings, Film& film, Context& context) {
  const int64_t start = nanosecondsNow();
  const FrameInput input{impl_->tracer, *impl_->emitters, impl_->data, impl_->lookup,
                         light,         camera,           settings,    context.seed};
  const TileCounts counts = impl_->tiles.renderAll(
      tileAreas(film), context,
      [&](FrameTile& tile, const TileArea& area) { return tile.render(input, area, film); });
  addCounts(counts, film.pixelCount(), static_cast<double>(nanosecondsNow() - start) * 1e-9,
            context);
}

}  // namespace lobelia::relight
