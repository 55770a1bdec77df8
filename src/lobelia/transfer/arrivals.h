// What arrives at a vertex over other surfaces, of the pass before: along each of its rays that is
// blocked, or gathered in cells of them (ray_cells.h).
#pragma once

#include <array>

#include "lobelia/transfer/gather_block.h"

namespace lobelia::transfer {

// A moment as numbers of which compilers make registers: alpha, first, and two of 0.
using Numbers = std::array<float, 8>;
inline Numbers numbersOf(const LobeMoment& m) {
  return {m.alpha.x, m.alpha.y, m.alpha.z, m.first.x, m.first.y, m.first.z, 0, 0};
}
inline void addTo(Numbers* sum, float weight, const Numbers& n) {
  for (size_t i = 0; i < n.size(); ++i) (*sum)[i] += weight * n[i];
}

// Of paths with glossy reflections alone, and of others.
struct alignas(32) Incoming {
  Numbers narrow{}, broad{};
  int narrowClass = 0;
};

// The rays of a vertex.
struct RaysOfVertex {
  size_t vertex = 0;
  std::span<const uint64_t> blocked;  // a bit for each
  std::span<const RayHit> hits;       // of those that are blocked
};

// For one thread.
class Arrivals {
 public:
  // pass: the one that is made, 1 or more. Keeps a reference.
  Arrivals(const GatherInput& input, size_t pass);

  void gather(const RaysOfVertex& rays);
  bool any() const { return any_; }  // does any light arrive?

  // Of the vertex gathered last. Its directions; the lanes of each of their chunks that have
  // something, a bit for each; and these lanes' own, one after the other, times the solid angle of
  // their directions.
  const DirectionChunks& directions() const { return *directions_; }
  uint32_t lanes(size_t chunk) const { return lanes_[chunk]; }
  const Incoming* of(size_t chunk) const { return &incoming_[first_[chunk]]; }

 private:
  void gatherRays();
  void gatherCells(const RayCells& cells);
  Incoming alongRay(size_t ray);
  const RayHit& hitOf(size_t ray) const;
  Vec3f positionOf(const RayHit& hit) const;
  bool isBetween(size_t a, size_t b, const RayHit& hit) const;
  bool isBlocked(size_t ray) const { return (rays_.blocked[ray / 64] >> ray % 64 & 1) != 0; }
  LobeMoment diffuseOf(const relight::SurroundingVertices& around, Side side, Rgb albedo) const;
  Reflection ownOf(MaterialHandle material, const relight::SurroundingVertices& around,
                   const Hit& hit, Vec3f wo) const;

  const GatherInput& input_;
  const Scene& scene_;
  const size_t before_;  // pass whose light is reflected
  RaysOfVertex rays_;
  const RaySphere* sphere_ = nullptr;
  const DirectionChunks* directions_ = nullptr;
  bool any_ = false;
  std::vector<uint32_t> hitsBefore_;     // by word of rays_.blocked
  std::vector<uint32_t> lanes_, first_;  // by chunk
  std::vector<Incoming> incoming_;
  // Of cells: what arrives along the ray in the middle of each; its instance and 1, or 0 where it
  // is not blocked; sums; whether there is any.
  std::vector<Incoming> middle_, sums_;
  std::vector<uint32_t> instance_;
  std::vector<Vec3f> position_;  // where these rays end
  std::vector<uint8_t> has_;
};

}  // namespace lobelia::transfer
