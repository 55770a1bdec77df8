// Which of the directions of a fine grid are open at a vertex [P002 section 6.1].
//
// The paper traces all of them. Masks are large areas of one kind, so here the directions of a
// coarse grid are traced, and of each finer grid's those around which the coarser ones differ. What
// is smaller than the coarse grid's spacing (2 degrees) and not next to an edge may be missed:
// tests and figures stand in tests/transfer/visibility_mask_test.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include "lobelia/relight/vertex_visibility.h"
#include "lobelia/transfer/geodesic_grid.h"

namespace lobelia::transfer {

// The grid's directions and how each follows from coarser ones; shared by all threads.
class MaskDirections {
 public:
  // Of the grid of a level from 0 to kMostGridLevel.
  explicit MaskDirections(int level);
  const GeodesicGrid& grid() const { return grid_; }
  size_t count() const { return grid_.count(); }

 private:
  friend class MaskTracer;
  // A direction that a level adds: between two of the level before it, and beside two more.
  struct Middle {
    uint32_t at, a, b, c, d;
  };
  GeodesicGrid grid_;
  relight::LightSamples samples_;
  std::vector<uint32_t> coarse_;              // ascending
  std::vector<std::vector<Middle>> middles_;  // by level after the coarse one, ascending
};

// For one thread; keeps its memory from vertex to vertex.
class MaskTracer {
 public:
  // Keeps references.
  MaskTracer(const Tracer& tracer, const MaskDirections& directions);
  // visible: directions in which light comes to the vertex; matters: those in front of one of its
  // faces (of surfaces that scatter light from behind: all).
  const relight::LeafBits& trace(std::span<const relight::FacePlace> faces);
  const relight::LeafBits& traceAll(std::span<const relight::FacePlace> faces);
  uint64_t rays() const { return rays_.rays(); }  // since it was made

 private:
  const MaskDirections& directions_;
  relight::VertexTracer rays_;
  relight::LeafBits bits_;
  std::vector<uint32_t> unknown_;
};

// A mask as the lengths of its runs: some kilobytes instead of 41.
class PackedMask {
 public:
  PackedMask() = default;
  explicit PackedMask(const relight::LeafBits& bits);
  bool empty() const { return visible_.empty(); }
  size_t byteCount() const { return 2 * (visible_.capacity() + matters_.capacity()); }
  void unpack(relight::LeafBits* bits) const;  // of the size that was packed

 private:
  std::vector<uint16_t> visible_, matters_;
};

}  // namespace lobelia::transfer
