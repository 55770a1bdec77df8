#include "lobelia/transfer/precompute.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>

#include "lobelia/base/parallel.h"
#include "lobelia/relight/visibility_data.h"
#include "lobelia/transfer/adaptive_mesh.h"
#include "lobelia/transfer/block_store.h"
#include "lobelia/transfer/buried_vertices.h"
#include "lobelia/transfer/gather_block.h"

namespace lobelia::transfer {
namespace {

constexpr size_t kBlock = 256;  // vertices

// Grids of rays, as fine as a lobe needs: its solid angle, about 4 pi / kappa, has 38 rays or more,
// evenly spread, where the paper has 144 at random. Lobes sharper than kappa 1,078 have fewer.
constexpr int kCoarsestRays = 5, kFinestRays = 6;
int rayLevelFor(float kappa) {
  int level = kCoarsestRays;
  while (level < kFinestRays && 10 * (1 << 2 * level) < static_cast<int>(38 * kappa)) ++level;
  return level;
}

std::vector<RaySphere> raySpheres(int level, const GeodesicGrid& directions) {
  std::vector<RaySphere> spheres;
  if (level > 0) {
    spheres.emplace_back(level, directions);
  } else {
    for (int l = kCoarsestRays; l <= kFinestRays; ++l) spheres.emplace_back(l, directions);
  }
  return spheres;
}

std::vector<uint32_t> instanceOfTriangles(const relight::SampleMesh& mesh) {
  std::vector<uint32_t> out;
  for (uint32_t i = 0; i + 1 < mesh.firstTriangle().size(); ++i)
    out.resize(mesh.firstTriangle()[i + 1], i);
  return out;
}

class Precomputation {
 public:
  Precomputation(const Tracer& tracer, const TransferSettings& settings, Context& context)
      : tracer_(tracer),
        settings_(settings),
        context_(context),
        budget_(budgetOf(settings)),
        tables_(tracer.scene()),
        directions_(settings.directionLevel),
        rays_(raySpheres(settings.rayLevel, directions_)),
        store_(settings, tracer.scene(), context) {}

  TransferData run() {
    makeMesh();
    const relight::VertexFaces faces(tracer_.scene(), data_.mesh.mesh,
                                     relight::leafTriangles(data_.mesh.mesh),
                                     relight::bothSidesOf(tracer_.scene()));
    data_.mesh.buried =
        buriedVertices(tracer_, data_.mesh, faces, relight::bothSidesOf(tracer_.scene()));
    const std::vector<uint32_t> instanceOf = instanceOfTriangles(data_.mesh.mesh);
    data_.directionLevel = settings_.directionLevel;
    data_.classCount = settings_.classCount;
    const SliceLookup lookup(tracer_.scene(), data_, tables_);
    const std::vector<uint8_t> raysOf = raysOfVertices();
    const std::vector<const RayCells*> cellsOf = cellsOfVertices(raysOf);
    GatherInput input{tracer_, rays_,  raysOf, cellsOf,    directions_, tables_,
                      data_,   lookup, faces,  instanceOf, {},          anyDiffuse_};
    blocks_ = (data_.mesh.vertices.size() + kBlock - 1) / kBlock;
    store_.setSize(blocks_, directions_.count());
    direct(input);
    for (size_t j = 1; j <= static_cast<size_t>(settings_.bounces); ++j) {
      const std::vector<LobeMoment> diffuse = diffuseTotals();
      input.diffuseBefore = diffuse;
      bounce(input, j);
    }
    report();
    if (settings_.keep) settings_.keep(data_);
    store_.finish();
    return std::move(data_);
  }

