// Texels of reflective shadow maps are the first vertices of particles whose random numbers are
// laid out on a square; from there they go on as all particles do (particle_walk.cpp).
//
// Deviations from the paper, which rasterises one map of a spot light: any emitter, by rays; a view
// has two sets of random numbers of its own, which say where on which emitter it is (of emitters
// far away: in which direction), and texels vary the two others, each jittered in its cell. All
// views together are an unbiased estimate of what particles are, at depth 1 with less noise.
#include "lobelia/lights/reflective_shadow_map.h"

#include <atomic>
#include <bit>

#include "lobelia/base/morton.h"
#include "lobelia/base/parallel.h"
#include "lobelia/lights/light_order.h"
#include "lobelia/lights/particle_walk.h"
#include "lobelia/path/infinite_lights.h"
#include "lobelia/path/point_lights.h"

namespace lobelia {
namespace {

constexpr uint64_t kViewStream = 0x76696577ull, kTexelStream = 0x746578656cull;
constexpr size_t kDefaultViews = 64;
constexpr uint32_t kMaxSize = 1u << 13;
constexpr size_t kMaxTexels = 0xffffffffu;  // Sampler's indices

// Does all light leave one point, or in one direction, so that views would all be the same?
bool hasNoExtent(const Emitter& e) {
  return isPointLike(e.type) || e.type == EmitterType::directional ||
         (e.type == EmitterType::sun && e.angularRadius < kSmallestDisc);
}

size_t viewCount(const Scene& scene, const ShadowMapSettings& maps) {
  if (maps.views > 0) return std::min<size_t>(maps.views, kMaxTexels);
  if (scene.emitters.size() == 1 && hasNoExtent(scene.emitters[0])) return 1;
  // Every emitter is to have some.
  constexpr size_t kViewsOfEmitter = 4, kLeastTexels = 64;
  const size_t most = std::max(kDefaultViews, maps.texels / kLeastTexels);
  return std::clamp(kViewsOfEmitter * scene.emitters.size(), kDefaultViews, most);
}

// The power of two nearest to the wanted side, by its logarithm.
uint32_t sizeOfViews(size_t views, size_t texels) {
  const double side = std::sqrt(static_cast<double>(texels) / static_cast<double>(views));
  uint32_t size = 1;
  while (size < kMaxSize && size * std::sqrt(2.0) < side && views * size * size * 4 <= kMaxTexels)
    size *= 2;
  return size;
}

// What the texels of a map have in common.
struct View {
  float uSelect;
  Vec2f fixed;
  bool infinite = false;          // the fixed numbers are of the direction, not of the position
  std::optional<EmittedRay> ray;  // one of its rays

  View(const EmitterSampler& emitters, uint64_t seed, size_t index, size_t count) {
    Sampler random(seed, kViewStream, static_cast<uint32_t>(index));
    const double jittered = static_cast<double>(index) + double{random.next1D()};
    uSelect = std::min(static_cast<float>(jittered / static_cast<double>(count)), 0x1.fffffep-1f);
    fixed = random.next2D();
    ray = emitters.sampleRay(uSelect, fixed, fixed);
    infinite = ray && ray->infinite;
  }
  std::optional<EmittedRay> rayOf(const EmitterSampler& emitters, Vec2f texel) const {
    return emitters.sampleRay(uSelect, infinite ? texel : fixed, infinite ? fixed : texel);
  }
};

class MapPass {
 public:
  MapPass(const Tracer& tracer, const EmitterSampler& emitters, const LightSettings& settings,
          uint64_t seed, size_t views, uint32_t size)
      : emitters_(emitters),
        seed_(seed),
        size_(size),
        shares_(static_cast<double>(views) * size * size),
        walk_(tracer, emitters, settings, seed, kTexelStream, static_cast<float>(1 / shares_)) {
    for (size_t v = 0; v < views; ++v) views_.emplace_back(emitters, seed, v, views);
  }

  size_t rowCount() const { return views_.size() * size_; }
  int lastDepth() const { return walk_.lastDepth(); }
  // Lights of depth 0.
  void leaveOnEmitters(ParticleBatch* out) const {
    const float share = 1 / static_cast<float>(views_.size());
    for (const View& view : views_)
      if (view.ray) walk_.leaveOnEmitter(*view.ray, view.ray->power * share, out);
  }

  // Row of all rows of all maps; texels: of the row. Returns how many have power.
  size_t traceRow(size_t row, std::span<LightPoint> texels, ParticleBatch* others) const {
    const View& view = views_[row / size_];
    size_t lit = 0;
    for (uint32_t x = 0; view.ray && x < size_; ++x) {
      Sampler random(seed_, kTexelStream, static_cast<uint32_t>(row * size_ + x));
      const Vec2f jitter = random.next2D();
      const Vec2f texel = inCell({x, static_cast<uint32_t>(row % size_)}, jitter);
      const auto emitted = view.rayOf(emitters_, texel);
      if (!emitted) continue;
      const size_t first = others->points.size();
      walk_.traceFrom(*emitted, random, others);
      lit += takeTexel(*emitted, first, &texels[x], others) ? 1 : 0;
    }
    return lit;
  }

