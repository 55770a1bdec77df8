#include "lobelia/transfer/vertex_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lobelia::transfer {
namespace {

uint16_t quantised(float barycentric) {
  return static_cast<uint16_t>(std::lround(std::clamp(barycentric, 0.f, 1.f) * 65535));
}

}  // namespace

const Vec3f* rayStart(std::span<const relight::FacePlace> faces, Vec3f d) {
  const Vec3f* best = nullptr;
  float most = 0;
  for (const relight::FacePlace& face : faces) {
    const float c = dot(face.n, d);
    if (c > most) most = c, best = &face.front;
    if (face.bothSides && -c > most) most = -c, best = &face.back;
  }
  return best;
}

RayTracer::RayTracer(const Tracer& tracer, const GeodesicGrid& grid,
                     std::span<const uint32_t> firstTriangle)
    : tracer_(tracer), grid_(grid), firstTriangle_(firstTriangle) {}

void RayTracer::setLane(int lane, uint32_t direction, Vec3f from) {
  const Vec3f d = grid_.directions()[direction];
  packet_.set(lane, Ray{from, d, 0, std::numeric_limits<float>::infinity()});
  directionOf_[lane] = direction;
}

void RayTracer::flush(VertexRays* out) {
  if (lanes_ == 0) return;
  for (int i = lanes_; i < ShadowPacket::kSize; ++i) packet_.active[i] = 0;
  std::optional<Hit> hits[ShadowPacket::kSize];
  tracer_.intersect(packet_, true, hits);
  for (int i = 0; i < lanes_; ++i) {
    const uint32_t d = directionOf_[i];
    std::vector<uint64_t>& bits = hits[i] ? out->blocked : out->free;
    bits[d / 64] |= uint64_t{1} << d % 64;
    if (hits[i])
      out->hits.push_back({firstTriangle_[hits[i]->instance] + hits[i]->triangle,
                           quantised(hits[i]->b1), quantised(hits[i]->b2)});
  }
  rays_ += static_cast<uint64_t>(lanes_);
  lanes_ = 0;
}

void RayTracer::trace(std::span<const relight::FacePlace> faces, VertexRays* out) {
  const size_t words = (grid_.count() + 63) / 64;
  out->free.assign(words, 0);
  out->blocked.assign(words, 0);
  out->hits.clear();
  for (uint32_t d = 0; d < grid_.count(); ++d) {
    const Vec3f* from = rayStart(faces, grid_.directions()[d]);
    if (from == nullptr) continue;
    setLane(lanes_++, d, *from);
    if (lanes_ == ShadowPacket::kSize) flush(out);
  }
  flush(out);
}

}  // namespace lobelia::transfer
