#include "lobelia/transfer/gather_block.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "lobelia/transfer/arrivals.h"
#include "lobelia/transfer/lobe_weights.h"

namespace lobelia::transfer {
namespace {

// Slices of which less than this is in the way are taken for whole, and shares of a bounce below
// it for nothing: a thousandth of a surface's own reflection.
constexpr float kLeastShare = 1e-3f;

constexpr size_t kLanes = relight::kChunk;
constexpr uint32_t kAllLanes = (1u << kLanes) - 1;

uint32_t lanesOf(std::span<const uint64_t> bits, size_t chunk) {
  constexpr size_t kPerWord = 64 / kLanes;
  const size_t word = chunk / kPerWord;
  return word < bits.size()
             ? static_cast<uint32_t>(bits[word] >> (chunk % kPerWord * kLanes)) & kAllLanes
             : 0;
}

// Sums of what arrives along rays, for the lobe that it becomes.
struct LobeTotal {
  Rgb alpha{};
  Vec3f first{};
  void add(float weight, const LobeMoment& m) {
    alpha += m.alpha * weight, first += m.first * weight;
  }
  // total: of the weights of all rays.
  TransferLobe lobe(float total) const {
    const float energy = luminance(alpha);
    return {alpha / total, energy > 0 ? first / energy : Vec3f()};
  }
};

// Weights of directions in a lobe, with their memory.
class LobeWeights {
 public:
  void setDirections(const DirectionChunks& directions) { directions_ = &directions; }
  std::span<const uint32_t> find(const Bsdf& part, Vec3f wo) {
    findChunks(*directions_, part, wo, &chunks_);
    return chunks_;
  }
  // kChunk weights for each of the chunks; good until the next call.
  const float* evaluate(const Bsdf& part, Vec3f wo, std::span<const uint32_t> chunks) {
    if (values_.size() < chunks.size() * kLanes) values_.resize(chunks.size() * kLanes);
    lobeWeights(*directions_, part, wo, chunks, values_.data());
    return values_.data();
  }

 private:
  const DirectionChunks* directions_ = nullptr;
  std::vector<uint32_t> chunks_;
  relight::AlignedFloats values_;
};

// Sums over the lanes of chunks, lane by lane, which compilers turn into registers.
struct LaneSums {
  using Lanes = std::array<float, kLanes>;
  Lanes all{}, cells{}, seen{}, x{}, y{}, z{};

  // cellSolidAngle: by lane, of what bounces gather in.
  void add(const RaySphere& sphere, const float* cellSolidAngle, uint32_t chunk,
           const float* weights, uint32_t free) {
    Lanes visible;
    for (size_t l = 0; l < kLanes; ++l) visible[l] = static_cast<float>(free >> l & 1);
    const size_t at = chunk * kLanes;
    const float *solid = &sphere.solidAngle[at], *dx = &sphere.chunks.x[at],
                *dy = &sphere.chunks.y[at], *dz = &sphere.chunks.z[at], *cell = cellSolidAngle + at;
    for (size_t l = 0; l < kLanes; ++l) {
      const float weight = weights[l] * solid[l], v = weight * visible[l];
      all[l] += weight, seen[l] += v;
      cells[l] += weights[l] * cell[l];
      x[l] += v * dx[l], y[l] += v * dy[l], z[l] += v * dz[l];
    }
  }
  static float total(const Lanes& lanes) {
    float sum = 0;
    for (const float v : lanes) sum += v;
    return sum;
  }
};

// A vertex and the parts of its Bsdf; for one side of it at a time.
class Vertex {
 public:
  Vertex(const GatherInput& input, size_t index)
      : input_(input),
        index_(index),
        at_(surfacePoint(input.tracer.scene(), input.data.mesh.vertices[index].hit())) {}

  MaterialHandle material() const { return at_.material; }
  Bsdf bsdf(Vec3f wo) const { return makeBsdf(input_.tracer.scene(), at_, wo, 0); }
  // False: nothing is reflected towards wo.
  bool reflection(Vec3f wo, Reflection* out) const {
    const Vec3f n = input_.data.mesh.vertices[index_].n;
    if (input_.tables.has(material())) return input_.tables.summary(material(), n, wo, out);
    *out = reflectionOf(bsdf(wo), wo);
    return out->count > 0 || out->diffuse != Rgb{};
  }
  Vec3f normal() const { return input_.data.mesh.vertices[index_].n; }
  // f(wo) for the sides whose diffuse light is kept; wo: their normal.
  template <class F>
  void forDiffuseSides(const F& f) const {
    if (!input_.anyDiffuse) return;
    f(normal());
    if (input_.data.diffuseSides.hasBack(index_)) f(-normal());
  }

