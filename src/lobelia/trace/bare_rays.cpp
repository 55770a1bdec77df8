#include "lobelia/trace/bare_rays.h"

#include <cstring>

#include "lobelia/trace/accel.h"

namespace lobelia {

struct BareRays::Impl {
  Impl(const Scene& scene, Context& context) : accel(scene, context) {}
  embree::Accel accel;
};

BareRays::BareRays(const Scene& scene, Context& context)
    : impl_(std::make_unique<Impl>(scene, context)) {}
BareRays::~BareRays() = default;

uint64_t BareRays::visible(std::span<const ShadowPacket> packets, bool coherent) const {
  uint64_t count = 0;
  RTCRay16 rays{};
  for (int i = 0; i < ShadowPacket::kSize; ++i) {
    rays.mask[i] = 0xffffffffu;
    rays.id[i] = static_cast<uint32_t>(i);
  }
  for (const ShadowPacket& packet : packets) {
    std::memcpy(rays.org_x, packet.ox, sizeof(packet.ox));
    std::memcpy(rays.org_y, packet.oy, sizeof(packet.oy));
    std::memcpy(rays.org_z, packet.oz, sizeof(packet.oz));
    std::memcpy(rays.dir_x, packet.dx, sizeof(packet.dx));
    std::memcpy(rays.dir_y, packet.dy, sizeof(packet.dy));
    std::memcpy(rays.dir_z, packet.dz, sizeof(packet.dz));
    std::memcpy(rays.tnear, packet.tMin, sizeof(packet.tMin));
    std::memcpy(rays.tfar, packet.tMax, sizeof(packet.tMax));
    embree::QueryContext context;
    context.packet = &packet;
    embree::occludedPacket(packet.active, impl_->accel.top(), context, coherent, rays);
    for (int i = 0; i < ShadowPacket::kSize; ++i)
      count += packet.active[i] != 0 && rays.tfar[i] >= 0 ? 1 : 0;
  }
  return count;
}

uint64_t BareRays::hits(std::span<const TracedRay> rays) const {
  uint64_t count = 0;
  for (const TracedRay& traced : rays) {
    const Ray& r = traced.ray;
    embree::QueryContext context;
    context.ray = &r;
    RTCRayHit query;
    query.ray = {r.o.x, r.o.y, r.o.z, r.tMin, r.d.x, r.d.y, r.d.z, 0, r.tMax, 0xffffffffu, 0, 0};
    query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    if (traced.shadow) {
      embree::occluded1(impl_->accel.top(), context, query.ray);
    } else {
      embree::intersect1(impl_->accel.top(), context, query);
    }
    count += query.ray.tfar < r.tMax ? 1 : 0;
  }
  return count;
}

}  // namespace lobelia
