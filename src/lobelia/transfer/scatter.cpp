// Samples of a slice follow its BRDF, and paths go on by the BRDFs of the surfaces that they meet.
// Those that leave the scene after the same number of reflections make one lobe for each class of
// paths (transfer_data.h).
//
// Deviations from what [P002 section 7.6] says of its implementation, all in the baseline's favour:
//  - Samples are of a low-discrepancy sequence and follow the BRDF itself, not its vMF fit.
//  - Shares are relative to the sum of the samples' own weights: where nothing is in the way they
//    are 1 without noise.
//  - Diffuse lobes are sampled for each side of a vertex, not for each slice.
//  - What few samples add to the length of their mean is taken off (sample_lobe.h).
#include "lobelia/transfer/scatter.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "lobelia/relight/visibility_data.h"
#include "lobelia/transfer/block_loop.h"
#include "lobelia/transfer/buried_vertices.h"
#include "lobelia/transfer/gather_block.h"
#include "lobelia/transfer/sample_lobe.h"
#include "lobelia/transfer/scatter_paths.h"

namespace lobelia::transfer {
namespace {

constexpr size_t kBlock = 64;  // vertices
constexpr int kMostRays = 65536;
constexpr float kLambertResultant = 2.f / 3;

struct ScatterInput {
  const Tracer& tracer;
  const TransferMesh& mesh;
  const relight::VertexFaces& faces;
  const ReflectionTables& tables;
  const GeodesicGrid& directions;
  const DiffuseSides& sides;
  bool anyDiffuse;
  size_t passes, classCount;
  int rays;  // of a slice
  uint64_t seed;
  const SliceMask* only;  // null: all slices
};

// What the paths of a slice bring, by pass and column: a class, or an octant of diffuse light.
struct SliceFits {
  SliceFits(size_t passes, size_t columnCount) : columns(columnCount), fits(passes * columnCount) {}
  void clear() {
    std::fill(fits.begin(), fits.end(), SampleLobe{});
    total = 0, obstructed = false;
  }
  SampleLobe& at(size_t pass, size_t column) { return fits[pass * columns + column]; }
  size_t columns;
  std::vector<SampleLobe> fits;
  float total = 0;          // weights of all samples
  bool obstructed = false;  // does any of them meet a surface?
};

struct Row {
  std::vector<uint32_t> columns;
  std::vector<SliceRecord> records;
  void add(uint32_t column, SliceRecord record) {
    columns.push_back(column), records.push_back(record);
  }
  void clear() { columns.clear(), records.clear(); }
};

class BlockScatter {
 public:
  BlockScatter(const ScatterInput& input, std::vector<BlockPass>* out, BlockCounts* counts)
      : input_(input),
        out_(*out),
        counts_(*counts),
        paths_(input.tracer, input.passes - 1, static_cast<int>(input.classCount)),
        glossy_(input.passes, input.classCount + 1),
        diffuse_(input.passes, kOctants),
        rows_(input.passes * (input.classCount + 1)) {
    const SliceRows none(input.directions.count());
    out_.resize(input.passes);
    for (size_t j = 0; j < input.passes; ++j) out_[j].glossy.assign(classes(j), none);
    out_[0].reflection = none;
  }

  void add(size_t vertex) {
    at_ = surfacePoint(input_.tracer.scene(), input_.mesh.vertices[vertex].hit());
    n_ = input_.mesh.vertices[vertex].n;
    faces_ = input_.faces.at(vertex);
    for (Row& row : rows_) row.clear();
    own_.clear();
    const uint64_t stream = vertex * (input_.directions.count() + 1);
    for (uint32_t k = 0; k < input_.directions.count(); ++k)
      if (isWanted(vertex, k)) slice(k, stream + k);
    for (size_t j = 0; j < input_.passes; ++j)
      for (size_t c = 0; c < classes(j); ++c)
        out_[j].glossy[c].addRow(row(j, c).columns, row(j, c).records);
    out_[0].reflection.addRow(own_.columns, own_.records);
    if (!input_.anyDiffuse) return;
    diffuse(n_, stream + input_.directions.count());
    // After the streams of all vertices.
    if (input_.sides.hasBack(vertex))
      diffuse(-n_, input_.mesh.vertices.size() * (input_.directions.count() + 1) + vertex);
  }