 private:
  const GatherInput& input_;
  size_t index_;
  SurfacePoint at_;
};

class DirectPass {
 public:
  DirectPass(const GatherInput& input, BlockRays* rays, BlockPass* pass, BlockCounts* counts)
      : input_(input), out_(*rays), pass_(*pass), counts_(*counts) {
    for (const RaySphere& sphere : input.rays)
      tracers_.emplace_back(input.tracer, sphere.grid, input.data.mesh.mesh.firstTriangle());
    pass_.glossy.assign(1, SliceRows(input.directions.count()));
    pass_.reflection = SliceRows(input.directions.count());
  }

  void add(size_t index) {
    const int64_t start = nanosecondsNow();
    sphere_ = &input_.rays[input_.raysOf[index]];
    const RayCells* const cells = input_.cellsOf[index];
    cellSolidAngle_ = cells ? cells->solidAngle.data() : sphere_->solidAngle.data();
    weights_.setDirections(sphere_->chunks);
    tracers_[input_.raysOf[index]].trace(input_.faces->at(index), &rays_);
    const int64_t traced = nanosecondsNow();
    store();
    const Vertex vertex(input_, index);
    findObstructed(vertex.normal());
    slices(vertex);
    vertex.forDiffuseSides([&](Vec3f wo) { diffuse(vertex, wo); });
    counts_.traceNs += traced - start, counts_.gatherNs += nanosecondsNow() - traced;
  }
  uint64_t rays() const {
    uint64_t sum = 0;
    for (const RayTracer& tracer : tracers_) sum += tracer.rays();
    return sum;
  }

 private:
  void store() {
    out_.blocked.insert(out_.blocked.end(), rays_.blocked.begin(), rays_.blocked.end());
    out_.hits.insert(out_.hits.end(), rays_.hits.begin(), rays_.hits.end());
    out_.hitStart.push_back(static_cast<uint32_t>(out_.hits.size()));
    counts_.hits += rays_.hits.size();
  }

  // Chunks with a ray above the horizon, of either side, that is not free.
  void findObstructed(Vec3f n) {
    const RaySphere& sphere = *sphere_;
    for (auto& o : obstructed_) o.assign(sphere.chunks.chunkCount(), 0);
    for (size_t c = 0; c < sphere.chunks.chunkCount(); ++c) {
      const uint32_t free = lanesOf(rays_.free, c);
      if (free == kAllLanes) continue;
      for (size_t l = 0; l < kLanes; ++l) {
        const size_t i = c * kLanes + l;
        if ((free >> l & 1) != 0 || sphere.solidAngle[i] == 0) continue;
        const float cosine = dot(n, sphere.grid.directions()[i]);
        if (cosine != 0) obstructed_[cosine < 0 ? 1 : 0][c] = 1;
      }
    }
  }

  void slices(const Vertex& vertex) {
    columns_.clear(), records_.clear(), ownColumns_.clear(), ownRecords_.clear();
    const bool tabulated = input_.tables.has(vertex.material());
    for (uint32_t k = 0; k < input_.directions.count(); ++k) {
      const Vec3f wo = input_.directions.directions()[k];
      Reflection own;
      if (!vertex.reflection(wo, &own) || luminance(own.glossy) <= 0) continue;
      ++counts_.slices;
      if (!tabulated) {
        ownColumns_.push_back(k);
        ownRecords_.push_back(pack({own.glossy, own.r}));
      }
      slice(vertex, k, wo);
    }
    pass_.glossy[0].addRow(columns_, records_);
    pass_.reflection.addRow(ownColumns_, ownRecords_);
    out_.sliceStart.push_back(static_cast<uint32_t>(out_.slices.size()));
  }

  void slice(const Vertex& vertex, uint32_t k, Vec3f wo) {
    const auto& obstructed = obstructed_[dot(vertex.normal(), wo) < 0 ? 1 : 0];
    const Bsdf part = glossyPart(vertex.bsdf(wo));
    const std::span<const uint32_t> chunks = weights_.find(part, wo);
    if (std::none_of(chunks.begin(), chunks.end(),
                     [&](uint32_t c) { return obstructed[c] != 0; })) {
      ++counts_.unoccluded;
      return;
    }
    const float* w = weights_.evaluate(part, wo, chunks);
    LaneSums sums;
    for (size_t j = 0; j < chunks.size(); ++j, w += kLanes)
      sums.add(*sphere_, cellSolidAngle_, chunks[j], w, lanesOf(rays_.free, chunks[j]));
    const float all = sums.total(sums.all), seen = sums.total(sums.seen);
    const Vec3f sum{sums.total(sums.x), sums.total(sums.y), sums.total(sums.z)};
    if (!std::isfinite(all)) {
      ++counts_.nonFinite;
      return;
    }
    if (all <= 0 || seen >= (1 - kLeastShare) * all) {
      ++counts_.unoccluded;
      return;
    }
    const float share = seen / all;
    out_.slices.push_back({k, sums.total(sums.cells)});
    columns_.push_back(k);
    records_.push_back(share < kLeastShare ? SliceRecord{} : pack({Rgb(share), sum / seen}));
  }

