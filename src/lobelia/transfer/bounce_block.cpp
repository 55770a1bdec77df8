// A pass of bounces of a block of vertices (gather_block.h).
#include <bit>

#include "lobelia/transfer/arrivals.h"
#include "lobelia/transfer/gather_vertex.h"

namespace lobelia::transfer {
namespace {

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
  // add(weight, what arrives) for the directions of a lobe from which something does.
  template <class Add>
  void forArriving(const Bsdf& part, Vec3f wo, const Add& add) {
    chunks_.clear();
    for (const uint32_t c : weights_.find(part, wo))
      if (arrivals_.lanes(c) != 0) chunks_.push_back(c);
    const float* w = weights_.evaluate(part, wo, chunks_);
    for (size_t j = 0; j < chunks_.size(); ++j, w += kLanes) {
      const Incoming* in = arrivals_.of(chunks_[j]);
      for (uint32_t lanes = arrivals_.lanes(chunks_[j]); lanes != 0; lanes &= lanes - 1, ++in)
        add(w[std::countr_zero(lanes)], *in);
    }
  }

  void slice(const Vertex& vertex, const SeeingSlice& slice) {
    const Vec3f wo = input_.directions.directions()[slice.column];
    if (!(slice.weight > 0)) return;
    std::array<Numbers, kMostClasses + 1> totals{};
    forArriving(glossyPart(vertex.bsdf(wo)), wo, [&](float weight, const Incoming& in) {
      addTo(&totals[static_cast<size_t>(in.narrowClass)], weight, in.narrow);
      addTo(&totals[classes_], weight, in.broad);
    });
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
      forArriving(diffusePart(vertex.bsdf(wo)), wo, [&](float weight, const Incoming& in) {
        addTo(&octants[octantOf(in.narrow)], weight, in.narrow);
        addTo(&octants[octantOf(in.broad)], weight, in.broad);
      });
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

void bounceBlock(const GatherInput& input, size_t pass, const BlockRays& rays, BlockPass* out,
                 BlockCounts* counts) {
  BouncePass bounce(input, pass, out, counts);
  for (size_t v = 0; v < rays.count(); ++v) bounce.add(rays, v);
}

}  // namespace lobelia::transfer
