// Light tracing: particles leave the emitters and every vertex that they meet is connected to the
// lens (Veach 1997, section 8.3; Arvo 1986). Emission that the camera sees at once is the path
// tracer's part, exact to its pixel noise and free of the particles'.
//
// Direct and indirect light as in path_walk.h, read from the other end: a path L e1 .. en E is
// direct when all events after the first are sharp.
//
// Particles are made in chunks; a chunk's splats are listed and the lists are added in order, so
// that the result does not depend on the number of threads.
#include <cmath>

#include "lobelia/base/checkpoints.h"
#include "lobelia/base/parallel.h"
#include "lobelia/path/path_walk.h"

namespace lobelia {
namespace {

constexpr size_t kChunk = 4096;         // particles
constexpr size_t kChunksPerRound = 64;  // between looks at the clock
constexpr uint64_t kStream = 0x6c69676874ull;

struct Splat {
  uint32_t pixel;
  bool direct;
  uint16_t group;
  Rgb value;
};

// The same view with `border` pixels more on every side: light just outside the film reaches
// pixels inside through the reconstruction filter.
Camera withBorder(Camera camera, int border) {
  const double sx = 1 + 2.0 * border / camera.width, sy = 1 + 2.0 * border / camera.height;
  if (camera.type == CameraType::perspective) {
    camera.fovX = 2 * std::atan(std::tan(0.5f * camera.fovX) * static_cast<float>(sx));
  } else {
    camera.toWorld = Transform(camera.toWorld.to * scaling({sx, sx, 1}));
  }
  camera.principalPointOffset.x /= static_cast<float>(sx);
  camera.principalPointOffset.y /= static_cast<float>(sy);
  camera.width += 2 * border;
  camera.height += 2 * border;
  return camera;
}

class ParticlePasses {
 public:
  ParticlePasses(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                 const PathSettings& settings, Film& film, Context& context)
      : tracer_(tracer),
        emitters_(emitters),
        settings_(settings),
        film_(film),
        context_(context),
        filter_(camera.filter),
        radius_(camera.filterRadius > 0 ? camera.filterRadius : defaultRadius(camera.filter)),
        border_(static_cast<int>(std::ceil(radius_ - 0.5f))),
        camera_(withBorder(camera, border_)),
        wanted_(film.pixelCount(), settings.pixels.pixels.empty() ? uint8_t{1} : uint8_t{0}),
        direct_(film.pixelCount() * 3),
        indirect_(film.pixelCount() * 3),
        square_(film.pixelCount() * 3),
        groups_(groupsOf(emitters, film)),
        start_(nanosecondsNow()) {
    for (const uint32_t pixel : settings.pixels.pixels) wanted_[pixel] = 1;
    constexpr int kSteps = 4096;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const float x = (static_cast<float>(i) + 0.5f) / kSteps * radius_;
      sum += static_cast<double>(evaluateFilter(filter_, radius_, x));
    }
    filterNorm_ = 1 / static_cast<float>(2 * sum * static_cast<double>(radius_) / kSteps);
  }

  // Goes on from a checkpoint of this stage; the film then holds the emission that is seen.
  bool resume() {
    Checkpoints* const saved = settings_.checkpoints;
    if (!saved || !saved->load(kStage, state())) return false;
    saved->restoreCounts();
    return true;
  }

  // False when stopped before all particles were traced. Saved are complete films only: those that
  // hold all emission that is seen.
  bool run(bool filmComplete) {
    Checkpoints* const checkpoints = filmComplete ? settings_.checkpoints : nullptr;
    const size_t total = static_cast<size_t>(std::max(settings_.spp, 0)) * film_.pixelCount();
    while (particles_ < total && !stopped()) {
      const size_t first = particles_;
      const size_t count = std::min(total - first, kChunk * kChunksPerRound);
      const size_t chunks = (count + kChunk - 1) / kChunk;
      std::vector<std::vector<Splat>> splats(chunks);
      parallelFor(chunks, 1, [&](size_t c) {
        const size_t begin = first + c * kChunk, end = std::min(begin + kChunk, first + count);
        PathCounts counts;
        for (size_t i = begin; i < end; ++i) trace(i, counts, splats[c]);
        context_.statistics.addCount("path_rays", counts.pathRays);
        context_.statistics.addCount("shadow_rays", counts.shadowRays);
        context_.statistics.addCount("nonfinite", counts.nonFinite);
      });
      for (const auto& list : splats) {
        for (const Splat& splat : list) add(splat);
      }
      particles_ += count;
      if (settings_.preview && settings_.preview->due()) show();
      context_.progress("light", static_cast<double>(particles_) / static_cast<double>(total));
      if (checkpoints && checkpoints->due()) save(*checkpoints);
    }
    if (checkpoints) save(*checkpoints);
    return filmComplete && particles_ >= total;
  }

