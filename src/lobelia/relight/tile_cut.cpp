#include "lobelia/relight/tile_cut.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lobelia::relight {
namespace {

Vec3f absolute(Vec3f v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

// Of a node of light as one group of pixels sees it.
float groupError(const PixelGroup& group, Vec3f place, Vec3f normal, float size, float area) {
  const Vec3f centre = group.box.centre(), half = group.box.extent() * 0.5f, to = place - centre;
  const Vec3f beyond = max(absolute(to) - half, Vec3f(0.f));
  const float d2 = lengthSquared(beyond) + area, d = std::sqrt(d2);
  const float radius = std::sqrt(2.f) * size;  // of an even disc with this deviation
  if (group.flat && dot(group.normal, to) + dot(absolute(group.normal), half) + radius < 0)
    return 0;
  const float agree = length(normal), spread = 1 - agree;
  const float facing = -dot(normal, to) + dot(absolute(normal), half);
  const float cosine = std::min(facing / d + (spread + radius / d), 1.f);
  if (!(cosine > 0)) return 0;
  const float angle = std::min(radius / d, 1.f);
  float error = cosine * (angle + spread);
  if (group.peak > 0) {
    const float off = length(to * (1 / std::max(length(to), 1e-20f)) - group.axis);
    if (off < group.chord + angle + length(half) / d)
      error += group.peak * cosine * std::min(angle / group.width, 1.f);
  }
  return error / d2;
}

}  // namespace

float TileCutSelector::errorOf(const SurfaceLight& light, uint32_t node) const {
  const float power = std::abs(luminance(light.sums.power(node)));
  if (!(power > 0)) return 0;
  float most = 0;
  for (const PixelGroup& group : groups_)
    most = std::max(most, groupError(group, light.place(node), light.normal(node), light.size[node],
                                     light.sampleArea * (1 / kPi)));
  return power * most;
}

void TileCutSelector::select(const SurfaceLight& light, std::span<const PixelGroup> groups,
                             size_t nodeCount, TileCut* out) {
  groups_ = groups;
  const uint32_t leaves = 1u << light.sums.levels;
  heap_.clear(), nodes_.clear();
  const auto offer = [&](uint32_t node) {
    const float error = node < leaves ? errorOf(light, node) : 0;
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
  for (AlignedFloats* values : {&out->nx, &out->ny, &out->nz}) values->assign(cut.padded(), 0.f);
  for (size_t i = 0; i < cut.count; ++i) {
    const Vec3f n = light.normal(cut.heap[i]);
    out->nx[i] = n.x, out->ny[i] = n.y, out->nz[i] = n.z;
  }
}

}  // namespace lobelia::relight
