#include "lobelia/relight/tile_cut.h"

#include <algorithm>
#include <cmath>

namespace lobelia::relight {
namespace {

NodeShape shapeOf(const SurfaceLight& light, uint32_t node) {
  NodeShape shape;
  const Vec3f mean = light.normal(node);
  const float agree = length(mean);
  shape.place = light.place(node);
  shape.normal = agree > 1e-6f ? mean * (1 / agree) : Vec3f();
  shape.spread = light.spread[node];
  shape.radius = std::sqrt(2 * shape.spread.trace());
  shape.thickness = NodeShape::kReach * std::sqrt(std::max(shape.spread.along(shape.normal), 0.f));
  shape.tilt = std::sqrt(std::max(1 - agree * agree, 0.f));
  return shape;
}

float errorOf(const SurfaceLight& light, const GroupLanes& groups, uint32_t node) {
  const float power = std::abs(luminance(light.sums.power(node)));
  if (!(power > 0)) return 0;
  return power * largestError(groups, shapeOf(light, node), light.sampleArea * (1 / kPi));
}

}  // namespace

void TileCutSelector::select(const SurfaceLight& light, std::span<const PixelGroup> groups,
                             size_t nodeCount, TileCut* out) {
  const GroupLanes lanes(groups);
  const uint32_t leaves = 1u << light.sums.levels;
  heap_.clear(), nodes_.clear();
  const auto offer = [&](uint32_t node) {
    const float error = node < leaves ? errorOf(light, lanes, node) : 0;
    if (error > 0) {
      heap_.push_back({error, node});
      std::push_heap(heap_.begin(), heap_.end());
    } else {
      nodes_.push_back(node);
    }
  };
  if (nodeCount >= leaves) {
    for (uint32_t i = 0; i < leaves; ++i) nodes_.push_back(leaves + i);
  } else {
    offer(1);
  }
  for (size_t count = 1; !heap_.empty() && count < nodeCount; ++count) {
    std::pop_heap(heap_.begin(), heap_.end());
    const uint32_t node = heap_.back().node;
    heap_.pop_back();
    offer(2 * node), offer(2 * node + 1);
  }
  for (const Candidate& candidate : heap_) nodes_.push_back(candidate.node);
  makeLightCut(light.sums, &nodes_, &out->cut);
  const LightCut& cut = out->cut;
  for (AlignedFloats* values : {&out->nx, &out->ny, &out->nz, &out->variance, &out->extent2})
    values->assign(cut.padded(), 0.f);
  out->chunks.clear();
  for (size_t i = 0; i < cut.count; ++i) {
    const auto chunk = static_cast<uint32_t>(i / kChunk);
    if ((out->chunks.empty() || out->chunks.back() != chunk) &&
        errorOf(light, lanes, static_cast<uint32_t>(cut.heap[i])) > 0)
      out->chunks.push_back(chunk);
    const Vec3f n = light.normal(cut.heap[i]);
    out->nx[i] = n.x, out->ny[i] = n.y, out->nz[i] = n.z;
    // Of leaves exactly 0.
    out->variance[i] = cut.nodes[i].level > 0 ? std::max(1 - lengthSquared(n), 0.f) / 4 : 0.f;
    out->extent2[i] = light.spread[cut.heap[i]].trace();
  }
}

}  // namespace lobelia::relight