 private:
  Vec2f inCell(Vec2<uint32_t> cell, Vec2f jitter) const {
    const auto place = [&](uint32_t i, float u) {
      return std::min((static_cast<float>(i) + u) / static_cast<float>(size_), 0x1.fffffep-1f);
    };
    return {place(cell.x, jitter.x), place(cell.y, jitter.y)};
  }

  // Of what the particle left, the point that faces the emitter is the texel's.
  static bool takeTexel(const EmittedRay& emitted, size_t first, LightPoint* texel,
                        ParticleBatch* others) {
    std::vector<LightPoint>& points = others->points;
    if (first == points.size()) return false;
    const LightPoint& point = points[first];
    if (point.depth != 1 || dot(point.n, emitted.ray.d) > 0) return false;
    *texel = point;
    points.erase(points.begin() + static_cast<ptrdiff_t>(first));
    return true;
  }

  const EmitterSampler& emitters_;
  uint64_t seed_;
  uint32_t size_;
  double shares_;  // number of particles
  ParticleWalk walk_;
  std::vector<View> views_;
};

// Rows in parallel, joined in their order.
ParticleBatch traceMaps(const MapPass& pass, ShadowMaps* result, Context& context) {
  const uint32_t size = result->maps.front().size;
  std::vector<ParticleBatch> rows(pass.rowCount());
  std::atomic<size_t> done{0}, lit{0};
  parallelFor(rows.size(), 1, [&](size_t row) {
    if (context.cancelled()) return;
    const std::span texels(result->maps[row / size].texels);
    lit += pass.traceRow(row, texels.subspan(row % size * size, size), &rows[row]);
    const size_t finished = done.fetch_add(1, std::memory_order_relaxed) + 1;
    if (finished % 256 == 0)
      context.progress("lights", static_cast<double>(finished) / static_cast<double>(rows.size()));
  });
  ParticleBatch all;
  for (const ParticleBatch& b : rows) {
    all.points.insert(all.points.end(), b.points.begin(), b.points.end());
    all.addCounts(b);
  }
  context.statistics.addCount("light_particles", rows.size() * size);
  context.statistics.addCount("rsm_texels", lit);
  if (lit == 0 && all.points.empty() && !context.cancelled())
    context.warning("no particle left a virtual light: lights give no indirect light");
  return all;
}

}  // namespace

ShadowMaps makeShadowMaps(const Tracer& tracer, const EmitterSampler& emitters,
                          const LightSettings& wanted, const ShadowMapSettings& maps,
                          Context& context) {
  const StageTimer timer(context, "lights");
  LightSettings settings = wanted;
  settings.kind = LightKind::gaussian;
  ShadowMaps result;
  if (emitters.empty() || maps.texels == 0) return result;
  const size_t views = viewCount(emitters.scene(), maps);
  const uint32_t size = sizeOfViews(views, maps.texels);
  const MapPass pass(tracer, emitters, settings, seedOf(settings, context), views, size);
  ParticleBatch others;
  if (pass.lastDepth() >= 1) {
    result.maps.assign(views, {size, std::vector<LightPoint>(size_t{size} * size)});
    others = traceMaps(pass, &result, context);
  }
  if (settings.directAsLights && pass.lastDepth() >= 0) pass.leaveOnEmitters(&others);
  others.book(context);
  sortByGroup(&others.points);
  result.others = std::move(others.points);
  return result;
}

ReflectiveShadowMap mapOfPoints(std::vector<LightPoint> points, const Bounds3f& bounds) {
  const float scale = 1 / std::max(maxComponent(bounds.extent()), 1e-30f);
  std::vector<uint64_t> keys(points.size());
  parallelFor(keys.size(), 4096, [&](size_t i) {
    keys[i] = uint64_t{morton((points[i].p - bounds.lo) * scale)} << 32 | i;
  });
  parallelSort(&keys);
  ReflectiveShadowMap map;
  map.inOrderOfPlace = true;
  map.size = 1;
  while (size_t{map.size} * map.size < points.size()) map.size *= 2;
  map.texels.resize(size_t{map.size} * map.size);
  parallelFor(map.texels.size(), 4096, [&](size_t i) {
    const uint64_t rank =
        morton(static_cast<uint32_t>(i % map.size), static_cast<uint32_t>(i / map.size));
    if (rank < keys.size()) map.texels[i] = points[static_cast<uint32_t>(keys[rank])];
  });
  return map;
}

}  // namespace lobelia