 private:
  void makeMesh() {
    const StageTimer timer(context_, "masks");
    context_.progress("masks", 0);
    if (std::optional<relight::SampleMesh> known = store_.mesh(tracer_.scene())) {
      data_.mesh.mesh = std::move(*known);
      const size_t before = splitMesh(tracer_.scene()).positions().size();
      context_.statistics.addCount("vertices_added", data_.mesh.mesh.positions().size() - before);
    } else {
      data_.mesh.mesh = adaptiveMesh(tracer_, settings_, context_);
      store_.putMesh(data_.mesh.mesh);
    }
    data_.mesh.vertices = transferVertices(tracer_.scene(), data_.mesh.mesh);
    const DiffuseVertices diffuse = findDiffuse(tracer_.scene(), data_.mesh.vertices);
    data_.diffuseSides = DiffuseSides(data_.mesh.vertices.size(), diffuse.backs);
    anyDiffuse_ = diffuse.any;
    context_.statistics.addCount("vertices", data_.mesh.vertices.size());
  }

  std::vector<uint8_t> raysOfVertices() const {
    std::vector<uint8_t> out;
    for (const TransferVertex& v : data_.mesh.vertices) {
      const float kappa = tables_.sharpest(tracer_.scene().instances[v.instance].material);
      out.push_back(rays_.size() == 1 ? uint8_t{0}
                                      : static_cast<uint8_t>(rayLevelFor(kappa) - kCoarsestRays));
    }
    return out;
  }

  // By vertex, as GatherInput has them. Classes need rays one by one, each of which has its own.
  std::vector<const RayCells*> cellsOfVertices(std::span<const uint8_t> raysOf) {
    std::vector<const RayCells*> out(raysOf.size(), nullptr);
    if (settings_.classCount > 1) return out;
    for (const RaySphere& sphere : rays_) cells_.emplace_back(sphere, directions_);
    for (size_t v = 0; v < out.size(); ++v) {
      const float kappa =
          tables_.sharpest(tracer_.scene().instances[data_.mesh.vertices[v].instance].material);
      const RayCells& cells = cells_[raysOf[v]];
      if (cellsSuffice(cells.rayOf.size(), kappa)) out[v] = &cells;
    }
    return out;
  }

  size_t end(size_t block) const {
    return std::min((block + 1) * kBlock, data_.mesh.vertices.size());
  }

  std::optional<BlockPass> storedPass(size_t pass, size_t block) {
    const size_t first = block * kBlock, last = end(block);
    const DiffuseSides& sides = data_.diffuseSides;
    return store_.find(pass, block, last - first,
                       anyDiffuse_ ? sides.front(last) - sides.front(first) : 0);
  }

  // Blocks one after the other, as many at a time as there are threads; what they give is taken in
  // their order. make(block) -> BlockPass.
  template <class Make>
  void forBlocks(const char* stage, const Make& make) {
    data_.passes.emplace_back();
    std::atomic<size_t> done{0};
    const size_t together = std::max<size_t>(8 * static_cast<size_t>(threadCount()), 1);
    for (size_t first = 0; first < blocks_; first += together) {
      std::vector<BlockPass> made(std::min(together, blocks_ - first));
      parallelFor(made.size(), 1, [&](size_t i) {
        if (context_.cancelled()) return;
        made[i] = make(first + i);
        context_.progress(stage, static_cast<double>(++done) / static_cast<double>(blocks_));
      });
      if (context_.cancelled()) throw Cancelled{};
      for (BlockPass& block : made) take(std::move(block));
      requireBudget(stage, first + made.size());
    }
  }

  void take(BlockPass block) {
    // Of the pass under way, which nobody reads before it is whole.
    TransferPass& pass = data_.passes.back();
    if (pass.glossy.empty())
      pass.glossy.assign(block.glossy.size(), SliceRows(directions_.count()));
    for (size_t c = 0; c < block.glossy.size(); ++c) pass.glossy[c].append(block.glossy[c]);
    pass.diffuse.insert(pass.diffuse.end(), block.diffuse.begin(), block.diffuse.end());
    if (block.reflection.rowCount() == 0) return;
    if (data_.reflection.rowCount() == 0) data_.reflection = SliceRows(directions_.count());
    data_.reflection.append(block.reflection);
  }

