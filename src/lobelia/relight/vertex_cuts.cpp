#include "lobelia/relight/vertex_cuts.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/relight/median_clusters.h"
#include "lobelia/relight/vertex_visibility.h"

namespace lobelia::relight {
namespace {

constexpr uint64_t kProbeStream = 0x70726f62;
// Vertices of a block know what those of it that are done see. Their bits are all that is kept of
// visibility: 4 MB for each thread.
constexpr size_t kBlockVertices = 512;

// The cuts of a block's vertices, in the order in which they were made.
struct Block {
  std::vector<uint32_t> vertices;
  std::vector<CutNode> nodes;
  std::vector<size_t> begin{0};
};

// Neighbours one after the other, so that most vertices have some that are done.
std::vector<uint32_t> breadthFirst(std::span<const uint32_t> vertices,
                                   const VertexNeighbours& neighbours,
                                   std::span<const uint32_t> blockOf, uint32_t block,
                                   std::vector<uint8_t>* reached) {
  std::vector<uint32_t> order;
  for (const uint32_t start : vertices) {
    if ((*reached)[start] != 0) continue;
    (*reached)[start] = 1;
    order.push_back(start);
    for (size_t i = order.size() - 1; i < order.size(); ++i)
      for (const uint32_t other : neighbours.at(order[i])) {
        if (blockOf[other] != block || (*reached)[other] != 0) continue;
        (*reached)[other] = 1;
        order.push_back(other);
      }
  }
  return order;
}

// What adaptive tracing got wrong, where it is asked for.
struct Wrong {
  uint64_t values = 0, rays = 0;
};

class Vertices {
 public:
  Vertices(const Tracer& tracer, const VisibilityData& data, const VertexFaces& faces,
           const VertexNeighbours& neighbours, std::span<const uint32_t> order,
           const PrecomputeSettings& settings, Context& context)
      : tracer_(tracer),
        data_(data),
        faces_(faces),
        neighbours_(neighbours),
        order_(order),
        settings_(settings),
        context_(context),
        begin_(clusterBegins(order.size(), vertexBlockLevels(order.size()))),
        blockOf_(order.size()),
        placeIn_(order.size()),
        reached_(order.size(), 0),
        sampleNeighbours_(data.samples),
        blocks_(begin_.size() - 1),
        reports_(blocks_.size()),
        wrong_(blocks_.size()) {
    for (size_t b = 0; b < blocks_.size(); ++b)
      for (size_t i = begin_[b]; i < begin_[b + 1]; ++i)
        blockOf_[order_[i]] = static_cast<uint32_t>(b);
  }

  CutSet run() {
    std::atomic<size_t> done{0};
    parallelFor(blocks_.size(), 1, [&](size_t b) {
      if (context_.cancelled()) return;
      trace(b);
      context_.progress("visibility",
                        static_cast<double>(++done) / static_cast<double>(blocks_.size()));
    });
    if (context_.cancelled()) throw Cancelled{};
    report();
    return joined();
  }

 private:
  void trace(size_t b) {
    Block& block = blocks_[b];
    block.vertices = breadthFirst(order_.subspan(begin_[b], begin_[b + 1] - begin_[b]), neighbours_,
                                  blockOf_, static_cast<uint32_t>(b), &reached_);
    for (uint32_t i = 0; i < block.vertices.size(); ++i) placeIn_[block.vertices[i]] = i;
    VertexTracer rays(tracer_, data_.samples, &sampleNeighbours_);
    CutSelector selector(settings_.sigma, settings_.mostNodes);
    std::vector<LeafBits> bits(block.vertices.size(), LeafBits(data_.tree.levels));
    std::vector<const LeafBits*> nearby;
    for (size_t i = 0; i < bits.size(); ++i) {
      const uint32_t vertex = block.vertices[i];
      rays.prepare(faces_.at(vertex), &bits[i]);
      nearby.clear();
      for (const uint32_t other : neighbours_.at(vertex))
        if (blockOf_[other] == b && placeIn_[other] < i) nearby.push_back(&bits[placeIn_[other]]);
      if (settings_.adaptive) {
        const uint64_t key = hashCombine(hashCombine(context_.seed, kProbeStream), vertex);
        rays.traceAdaptively(nearby, key, &bits[i]);
      } else {
        rays.traceAll(&bits[i]);
      }
      if (settings_.verifyAdaptive) verify(vertex, bits[i], &wrong_[b]);
      choose(bits[i], &selector, &block, &reports_[b]);
    }
    context_.statistics.addCount("shadow_rays", rays.rays());
  }