  void diffuse(const Vertex& vertex, Vec3f wo) {
    float all = 0, cells = 0;
    std::array<LobeTotal, kOctants> octants;
    const Bsdf part = diffusePart(vertex.bsdf(wo));
    if (part.lobeCount > 0) {
      const std::span<const uint32_t> chunks = weights_.find(part, wo);
      const float* w = weights_.evaluate(part, wo, chunks);
      for (size_t j = 0; j < chunks.size(); ++j, w += kLanes) {
        const uint32_t free = lanesOf(rays_.free, chunks[j]);
        for (size_t l = 0; l < kLanes; ++l) {
          const size_t i = chunks[j] * kLanes + l;
          const float weight = w[l] * sphere_->solidAngle[i];
          all += weight, cells += w[l] * cellSolidAngle_[i];
          if ((free >> l & 1) == 0 || weight <= 0) continue;
          const Vec3f d{sphere_->chunks.x[i], sphere_->chunks.y[i], sphere_->chunks.z[i]};
          octants[transfer::octantOf(d)].add(weight, {Rgb(1), d});
        }
      }
    }
    out_.diffuseWeight.push_back(std::isfinite(all) ? cells : 0);
    if (!std::isfinite(all)) ++counts_.nonFinite;
    DiffuseLobes lobes{};
    for (size_t o = 0; o < kOctants && all > 0 && std::isfinite(all); ++o)
      lobes[o] = pack(octants[o].lobe(all));
    pass_.diffuse.push_back(lobes);
  }

  const GatherInput& input_;
  BlockRays& out_;
  BlockPass& pass_;
  BlockCounts& counts_;
  std::vector<RayTracer> tracers_;     // by sphere
  const RaySphere* sphere_ = nullptr;  // of the vertex under way
  const float* cellSolidAngle_ = nullptr;
  LobeWeights weights_;
  VertexRays rays_;
  std::array<std::vector<uint8_t>, 2> obstructed_;  // by side and chunk
  std::vector<uint32_t> columns_, ownColumns_;
  std::vector<SliceRecord> records_, ownRecords_;
};

// total: of the weights of all rays.
TransferLobe lobeOf(const Numbers& n, float total) {
  return LobeTotal{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}}.lobe(total);
}

uint32_t octantOf(const Numbers& n) { return transfer::octantOf(Vec3f(n[3], n[4], n[5])); }

class BouncePass {
 public:
  BouncePass(const GatherInput& input, size_t pass, BlockPass* out, BlockCounts* counts)
      : input_(input),
        arrivals_(input, pass),
        classes_(static_cast<size_t>(input.data.classCount)),
        out_(*out),
        counts_(*counts) {
    out_.glossy.assign(classes_ + 1, SliceRows(input.directions.count()));
    columns_.resize(classes_ + 1), records_.resize(classes_ + 1);
  }

  // Of one vertex after the other.
  void add(const BlockRays& rays, size_t v) {
    const int64_t start = nanosecondsNow();
    const size_t words = (input_.rays[input_.raysOf[rays.first + v]].grid.count() + 63) / 64;
    arrivals_.gather(
        {rays.first + v, std::span(rays.blocked).subspan(word_, words),
         std::span(rays.hits).subspan(rays.hitStart[v], rays.hitStart[v + 1] - rays.hitStart[v])});
    word_ += words;
    weights_.setDirections(arrivals_.directions());
    const Vertex vertex(input_, rays.first + v);
    for (auto& c : columns_) c.clear();
    for (auto& r : records_) r.clear();
    if (arrivals_.any())
      for (size_t s = rays.sliceStart[v]; s < rays.sliceStart[v + 1]; ++s)
        slice(vertex, rays.slices[s]);
    for (size_t c = 0; c <= classes_; ++c) out_.glossy[c].addRow(columns_[c], records_[c]);
    vertex.forDiffuseSides([&](Vec3f wo) { diffuse(vertex, wo, rays.diffuseWeight[side_++]); });
    counts_.gatherNs += nanosecondsNow() - start;
  }