  void direct(const GatherInput& input) {
    const int64_t start = nanosecondsNow();
    BlockCounts counts;
    std::mutex mutex;
    forBlocks("rays and direct light", [&](size_t b) {
      if (std::optional<BlockPass> known = storedPass(0, b)) return std::move(*known);
      BlockPass pass;
      BlockRays rays;
      BlockCounts mine;
      directBlock(input, b * kBlock, end(b), &rays, &pass, &mine);
      store_.putRays(b, std::move(rays));
      store_.put(0, b, pass);
      const std::lock_guard lock(mutex);
      counts.add(mine);
      return pass;
    });
    add(counts, "direct", start);
  }

  // GatherInput::diffuseBefore of the last pass.
  std::vector<LobeMoment> diffuseTotals() const {
    const std::vector<DiffuseLobes>& lobes = data_.passes.back().diffuse;
    std::vector<LobeMoment> out(lobes.size());
    parallelFor(lobes.size(), 256, [&](size_t v) {
      for (const SliceRecord record : lobes[v]) {
        const TransferLobe lobe = unpack(record);
        out[v].alpha += lobe.share, out[v].first += lobe.r * luminance(lobe.share);
      }
    });
    return out;
  }

  void bounce(const GatherInput& input, size_t j) {
    const int64_t start = nanosecondsNow();
    BlockCounts counts;
    std::mutex mutex;
    forBlocks("bounces", [&](size_t b) {
      if (std::optional<BlockPass> known = storedPass(j, b)) return std::move(*known);
      BlockPass pass;
      BlockCounts mine;
      bounceBlock(input, j, store_.rays(b), &pass, &mine);
      store_.put(j, b, pass);
      const std::lock_guard lock(mutex);
      counts.add(mine);
      return pass;
    });
    add(counts, "bounce", start);
  }

  void add(const BlockCounts& counts, const char* stage, int64_t start) {
    const double seconds = static_cast<double>(nanosecondsNow() - start) * 1e-9;
    const auto spent = static_cast<double>(counts.traceNs + counts.gatherNs);
    const double trace = spent > 0 ? seconds * static_cast<double>(counts.traceNs) / spent : 0;
    Statistics& s = context_.statistics;
    s.addSeconds("trace", trace);
    s.addSeconds(stage, seconds - trace);
    s.addCount("transfer_rays", counts.rays);
    s.addCount("hits", counts.hits);
    s.addCount("slices", counts.slices);
    s.addCount("slices_unoccluded", counts.unoccluded);
    s.addCount("nonfinite", counts.nonFinite);
  }

  void requireBudget(const char* stage, size_t blocksDone) const {
    const uint64_t bytes = data_.byteCount();
    if (bytes <= budget_) return;
    const size_t vertices = data_.mesh.vertices.size();
    const size_t done = std::min(blocksDone * kBlock, vertices);
    const auto kilobytes = [](uint64_t b) { return (b + 1023) / 1024; };
    throw RuntimeError(fmt::format(
        "--memory {}K is too little: {} of {} vertices already have {}K of transfer ({}); give "
        "more, or take fewer --directions or --bounces or a coarser mesh (--max-vertices, "
        "--subdivide)",
        kilobytes(budget_), done, vertices, kilobytes(bytes), stage));
  }

  void report() const {
    context_.statistics.addCount("records", data_.recordCount());
    context_.statistics.addCount("blocks", blocks_ * data_.passes.size());
    context_.statistics.addCount("blocks_resumed", store_.resumed());
  }

  const Tracer& tracer_;
  const TransferSettings& settings_;
  Context& context_;
  const uint64_t budget_;
  const ReflectionTables tables_;
  const GeodesicGrid directions_;
  const std::vector<RaySphere> rays_;
  std::vector<RayCells> cells_;  // of rays_
  BlockStore store_;
  TransferData data_;
  bool anyDiffuse_ = false;
  size_t blocks_ = 0;
};

}  // namespace

TransferData precomputeTransfer(const Tracer& tracer, const TransferSettings& settings,
                                Context& context) {
  return Precomputation(tracer, settings, context).run();
}

}  // namespace lobelia::transfer
