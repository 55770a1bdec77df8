#include "lobelia/trace/bare_rays.h"

#include <algorithm>
#include <cstring>
#include <iterator>

#include "lobelia/trace/accel.h"
#include "lobelia/trace/flush_denormals.h"

namespace lobelia {
namespace {

template <class Rays>
void setRays(const ShadowPacket& packet, int first, Rays& rays) {
  constexpr int n = sizeof(Rays::org_x) / sizeof(float);
  const auto copy = [&](float* to, const float* from) {
    std::memcpy(to, from + first, n * sizeof(float));
  };
  copy(rays.org_x, packet.ox), copy(rays.org_y, packet.oy), copy(rays.org_z, packet.oz);
  copy(rays.dir_x, packet.dx), copy(rays.dir_y, packet.dy), copy(rays.dir_z, packet.dz);
  copy(rays.tnear, packet.tMin), copy(rays.tfar, packet.tMax);
  for (int i = 0; i < n; ++i) {
    rays.mask[i] = 0xffffffffu;
    rays.id[i] = static_cast<unsigned>(first + i);
  }
}

// Traces the lanes from `first` on, as many as Rays has.
template <class Rays>
uint64_t visibleLanes(const embree::Accel& accel, const ShadowPacket& packet, int first,
                      bool coherent) {
  constexpr int n = sizeof(Rays::org_x) / sizeof(float);
  Rays rays{};
  setRays(packet, first, rays);
  embree::QueryContext context;
  context.packet = &packet;
  embree::occludedPacket(packet.active + first, accel.top(), context, coherent, rays);
  uint64_t count = 0;
  for (int i = 0; i < n; ++i) count += packet.active[first + i] != 0 && rays.tfar[i] >= 0 ? 1 : 0;
  return count;
}

template <class Rays>
uint64_t hitLanes(const embree::Accel& accel, const ShadowPacket& packet, int first,
                  bool coherent) {
  constexpr int n = sizeof(Rays::hit.u) / sizeof(float);
  Rays rays;
  setRays(packet, first, rays.ray);
  for (int i = 0; i < n; ++i) {
    rays.ray.time[i] = 0, rays.ray.flags[i] = 0;
    rays.hit.geomID[i] = rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  embree::QueryContext context;
  context.packet = &packet;
  embree::intersectPacket(packet.active + first, accel.top(), context, coherent, rays);
  uint64_t count = 0;
  for (int i = 0; i < n; ++i) {
    count += packet.active[first + i] != 0 && rays.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
  }
  return count;
}

uint64_t activeLanes(const ShadowPacket& packet) {
  return static_cast<uint64_t>(std::count_if(std::begin(packet.active), std::end(packet.active),
                                             [](int32_t active) { return active != 0; }));
}

bool hits(const embree::Accel& accel, const TracedRay& traced) {
  const Ray& r = traced.ray;
  embree::QueryContext context;
  context.ray = &r;
  RTCRayHit query;
  query.ray = {r.o.x, r.o.y, r.o.z, r.tMin, r.d.x, r.d.y, r.d.z, 0, r.tMax, 0xffffffffu, 0, 0};
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  if (traced.shadow) {
    embree::occluded1(accel.top(), context, query.ray);
  } else {
    embree::intersect1(accel.top(), context, query);
  }
  return query.ray.tfar < r.tMax;
}

}  // namespace

struct BareRays::Impl {
  Impl(const Scene& scene, Context& context) : accel(scene, context) {}
  embree::Accel accel;
};

BareRays::BareRays(const Scene& scene, Context& context)
    : impl_(std::make_unique<Impl>(scene, context)) {}
BareRays::~BareRays() = default;

uint64_t BareRays::visible(std::span<const ShadowPacket> packets, bool coherent) const {
  const FlushDenormals flush;
  uint64_t count = 0;
  for (const ShadowPacket& packet : packets) {
    // As Tracer::visible(): packets of 16 over instances hang in some versions of Embree.
    if (impl_->accel.instanced()) {
      count += visibleLanes<RTCRay8>(impl_->accel, packet, 0, coherent) +
               visibleLanes<RTCRay8>(impl_->accel, packet, 8, coherent);
    } else {
      count += visibleLanes<RTCRay16>(impl_->accel, packet, 0, coherent);
    }
  }
  return count;
}

uint64_t BareRays::hits(std::span<const TracedRay> rays) const {
  const FlushDenormals flush;
  uint64_t count = 0;
  for (const TracedRay& traced : rays) count += lobelia::hits(impl_->accel, traced) ? 1 : 0;
  return count;
}

uint64_t BareRays::hits(const TracedRays& rays) const {
  const FlushDenormals flush;
  const embree::Accel& accel = impl_->accel;
  uint64_t count = 0;
  for (const TracedRays::Query& query : rays.queries) {
    if (!query.packet) {
      count += lobelia::hits(accel, rays.rays[query.index]) ? 1 : 0;
      continue;
    }
    const ShadowPacket& packet = rays.packets[query.index];
    if (query.shadow) {
      count += activeLanes(packet) - visible(std::span(&packet, 1), true);
    } else if (accel.instanced()) {
      count += hitLanes<RTCRayHit8>(accel, packet, 0, true) +
               hitLanes<RTCRayHit8>(accel, packet, 8, true);
    } else {
      count += hitLanes<RTCRayHit16>(accel, packet, 0, true);
    }
  }
  return count;
}

}  // namespace lobelia