  void choose(const LeafBits& bits, CutSelector* selector, Block* block, CutReport* report) const {
    if (settings_.ignoreBelowHorizon) {
      selector->select(bits, &block->nodes, report);
    } else {
      LeafBits all = bits;
      all.judged = bits.matters;
      const uint64_t last = data_.samples.count() % 64;
      std::fill(all.matters.begin(), all.matters.end(),
                last == 0 ? ~uint64_t{0} : (uint64_t{1} << last) - 1);
      selector->select(all, &block->nodes, report);
    }
    block->begin.push_back(block->nodes.size());
  }

  void verify(uint32_t vertex, const LeafBits& bits, Wrong* wrong) const {
    VertexTracer rays(tracer_, data_.samples);
    LeafBits truth(bits.levels);
    rays.prepare(faces_.at(vertex), &truth);
    rays.traceAll(&truth);
    for (size_t w = 0; w < bits.wordCount(); ++w)
      wrong->values += static_cast<uint64_t>(
          std::popcount((bits.visible[w] ^ truth.visible[w]) & bits.matters[w]));
    wrong->rays += rays.rays();
  }

  void report() const {
    CutReport all;
    Wrong wrong;
    for (const CutReport& r : reports_) all.add(r);
    for (const Wrong& w : wrong_) wrong.values += w.values, wrong.rays += w.rays;
    Statistics& s = context_.statistics;
    s.addCount("cut_nodes", all.nodes);
    s.addCount("cuts_capped", all.capped);
    s.addCount("visibility_values", all.samples);
    s.setValue("cut_size", static_cast<double>(all.nodes) /
                               static_cast<double>(std::max<size_t>(order_.size(), 1)));
    const auto rms = [](double squares, double count) {
      return count > 0 ? std::sqrt(squares / count) : 0;
    };
    s.setValue("cut_rms", rms(all.squaredError, static_cast<double>(all.samples)));
    s.setValue("cut_rms_all",
               rms(all.squaredError, static_cast<double>(order_.size()) *
                                         static_cast<double>(data_.samples.count())));
    s.addCount("adaptive_wrong", wrong.values);
    s.addCount("verification_rays", wrong.rays);
  }

  // In the order of vertices.
  CutSet joined() {
    std::vector<uint64_t> begin(order_.size() + 1, 0);
    const auto nodesOf = [&](size_t vertex) {
      const Block& block = blocks_[blockOf_[vertex]];
      const size_t i = placeIn_[vertex];
      return std::span(block.nodes).subspan(block.begin[i], block.begin[i + 1] - block.begin[i]);
    };
    for (size_t v = 0; v < order_.size(); ++v) begin[v + 1] = begin[v] + nodesOf(v).size();
    std::vector<CutNode> nodes(begin.back());
    parallelFor(order_.size(), 1024, [&](size_t v) {
      std::ranges::copy(nodesOf(v), nodes.begin() + static_cast<std::ptrdiff_t>(begin[v]));
    });
    return {std::move(nodes), std::move(begin)};
  }

  const Tracer& tracer_;
  const VisibilityData& data_;
  const VertexFaces& faces_;
  const VertexNeighbours& neighbours_;
  const std::span<const uint32_t> order_;
  const PrecomputeSettings& settings_;
  Context& context_;
  const std::vector<size_t> begin_;
  std::vector<uint32_t> blockOf_, placeIn_;  // by vertex
  std::vector<uint8_t> reached_;
  const SampleNeighbours sampleNeighbours_;
  std::vector<Block> blocks_;
  std::vector<CutReport> reports_;
  std::vector<Wrong> wrong_;
};

}  // namespace

int vertexBlockLevels(size_t vertexCount) {
  return static_cast<int>(std::bit_width((std::max<size_t>(vertexCount, 1) - 1) / kBlockVertices));
}

CutSet vertexCuts(const Tracer& tracer, const VisibilityData& data, const VertexFaces& faces,
                  const VertexNeighbours& neighbours, std::span<const uint32_t> order,
                  const PrecomputeSettings& settings, Context& context) {
  return Vertices(tracer, data, faces, neighbours, order, settings, context).run();
}

}  // namespace lobelia::relight