  uint64_t rays() const { return paths_.segments(); }

 private:
  size_t classes(size_t pass) const { return pass == 0 ? 1 : input_.classCount + 1; }
  bool isWanted(size_t vertex, uint32_t k) const {
    return !input_.only || (*input_.only)[vertex * input_.directions.count() + k];
  }
  Row& row(size_t pass, size_t c) { return rows_[pass * (input_.classCount + 1) + c]; }
  Bsdf bsdf(Vec3f wo) const { return makeBsdf(input_.tracer.scene(), at_, wo, 0); }

  // columnOf: of a PathEnd.
  template <class ColumnOf>
  void scatter(const Bsdf& part, Vec3f wo, uint64_t stream, int count, const ColumnOf& columnOf,
               SliceFits* fits) {
    fits->clear();
    for (int m = 0; m < count; ++m) {
      Sampler random(input_.seed, stream, static_cast<uint32_t>(m));
      const float lobe = random.next1D();
      const auto drawn = sample(part, wo, lobe, random.next2D());
      if (!drawn) continue;
      const float weight = luminance(drawn->weight);
      if (!std::isfinite(weight)) ++counts_.nonFinite;
      if (!std::isfinite(weight) || weight <= 0) continue;
      fits->total += weight;
      const Vec3f* const from = rayStart(faces_, drawn->wi);
      const auto end = from ? paths_.follow(*from, drawn->wi, random) : std::nullopt;
      if (!end || end->reflections > 0) fits->obstructed = true;
      if (!end) continue;
      if (isFinite(end->weight))
        fits->at(end->reflections, columnOf(*end)).add(end->weight * weight, end->d);
      else
        ++counts_.nonFinite;
    }
  }

  void slice(uint32_t k, uint64_t stream) {
    const Vec3f wo = input_.directions.directions()[k];
    const bool tabulated = input_.tables.has(at_.material);
    const Bsdf all = bsdf(wo);
    Reflection own;
    if (!tabulated)
      own = reflectionOf(all, wo);
    else if (!input_.tables.summary(at_.material, n_, wo, &own))
      return;
    if (luminance(own.glossy) <= 0) return;
    ++counts_.slices;
    if (!tabulated) own_.add(k, pack({own.glossy, own.r}));
    scatter(
        glossyPart(all), wo, stream, input_.rays, [](const PathEnd& e) { return e.lobeClass; },
        &glossy_);
    if (!glossy_.obstructed) {
      ++counts_.unoccluded;
      return;
    }
    keep(k, length(own.r));
  }

  // single: SampleLobe's.
  void keep(uint32_t k, float single) {
    const TransferLobe direct = glossy_.at(0, 0).lobe(glossy_.total, single);
    if (luminance(direct.share) < 1 - kLeastVisible)
      row(0, 0).add(k, luminance(direct.share) < kLeastVisible ? SliceRecord{} : pack(direct));
    for (size_t j = 1; j < input_.passes; ++j)
      for (size_t c = 0; c < classes(j); ++c) {
        const TransferLobe lobe = glossy_.at(j, c).lobe(glossy_.total, single);
        if (maxComponent(lobe.share) >= kLeastShare) row(j, c).add(k, pack(lobe));
      }
  }

  // Towards wo, the normal of one side.
  void diffuse(Vec3f wo, uint64_t stream) {
    const Bsdf part = diffusePart(bsdf(wo));
    diffuse_.clear();
    if (part.lobeCount > 0)
      scatter(
          part, wo, stream, input_.rays * static_cast<int>(kOctants),
          [](const PathEnd& e) { return size_t{octantOf(e.d)}; }, &diffuse_);
    for (size_t j = 0; j < input_.passes; ++j) {
      DiffuseLobes lobes{};
      for (size_t o = 0; o < kOctants && diffuse_.total > 0; ++o)
        lobes[o] = pack(diffuse_.at(j, o).lobe(diffuse_.total, kLambertResultant));
      out_[j].diffuse.push_back(lobes);
    }
  }

