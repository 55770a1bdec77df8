// What the rays from vertices meet: one for each direction of a grid, in packets along its curve.
//
// The paper samples the lobe of every slice by rays of its own (144). Here all slices of a vertex
// share the rays of one grid: what arrives along a ray does not depend on where the eye is, so it
// is traced and gathered once and then weighted by the BRDF of each slice. That takes a fraction of
// the rays, leaves no noise, and neighbouring rays are coherent.
#pragma once

#include <span>

#include "lobelia/relight/vertex_faces.h"
#include "lobelia/trace/tracer.h"
#include "lobelia/transfer/geodesic_grid.h"

namespace lobelia::transfer {

// A place of a surface. triangle: of the scene's, instance after instance, as
// relight::SampleMesh::firstTriangle() numbers them; b1, b2: barycentrics in parts of 65,535.
struct RayHit {
  uint32_t triangle = 0;
  uint16_t b1 = 0, b2 = 0;
  // instance, triangleOfIt: of the triangle.
  Hit at(uint32_t instance, uint32_t triangleOfIt) const {
    constexpr float kParts = 65535;
    return {0, static_cast<float>(b1) / kParts, static_cast<float>(b2) / kParts, instance,
            triangleOfIt};
  }
};
static_assert(sizeof(RayHit) == 8);

// Of one vertex. A ray that leaves no face (it starts below the surface) is neither free nor
// blocked.
struct VertexRays {
  std::vector<uint64_t> free, blocked;  // a bit for each direction
  std::vector<RayHit> hits;             // of the blocked ones, in their order
};

// Where a ray in direction d starts: at the face that looks there most (bothSides faces look both
// ways). Null: it leaves none.
const Vec3f* rayStart(std::span<const relight::FacePlace> faces, Vec3f d);

class RayTracer {
 public:
  // Keeps references. For one thread.
  RayTracer(const Tracer& tracer, const GeodesicGrid& grid,
            std::span<const uint32_t> firstTriangle);
  // Each ray from its rayStart().
  void trace(std::span<const relight::FacePlace> faces, VertexRays* out);
  uint64_t rays() const { return rays_; }  // since it was made

 private:
  void setLane(int lane, uint32_t direction, Vec3f from);
  void flush(VertexRays* out);

  const Tracer& tracer_;
  const GeodesicGrid& grid_;
  const std::span<const uint32_t> firstTriangle_;
  ShadowPacket packet_;
  uint32_t directionOf_[ShadowPacket::kSize] = {};
  int lanes_ = 0;
  uint64_t rays_ = 0;
};

}  // namespace lobelia::transfer