  void write() const {
    if (particles_ == 0) return;
    const double n = static_cast<double>(particles_);
    for (size_t g = 0; g < groups_.size(); ++g) {
      if (groups_[g].empty()) continue;
      writeLayer(emitters_.groups().layer(g), [&](size_t i) { return groups_[g][i] / n; });
    }
    writeLayer("direct", [&](size_t i) { return direct_[i] / n; });
    writeLayer("indirect", [&](size_t i) { return indirect_[i] / n; });
    writeLayer("", [&](size_t i) { return (direct_[i] + indirect_[i]) / n; });
    // Of a mean over particles, nearly all of which miss the pixel.
    writeLayer("variance", [&](size_t i) {
      const double mean = (direct_[i] + indirect_[i]) / n;
      return std::max(0.0, square_[i] / n - mean * mean) / n;
    });
  }

 private:
  void save(Checkpoints& checkpoints) {
    checkpoints.markCounts();
    checkpoints.save(kStage, state());
  }
  StateFields state() {
    StateFields fields;
    for (auto& [name, layer] : film_.layers) fields.add("layer/" + name, layer.values);
    fields.add("direct", direct_);
    fields.add("indirect", indirect_);
    fields.add("square", square_);
    for (size_t g = 0; g < groups_.size(); ++g)
      fields.add("group-" + std::to_string(g), groups_[g]);
    fields.addValue("particles", particles_);
    return fields;
  }

  // Sums for the groups that the film has layers for; empty for the others.
  static std::vector<std::vector<double>> groupsOf(const EmitterSampler& emitters,
                                                   const Film& film) {
    std::vector<std::vector<double>> sums(emitters.groups().size());
    for (size_t g = 0; g < sums.size(); ++g)
      if (film.layers.contains(emitters.groups().layer(g))) sums[g].resize(film.pixelCount() * 3);
    return sums;
  }

  bool stopped() const {
    const double seconds = static_cast<double>(nanosecondsNow() - start_) * 1e-9;
    return context_.cancelled() || (settings_.timeLimit > 0 && seconds > settings_.timeLimit);
  }

  // Emission seen at once is in the film already.
  void show() const {
    const double n = static_cast<double>(particles_);
    std::vector<uint32_t> pixels;
    std::vector<Rgb> values;
    for (uint32_t pixel = 0; pixel < wanted_.size(); ++pixel) {
      if (!wanted_[pixel]) continue;
      Rgb value = film_.rgb(pixel);
      for (int c = 0; c < 3; ++c) {
        const size_t i = pixel * size_t{3} + static_cast<size_t>(c);
        value[c] += static_cast<float>((direct_[i] + indirect_[i]) / n);
      }
      pixels.push_back(pixel);
      values.push_back(value);
    }
    settings_.preview->update(pixels, values);
  }

  void add(const Splat& splat) {
    std::vector<double>& sums = splat.direct ? direct_ : indirect_;
    std::vector<double>& group = groups_[splat.group];
    for (int c = 0; c < 3; ++c) {
      const size_t i = splat.pixel * size_t{3} + static_cast<size_t>(c);
      const double value = static_cast<double>(splat.value[c]);
      sums[i] += value;
      square_[i] += value * value;
      if (!group.empty()) group[i] += value;
    }
  }

  template <class F>
  void writeLayer(const std::string& name, const F& value) const {
    const auto layer = film_.layers.find(name);
    if (layer == film_.layers.end() || layer->second.channels != 3) return;
    for (size_t i = 0; i < direct_.size(); ++i) {
      layer->second.values[i] += static_cast<float>(value(i));
    }
  }

  // Adds light seen at a film position to the pixels whose filter covers it.
  void splat(Vec2f film, Rgb direct, Rgb indirect, uint16_t group, PathCounts& counts,
             std::vector<Splat>& out) const {
    if (!isFinite(direct) || !isFinite(indirect)) {
      ++counts.nonFinite;
      return;
    }
    const float x = film.x - static_cast<float>(border_ + film_.x0);
    const float y = film.y - static_cast<float>(border_ + film_.y0);
    const auto first = [&](float p) { return static_cast<int>(std::ceil(p - 0.5f - radius_)); };
    const auto last = [&](float p) { return static_cast<int>(std::floor(p - 0.5f + radius_)); };
    const int x1 = std::min(last(x), film_.width - 1), y1 = std::min(last(y), film_.height - 1);
    for (int py = std::max(first(y), 0); py <= y1; ++py) {
      const float wy = evaluateFilter(filter_, radius_, y - 0.5f - static_cast<float>(py));
      if (wy == 0) continue;
      for (int px = std::max(first(x), 0); px <= x1; ++px) {
        const float wx = evaluateFilter(filter_, radius_, x - 0.5f - static_cast<float>(px));
        const uint32_t pixel = static_cast<uint32_t>(py) * static_cast<uint32_t>(film_.width) +
                               static_cast<uint32_t>(px);
        const float weight = wx * wy * filterNorm_ * filterNorm_;
        if (weight == 0 || !wanted_[pixel]) continue;
        if (direct != Rgb{}) out.push_back({pixel, true, group, direct * weight});
        if (indirect != Rgb{}) out.push_back({pixel, false, group, indirect * weight});
      }
    }
  }

