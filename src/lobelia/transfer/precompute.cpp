#include "lobelia/transfer/precompute.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <optional>

#include "lobelia/base/parallel.h"
#include "lobelia/relight/visibility_data.h"
#include "lobelia/transfer/adaptive_mesh.h"
#include "lobelia/transfer/block_loop.h"
#include "lobelia/transfer/block_store.h"
#include "lobelia/transfer/buried_vertices.h"
#include "lobelia/transfer/gather_block.h"
#include "lobelia/transfer/memory_budget.h"
#include "lobelia/transfer/ray_plan.h"

namespace lobelia::transfer {
namespace {

constexpr size_t kPilots = 16;  // blocks of a pass that are made before all others
constexpr size_t kBlock = 256;  // vertices

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
        budget_(settings.memoryBytes),
        tables_(tracer.scene()),
        directions_(settings.directionLevel),
        store_(settings, tracer.scene(), context) {}

  TransferData run() {
    makeMesh();
    instanceOf_ = instanceOfTriangles(data_.mesh.mesh);
    // Classes need rays one by one, each of which has its own.
    const RayPlan rays(settings_.rayLevel, settings_.classCount == 1, directions_, tracer_.scene(),
                       tables_, data_.mesh.vertices);
    data_.directionLevel = settings_.directionLevel;
    data_.classCount = settings_.classCount;
    const SliceLookup lookup(tracer_.scene(), data_, tables_);
    GatherInput input{tracer_, rays.spheres(), rays.sphereOf(), rays.cellsOf(), directions_,
                      tables_, data_,          lookup,          nullptr,        instanceOf_,
                      {},      anyDiffuse_};
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

  size_t end(size_t block) const {
    return std::min((block + 1) * kBlock, data_.mesh.vertices.size());
  }

  std::optional<BlockPass> storedPass(size_t pass, size_t block) {
    const size_t first = block * kBlock, last = end(block);
    const DiffuseSides& sides = data_.diffuseSides;
    return store_.find(pass, block, last - first,
                       anyDiffuse_ ? sides.front(last) - sides.front(first) : 0);
  }

  // make(block) -> BlockPass. The pilots tell whether there is memory for the rest.
  template <class Make>
  void forBlocks(const char* stage, const Make& make) {
    addPass();
    const MemoryUse before = memoryUse();
    BlockLoop<BlockPass> loop(stage, blocks_, blocks_ > 2 * kPilots ? kPilots : 0, context_);
    loop.run(
        make, [&](BlockPass block) { take(std::move(block)); },
        [&](std::span<const BlockPass> waiting, size_t done) {
          for (const BlockPass& block : waiting) noteSize(block);
          requireMemory(stage, before, waiting, done);
        });
  }

  void noteSize(const BlockPass& block) {
    mostBlockBytes_ = std::max<uint64_t>(mostBlockBytes_, block.byteCount());
  }

  // Of a scene without surfaces, too: its rows are none, but they are there.
  void addPass() {
    const bool first = data_.passes.empty();
    TransferPass& pass = data_.passes.emplace_back();
    pass.glossy.assign(first ? 1 : static_cast<size_t>(settings_.classCount) + 1,
                       SliceRows(directions_.count()));
    for (SliceRows& rows : pass.glossy) rows.reserveRows(data_.mesh.vertices.size());
    if (!first) return;
    data_.reflection = SliceRows(directions_.count());
    data_.reflection.reserveRows(data_.mesh.vertices.size());
  }

  void take(BlockPass block) {
    noteSize(block);
    // Of the pass under way, which nobody reads before it is whole.
    TransferPass& pass = data_.passes.back();
    const size_t vertices = data_.mesh.vertices.size();
    if (pass.diffuse.empty() && !block.diffuse.empty()) pass.diffuse.reserve(vertices);
    for (size_t c = 0; c < block.glossy.size(); ++c) pass.glossy[c].append(block.glossy[c]);
    pass.diffuse.insert(pass.diffuse.end(), block.diffuse.begin(), block.diffuse.end());
    if (data_.passes.size() == 1) data_.reflection.append(block.reflection);
  }

  // Of what does not grow. faces: is what is known of them there?
  uint64_t meshBytes(bool faces) const {
    const relight::SampleMesh& mesh = data_.mesh.mesh;
    const size_t vertices = data_.mesh.vertices.size(), triangles = mesh.triangles().size();
    return vertices * (sizeof(Vec3f) + sizeof(TransferVertex) + sizeof(uint8_t)) +
           triangles * (sizeof(relight::SampleTriangle) + sizeof(uint32_t)) +
           (faces ? triangles * 3 * sizeof(relight::FacePlace)
                  : data_.diffuseSides.front(vertices) * sizeof(LobeMoment));
  }

  MemoryUse memoryUse() const {
    return {meshBytes(data_.passes.size() == 1), data_.byteCount(), store_.rayBytes(),
            // Rays of a block are there as they are, packed, and on their way there.
            3 * static_cast<uint64_t>(threadCount()) * store_.mostRayBytes() +
                blocksTogether() * mostBlockBytes_};
  }

  // Rows without anything in them and diffuse lobes, of passes to come.
  uint64_t leastOfLaterPasses() const {
    const size_t words = (directions_.count() + 63) / 64;
    const size_t row = words * (sizeof(uint64_t) + sizeof(uint16_t)) + sizeof(uint64_t);
    const size_t vertices = data_.mesh.vertices.size();
    const size_t rows = row * static_cast<size_t>(settings_.classCount + 1) * vertices;
    const size_t diffuse =
        anyDiffuse_ ? sizeof(DiffuseLobes) * data_.diffuseSides.front(vertices) : 0;
    const size_t passes = static_cast<size_t>(settings_.bounces) + 1 - data_.passes.size();
    return passes * (rows + diffuse);
  }

  // before: when the stage began. waiting: blocks that are made, not taken. done: blocks that the
  // stage has made.
  void requireMemory(const char* stage, const MemoryUse& before, std::span<const BlockPass> waiting,
                     size_t done) const {
    uint64_t bytes = 0;
    for (const BlockPass& block : waiting) bytes += block.byteCount();
    MemoryUse now = memoryUse();
    now.transfer += bytes;
    const size_t vertices = data_.mesh.vertices.size();
    budget_.require(now, {0, now.transfer - before.transfer, now.rays - before.rays, 0},
                    {stage, std::min(done * kBlock, vertices), vertices, leastOfLaterPasses()});
  }

  void direct(GatherInput input) {
    const int64_t start = nanosecondsNow();
    // Gone at the end of the pass: as large as the mesh several times over.
    const relight::VertexFaces faces(tracer_.scene(), data_.mesh.mesh,
                                     relight::leafTriangles(data_.mesh.mesh),
                                     relight::bothSidesOf(tracer_.scene()));
    input.faces = &faces;
    data_.mesh.buried =
        buriedVertices(tracer_, data_.mesh, faces, relight::bothSidesOf(tracer_.scene()), context_);
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
      BlockRays read;
      bounceBlock(input, j, store_.rays(b, &read), &pass, &mine);
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

  void report() const {
    context_.statistics.addCount("records", data_.recordCount());
    context_.statistics.addCount("blocks", blocks_ * data_.passes.size());
    context_.statistics.addCount("blocks_resumed", store_.resumed());
  }

  const Tracer& tracer_;
  const TransferSettings& settings_;
  Context& context_;
  const MemoryBudget budget_;
  const ReflectionTables tables_;
  const GeodesicGrid directions_;
  BlockStore store_;
  TransferData data_;
  std::vector<uint32_t> instanceOf_;  // by triangle of the scene
  bool anyDiffuse_ = false;
  size_t blocks_ = 0;
  uint64_t mostBlockBytes_ = 0;  // of a block of a pass, before it is taken
};

}  // namespace

TransferData precomputeTransfer(const Tracer& tracer, const TransferSettings& settings,
                                Context& context) {
  return Precomputation(tracer, settings, context).run();
}

}  // namespace lobelia::transfer