 private:
  void slice(const Vertex& vertex, const SeeingSlice& slice) {
    const Vec3f wo = input_.directions.directions()[slice.column];
    const Bsdf part = glossyPart(vertex.bsdf(wo));
    chunks_.clear();
    for (const uint32_t c : weights_.find(part, wo))
      if (arrivals_.lanes(c) != 0) chunks_.push_back(c);
    if (chunks_.empty()) return;
    const float* w = weights_.evaluate(part, wo, chunks_);
    std::array<Numbers, kMostClasses + 1> totals{};
    for (size_t j = 0; j < chunks_.size(); ++j, w += kLanes) {
      const Incoming* in = arrivals_.of(chunks_[j]);
      for (uint32_t lanes = arrivals_.lanes(chunks_[j]); lanes != 0; lanes &= lanes - 1, ++in) {
        const auto l = static_cast<size_t>(std::countr_zero(lanes));
        addTo(&totals[static_cast<size_t>(in->narrowClass)], w[l], in->narrow);
        addTo(&totals[classes_], w[l], in->broad);
      }
    }
    for (size_t c = 0; c <= classes_; ++c) {
      const TransferLobe lobe = lobeOf(totals[c], slice.weight);
      if (!isFinite(lobe.share) || !isFinite(lobe.r)) {
        ++counts_.nonFinite;
      } else if (maxComponent(lobe.share) >= kLeastShare) {
        columns_[c].push_back(slice.column);
        records_[c].push_back(pack(lobe));
      }
    }
  }

  void diffuse(const Vertex& vertex, Vec3f wo, float all) {
    DiffuseLobes lobes{};
    if (all > 0 && arrivals_.any()) {
      std::array<Numbers, kOctants> octants{};
      const Bsdf part = diffusePart(vertex.bsdf(wo));
      chunks_.clear();
      for (const uint32_t c : weights_.find(part, wo))
        if (arrivals_.lanes(c) != 0) chunks_.push_back(c);
      const float* w = weights_.evaluate(part, wo, chunks_);
      for (size_t j = 0; j < chunks_.size(); ++j, w += kLanes) {
        const Incoming* in = arrivals_.of(chunks_[j]);
        for (uint32_t lanes = arrivals_.lanes(chunks_[j]); lanes != 0; lanes &= lanes - 1, ++in) {
          const auto l = static_cast<size_t>(std::countr_zero(lanes));
          addTo(&octants[octantOf(in->narrow)], w[l], in->narrow);
          addTo(&octants[octantOf(in->broad)], w[l], in->broad);
        }
      }
      for (size_t o = 0; o < kOctants; ++o) {
        const TransferLobe lobe = lobeOf(octants[o], all);
        if (isFinite(lobe.share) && isFinite(lobe.r))
          lobes[o] = pack(lobe);
        else
          ++counts_.nonFinite;
      }
    }
    out_.diffuse.push_back(lobes);
  }

  const GatherInput& input_;
  Arrivals arrivals_;  // at the vertex under way
  const size_t classes_;
  BlockPass& out_;
  BlockCounts& counts_;
  LobeWeights weights_;
  size_t word_ = 0;  // where the next vertex's bits begin
  size_t side_ = 0;  // the next with diffuse light
  std::vector<uint32_t> chunks_;
  std::vector<std::vector<uint32_t>> columns_;  // by class
  std::vector<std::vector<SliceRecord>> records_;
};

}  // namespace

size_t BlockRays::byteCount() const {
  return blocked.size() * sizeof(uint64_t) + hits.size() * sizeof(RayHit) +
         slices.size() * sizeof(SeeingSlice) + diffuseWeight.size() * sizeof(float) +
         (hitStart.size() + sliceStart.size()) * sizeof(uint32_t);
}

size_t BlockPass::byteCount() const {
  size_t bytes = diffuse.size() * sizeof(DiffuseLobes) + reflection.byteCount();
  for (const SliceRows& rows : glossy) bytes += rows.byteCount();
  return bytes;
}

void BlockCounts::add(const BlockCounts& o) {
  rays += o.rays, hits += o.hits, slices += o.slices, unoccluded += o.unoccluded;
  nonFinite += o.nonFinite, traceNs += o.traceNs, gatherNs += o.gatherNs;
}

void directBlock(const GatherInput& input, size_t first, size_t end, BlockRays* rays,
                 BlockPass* pass, BlockCounts* counts) {
  rays->first = first;
  DirectPass direct(input, rays, pass, counts);
  for (size_t v = first; v < end; ++v) direct.add(v);
  counts->rays += direct.rays();
}

void bounceBlock(const GatherInput& input, size_t pass, const BlockRays& rays, BlockPass* out,
                 BlockCounts* counts) {
  BouncePass bounce(input, pass, out, counts);
  for (size_t v = 0; v < rays.count(); ++v) bounce.add(rays, v);
}

}  // namespace lobelia::transfer