  // chain: throughput over paths whose events after the first are sharp; all: over any.
  void connect(const SurfacePoint& at, const Bsdf& bsdf, Vec3f wo, int vertex, Rgb chain, Rgb all,
               Vec2f uLens, uint16_t group, PathCounts& counts, std::vector<Splat>& out) const {
    FilmConnection lens;
    if (!connectToCamera(camera_, at.p, uLens, &lens)) return;
    const Vec3f wi = normalize(lens.lens - at.p);
    const Rgb f = evaluate(bsdf, wo, wi, LobeSet::all, Transport::importance);
    if (f == Rgb{}) return;
    ++counts.shadowRays;
    if (!tracer_.visible(offsetOrigin(at, wi), lens.lens)) return;
    const Rgb light = all * f * lens.importance;
    Rgb direct = light;
    if (vertex > 1) {
      direct = {};
      if (chain != Rgb{} && hasLobes(bsdf, LobeSet::sharp)) {
        direct =
            chain * evaluate(bsdf, wo, wi, LobeSet::sharp, Transport::importance) * lens.importance;
      }
    }
    const Rgb indirect = vertex > 1 ? max(light - direct, Rgb{}) : Rgb{};
    splat(lens.film, settings_.component == Component::indirect ? Rgb{} : direct,
          settings_.component == Component::direct ? Rgb{} : indirect, group, counts, out);
  }

  void trace(size_t particle, PathCounts& counts, std::vector<Splat>& out) const {
    PathRandom random(context_.seed ^ kStream, particle >> 32, static_cast<uint32_t>(particle));
    const float select = random.next1D();
    const Vec2f position = random.next2D();
    const auto emitted = emitters_.sampleRay(select, position, random.next2D());
    if (!emitted) return;
    const uint16_t group = emitters_.groups().of(emitted->emitter);
    Ray ray = emitted->ray;
    // Roulette compares with what the particle set out with.
    const float start = maxComponent(emitted->power);
    Rgb all = emitted->power, chain{};
    float eta = 1;
    const int maxDepth = settings_.maxDepth < 0 ? 1 << 30 : settings_.maxDepth;
    for (int vertex = 1; vertex + 1 <= maxDepth && start > 0; ++vertex) {
      ++counts.pathRays;
      const auto hit = tracer_.intersect(ray);
      if (!hit) return;
      const SurfacePoint at = surfacePoint(emitters_.scene(), *hit);
      const Vec3f wo = -ray.d;
      const Rgb inside = interiorTransmittance(emitters_.scene(), at, wo);
      all *= inside, chain *= inside;
      if (vertex > settings_.rouletteDepth) {
        const float survival = rouletteSurvival(all / start, eta);
        if (!(random.next1D() < survival)) return;
        all /= survival;
        chain /= survival;
      }
      const Bsdf bsdf = makeBsdf(emitters_.scene(), at, wo, settings_.specularLimit);
      if (!onlyDelta(bsdf))
        connect(at, bsdf, wo, vertex, chain, all, random.next2D(), group, counts, out);
      const float uLobe = random.next1D();
      const auto s = sample(bsdf, wo, uLobe, random.next2D(), LobeSet::all, Transport::importance);
      if (!s || s->weight == Rgb{}) return;
      chain =
          vertex == 1 ? all * s->weight : chain * sharpPart(bsdf, wo, *s, Transport::importance);
      all *= s->weight;
      eta *= s->eta;
      if (settings_.component == Component::direct && chain == Rgb{}) return;
      ray = Ray{};
      ray.o = offsetOrigin(at, s->wi);
      ray.d = s->wi;
    }
  }

  static constexpr const char* kStage = "light";
  const Tracer& tracer_;
  const EmitterSampler& emitters_;
  const PathSettings& settings_;
  Film& film_;
  Context& context_;
  const PixelFilter filter_;
  const float radius_;
  const int border_;
  const Camera camera_;
  std::vector<uint8_t> wanted_;
  std::vector<double> direct_, indirect_, square_;
  std::vector<std::vector<double>> groups_;  // by light group
  float filterNorm_ = 1;
  uint64_t particles_ = 0;
  const int64_t start_;
};

}  // namespace

bool renderLight(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                 const PathSettings& settings, Film& film, Context& context) {
  PathSettings emission = settings;
  emission.maxDepth = std::min(settings.maxDepth < 0 ? 1 : settings.maxDepth, 1);
  ParticlePasses passes(tracer, emitters, camera, settings, film, context);
  const bool seen =
      passes.resume() || renderPath(tracer, emitters, camera, emission, film, context);
  markPixels(film, settings.pixels);
  const StageTimer timer(context, "light");
  const bool complete = passes.run(seen);
  passes.write();
  return complete;
}

}  // namespace lobelia
