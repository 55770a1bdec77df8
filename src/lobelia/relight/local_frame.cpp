#include "lobelia/relight/local_frame.h"

#include "lobelia/path/receivers.h"
#include "lobelia/relight/local_tile.h"
#include "lobelia/relight/tile_pool.h"

namespace lobelia::relight {
namespace {

const VisibilityData& requireSurfaces(const VisibilityData& data) {
  if (data.samples.kind == LightSamples::Kind::surfaces) return data;
  throw UsageError(
      "the data are of light from an environment; make data of local light with `lobelia "
      "precompute --light surfaces`");
}

void addCounts(const LocalCounts& counts, bool added, uint64_t pixels, double seconds,
               Context& context) {
  Statistics& s = context.statistics;
  const std::pair<const char*, int64_t> stages[] = {{"buffer", counts.bufferNs},
                                                    {"cut", counts.cutNs},
                                                    {"merge", counts.mergeNs},
                                                    {"direct", counts.directNs},
                                                    {"shade", counts.shadeNs}};
  double spent = 0;
  for (const auto& [stage, ns] : stages) spent += static_cast<double>(ns);
  for (const auto& [stage, ns] : stages)
    s.addSeconds(stage, spent > 0 ? seconds * static_cast<double>(ns) / spent : 0);
  if (!added) {
    s.addCount("frames", 1);
    s.addCount("pixels", pixels);
    s.addCount("object_pixels", counts.objectPixels);
  }
  s.addCount("vertices_merged", counts.vertices);
  s.addCount("merged_nodes", counts.mergedNodes);
  s.addCount("cut_nodes", counts.cutNodes);
  s.addCount("evaluations", counts.evaluations);
  s.addCount("shadow_rays", counts.shadowRays);
  s.addCount("mirror_rays", counts.mirrorRays);
  s.addCount("nonfinite", counts.nonFinite);
  if (counts.firstBad) noteNonFinitePixel(*counts.firstBad, context);
}

}  // namespace

struct LocalRenderer::Impl {
  Impl(const Tracer& t, const EmitterSampler& e, const VisibilityData& d)
      : tracer(t),
        emitters(&e),
        data(requireSurfaces(d)),
        surfaces(t, d.samples),
        sources(std::make_unique<LocalSources>(t.scene())) {}

  const Tracer& tracer;
  const EmitterSampler* emitters;
  const VisibilityData& data;
  const SampleSurfaces surfaces;
  std::unique_ptr<LocalSources> sources;
  TilePool<LocalTile> tiles;
};

LocalRenderer::LocalRenderer(const Tracer& tracer, const EmitterSampler& emitters,
                             const VisibilityData& data)
    : impl_(std::make_unique<Impl>(tracer, emitters, data)) {}
LocalRenderer::~LocalRenderer() = default;

void LocalRenderer::relight(const EmitterSampler& emitters) {
  impl_->emitters = &emitters;
  impl_->sources = std::make_unique<LocalSources>(impl_->tracer.scene());
}

bool LocalRenderer::hasLight() const { return impl_->sources->count() > 0; }

SurfaceLight LocalRenderer::light(const LocalSettings& settings, Context& context) const {
  const StageTimer timer(context, "light");
  const std::vector<Rgb> radiance =
      impl_->surfaces.radiance(impl_->tracer, *impl_->sources, settings.areaPlaces, context);
  return surfaceLight(impl_->data.samples, radiance);
}

void LocalRenderer::render(const SurfaceLight& light, const Camera& camera,
                           const LocalSettings& settings, Film& film, Context& context) {
  const int64_t start = nanosecondsNow();
  const LocalInput input{impl_->tracer, *impl_->emitters, *impl_->sources, impl_->data,
                         light,         camera,           settings,        context.seed};
  const LocalCounts counts = impl_->tiles.renderAll(
      tileAreas(film, LocalTile::kSize), context,
      [&](LocalTile& tile, const TileArea& area) { return tile.render(input, area, film); });
  addCounts(counts, settings.add, film.pixelCount(),
            static_cast<double>(nanosecondsNow() - start) * 1e-9, context);
}

}  // namespace lobelia::relight