  const ScatterInput& input_;
  std::vector<BlockPass>& out_;
  BlockCounts& counts_;
  ScatterPaths paths_;
  SliceFits glossy_, diffuse_;
  SurfacePoint at_;
  Vec3f n_{};
  std::span<const relight::FacePlace> faces_;
  std::vector<Row> rows_;  // by pass and class
  Row own_;
};

struct MadeBlock {
  std::vector<BlockPass> passes;
  BlockCounts counts;
};

void append(MadeBlock block, TransferData* data) {
  for (size_t j = 0; j < block.passes.size(); ++j) {
    TransferPass& pass = data->passes[j];
    const BlockPass& made = block.passes[j];
    for (size_t c = 0; c < made.glossy.size(); ++c) pass.glossy[c].append(made.glossy[c]);
    pass.diffuse.insert(pass.diffuse.end(), made.diffuse.begin(), made.diffuse.end());
  }
  data->reflection.append(block.passes[0].reflection);
}

BlockCounts scatterBlocks(const ScatterInput& input, Context& context, TransferData* data) {
  BlockCounts counts;
  const size_t vertices = input.mesh.vertices.size();
  BlockLoop<MadeBlock> loop("scatter", (vertices + kBlock - 1) / kBlock, 0, context);
  loop.run(
      [&](size_t b) {
        MadeBlock made;
        BlockScatter block(input, &made.passes, &made.counts);
        for (size_t v = b * kBlock; v < std::min((b + 1) * kBlock, vertices); ++v) block.add(v);
        made.counts.rays = block.rays();
        return made;
      },
      [&](MadeBlock block) {
        counts.add(block.counts);
        append(std::move(block), data);
      },
      [](auto...) {});
  return counts;
}

}  // namespace

TransferData scatterTransfer(const Tracer& tracer, TransferMesh mesh,
                             const TransferSettings& settings, int raysPerSlice, Context& context,
                             const SliceMask* only) {
  if (raysPerSlice < 1 || raysPerSlice > kMostRays)
    throw UsageError(
        fmt::format("{} rays per slice: must be from 1 to {}", raysPerSlice, kMostRays));
  assert(!only ||
         only->size() == mesh.vertices.size() * GeodesicGrid(settings.directionLevel).count());
  const StageTimer timer(context, "scatter");
  const Scene& scene = tracer.scene();
  TransferData data;
  data.directionLevel = settings.directionLevel;
  data.classCount = settings.classCount;
  data.mesh = std::move(mesh);
  data.passes.resize(static_cast<size_t>(settings.bounces) + 1);
  const relight::VertexFaces faces(scene, data.mesh.mesh, relight::leafTriangles(data.mesh.mesh),
                                   relight::bothSidesOf(scene));
  if (data.mesh.buried.empty())
    data.mesh.buried =
        buriedVertices(tracer, data.mesh, faces, relight::bothSidesOf(scene), context);
  const DiffuseVertices diffuse = findDiffuse(scene, data.mesh.vertices);
  data.diffuseSides = DiffuseSides(data.mesh.vertices.size(), diffuse.backs);
  const ReflectionTables tables(scene);
  const GeodesicGrid directions(settings.directionLevel);
  // Of a scene without surfaces, too.
  for (size_t j = 0; j < data.passes.size(); ++j)
    data.passes[j].glossy.assign(j == 0 ? 1 : static_cast<size_t>(settings.classCount) + 1,
                                 SliceRows(directions.count()));
  data.reflection = SliceRows(directions.count());
  const ScatterInput input{
      tracer,       data.mesh,          faces,
      tables,       directions,         data.diffuseSides,
      diffuse.any,  data.passes.size(), static_cast<size_t>(settings.classCount),
      raysPerSlice, context.seed,       only};
  const BlockCounts counts = scatterBlocks(input, context, &data);
  Statistics& s = context.statistics;
  s.addCount("transfer_rays", counts.rays);
  s.addCount("slices", counts.slices);
  s.addCount("slices_unoccluded", counts.unoccluded);
  s.addCount("nonfinite", counts.nonFinite);
  s.addCount("records", data.recordCount());
  return data;
}

}  // namespace lobelia::transfer
