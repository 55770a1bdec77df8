// The direct pass of a block of vertices (gather_block.h).
#include <algorithm>
#include <cmath>

#include "lobelia/transfer/gather_vertex.h"

namespace lobelia::transfer {
namespace {

constexpr uint32_t kAllLanes = (1u << kLanes) - 1;

uint32_t lanesOf(std::span<const uint64_t> bits, size_t chunk) {
  constexpr size_t kPerWord = 64 / kLanes;
  const size_t word = chunk / kPerWord;
  return word < bits.size()
             ? static_cast<uint32_t>(bits[word] >> (chunk % kPerWord * kLanes)) & kAllLanes
             : 0;
}

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
    if (all <= 0 || seen >= (1 - kLeastVisible) * all) {
      ++counts_.unoccluded;
      return;
    }
    const float share = seen / all;
    out_.slices.push_back({k, sums.total(sums.cells)});
    columns_.push_back(k);
    records_.push_back(share < kLeastVisible ? SliceRecord{} : pack({Rgb(share), sum / seen}));
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

}  // namespace

void directBlock(const GatherInput& input, size_t first, size_t end, BlockRays* rays,
                 BlockPass* pass, BlockCounts* counts) {
  rays->first = first;
  DirectPass direct(input, rays, pass, counts);
  for (size_t v = first; v < end; ++v) direct.add(v);
  counts->rays += direct.rays();
}

}  // namespace lobelia::transfer
