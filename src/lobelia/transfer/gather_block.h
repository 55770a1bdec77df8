// Transfer of a block of vertices: the direct pass, which traces its rays, and passes of bounces,
// which gather along them what the pass before has left where they end [P002 section 5].
//
// Deviations from the paper:
//  - Slices share rays (vertex_rays.h) and weigh them by the BRDF itself, cosine included, instead
//    of by samples of its vMF fit; sums are divided by the sum of all weights, so that energy is
//    exact whatever the grid: what arrives along all rays is shared out, none is made. Bounces of
//    broad lobes gather rays in cells (ray_cells.h), over the sum of weights of cells.
//  - [eq. 9]: visible light counts; its V is 1 where something is in the way (methods.md 3.2).
//  - [eqs. 10, 11] gather (alpha, alpha r), whose sums are exact in energy and mean direction.
//  - What diffuse lobes receive is kept once for each side of a vertex, not for each slice
//    (transfer_data.h).
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/transfer/precompute.h"
#include "lobelia/transfer/ray_cells.h"
#include "lobelia/transfer/reflection.h"
#include "lobelia/transfer/slice_lookup.h"
#include "lobelia/transfer/vertex_rays.h"

namespace lobelia::transfer {

// Slices of which less than this share is in the way are taken for whole, and those of which less
// is free for blocked: a thousandth of a surface's own reflection.
inline constexpr float kLeastVisible = 1e-3f;
// Shares of a bounce below it are not kept. It is felt late, where bounces have next to nothing
// left to lose; a tenth of it keeps that, in files half as large again for ten bounces.
inline constexpr float kLeastShare = 1e-3f;

// What all blocks share.
struct GatherInput {
  const Tracer& tracer;
  std::span<const RaySphere> rays;  // of some levels
  std::span<const uint8_t> raysOf;  // by vertex: which of them
  // By vertex: the cells in which bounces gather its rays; null: each ray by itself.
  std::span<const RayCells* const> cellsOf;
  const GeodesicGrid& directions;
  const ReflectionTables& tables;
  const TransferData& data;  // mesh; passes, of which the last is being made
  const SliceLookup& lookup;
  const relight::VertexFaces* faces;     // of the direct pass alone
  std::span<const uint32_t> instanceOf;  // by triangle of the scene
  // By side of a vertex (data.diffuseSides): what its diffuse lobes receive in the pass before, all
  // octants together, for an albedo of 1. Empty: nothing.
  std::span<const LobeMoment> diffuseBefore;
  bool anyDiffuse = true;  // false: nothing has diffuse lobes, and passes are to have none
};

// A slice that sees something: its column, and the sum of its weights over all rays, or over the
// cells of rays where bounces gather in them.
struct SeeingSlice {
  uint32_t column = 0;
  float weight = 0;
};

// Vertices [first, first + count()) and what their rays met, for passes after the first.
struct BlockRays {
  size_t first = 0;
  std::vector<uint64_t> blocked;      // by vertex: a bit for each ray
  std::vector<uint32_t> hitStart{0};  // by vertex, and the end
  std::vector<RayHit> hits;
  std::vector<uint32_t> sliceStart{0};  // by vertex, and the end
  std::vector<SeeingSlice> slices;
  std::vector<float> diffuseWeight;  // by side with diffuse light: of its lobes; 0: none
  size_t count() const { return hitStart.size() - 1; }
  size_t byteCount() const;
};

struct BlockPass {
  std::vector<SliceRows> glossy;  // by class
  std::vector<DiffuseLobes> diffuse;
  SliceRows reflection;  // of the direct pass (TransferData::reflection)
  size_t byteCount() const;
};

struct BlockCounts {
  uint64_t rays = 0, hits = 0, slices = 0, unoccluded = 0, nonFinite = 0;
  int64_t traceNs = 0, gatherNs = 0;
  void add(const BlockCounts& o);
};

// Vertices [first, end). rays, pass: filled.
void directBlock(const GatherInput& input, size_t first, size_t end, BlockRays* rays,
                 BlockPass* pass, BlockCounts* counts);
// Pass `pass` >= 1 from the one before it.
void bounceBlock(const GatherInput& input, size_t pass, const BlockRays& rays, BlockPass* out,
                 BlockCounts* counts);

}  // namespace lobelia::transfer
