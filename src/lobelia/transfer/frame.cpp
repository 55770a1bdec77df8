#include "lobelia/transfer/frame.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include "lobelia/relight/frame.h"
#include "lobelia/relight/tile_counts.h"
#include "lobelia/relight/tile_pool.h"
#include "lobelia/transfer/frame_tile.h"

namespace lobelia::transfer {
namespace {

void addCounts(const TileCounts& counts, uint64_t pixels, double seconds, Context& context) {
  relight::addTileCounts(counts, pixels, seconds, context);
  Statistics& s = context.statistics;
  s.addCount("light_lookups", counts.lightLookups);
}

size_t passNumber(int pass, const TransferData& data) {
  return std::min(static_cast<size_t>(std::max(pass, 0)), data.passes.size());
}

bool sameLight(const relight::DistantLight& a, const relight::DistantLight& b) {
  return a.everywhere == b.everywhere &&
         std::equal(a.powers.begin(), a.powers.end(), b.powers.begin(), b.powers.end(),
                    [](const relight::DirectedPower& x, const relight::DirectedPower& y) {
                      return x.direction == y.direction && x.power == y.power;
                    });
}

}  // namespace

struct TransferRenderer::Impl {
  Impl(const Tracer& t, const TransferData& d)
      : tracer(t), data(d), tables(t.scene()), lookup(t.scene(), d, tables) {
    if (!d.passes.front().diffuse.empty())
      unoccluded = unoccludedDiffuse(d.mesh.vertices, d.diffuseSides);
  }

  const Tracer& tracer;
  const TransferData& data;
  ReflectionTables tables;
  SliceLookup lookup;
  const EmitterSampler* emitters = nullptr;
  std::vector<DiffuseLobes> unoccluded;
  relight::DistantLight madeOf;  // `light`
  std::optional<PrefilteredLight> light;
  std::optional<Irradiance> irradiance;
  relight::TilePool<FrameTile> tiles;
  uint64_t frame = 0;  // the last one's number
};

TransferRenderer::TransferRenderer(const Tracer& tracer, const TransferData& data)
    : impl_(std::make_unique<Impl>(tracer, data)) {}
TransferRenderer::~TransferRenderer() = default;

bool TransferRenderer::relight(const EmitterSampler& emitters, Context& context) {
  const StageTimer timer(context, "light");
  impl_->emitters = &emitters;
  relight::DistantLight light = relight::distantLight(impl_->tracer.scene());
  if (impl_->light && sameLight(light, impl_->madeOf)) return false;
  impl_->light.emplace(light);
  impl_->irradiance.emplace(*impl_->light);
  impl_->madeOf = std::move(light);
  return true;
}

void TransferRenderer::render(const TransferFrameSettings& settings, const Camera& camera,
                              Film& film, Context& context) {
  if (!impl_->light) throw std::logic_error("TransferRenderer::relight() comes before frames");
  const int64_t start = nanosecondsNow();
  const Mat4 turned = relight::turnOfLight(impl_->tracer.scene(), settings.rotation);
  const FrameLight light{*impl_->light,
                         *impl_->irradiance,
                         impl_->unoccluded,
                         DirectionRows(transpose(turned)),
                         passNumber(settings.firstPass, impl_->data),
                         passNumber(settings.endPass, impl_->data)};
  const EyeDirection eye(camera);
  const FrameInput input{
      impl_->tracer, *impl_->emitters, impl_->data, impl_->tables, impl_->lookup, light,
      eye,           camera,           settings,    context.seed,  ++impl_->frame};
  const TileCounts counts = impl_->tiles.renderAll(
      relight::tileAreas(film), context, [&](FrameTile& tile, const relight::TileArea& area) {
        return tile.render(input, area, film);
      });
  addCounts(counts, film.pixelCount(), static_cast<double>(nanosecondsNow() - start) * 1e-9,
            context);
}

}  // namespace lobelia::transfer
