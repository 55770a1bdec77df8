// Ray queries by Embree.
//
// Embree asks for denormal numbers to be flushed to zero. The mode is set around each query and
// restored after it: results must not depend on which thread ran what, and the mode must not leak
// into the rest of the program.
#include "lobelia/trace/tracer.h"

#include <cstring>
#include <limits>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "lobelia/trace/accel.h"

namespace lobelia {
namespace {

#if defined(__SSE__)
class FlushDenormals {
 public:
  FlushDenormals() : old_(_mm_getcsr()) {
    if ((old_ & kBits) != kBits) _mm_setcsr(old_ | kBits);
  }
  ~FlushDenormals() {
    if ((old_ & kBits) != kBits) _mm_setcsr(old_);
  }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  static constexpr unsigned kBits = 0x8040;  // flush to zero, denormals are zero
  unsigned old_;
};
#else
struct FlushDenormals {
  FlushDenormals() {}
};
#endif

void setRay(const Ray& ray, RTCRay* r) {
  r->org_x = ray.o.x, r->org_y = ray.o.y, r->org_z = ray.o.z, r->tnear = ray.tMin;
  r->dir_x = ray.d.x, r->dir_y = ray.d.y, r->dir_z = ray.d.z, r->time = 0;
  r->tfar = ray.tMax, r->mask = 0xffffffffu, r->id = 0, r->flags = 0;
}

// "Blocked" is what Embree writes into tfar.
bool isBlocked(float tfar) { return tfar == -std::numeric_limits<float>::infinity(); }

}  // namespace

struct Tracer::Impl {
  Impl(const Scene& scene, Context& context) : accel(scene, context) {}
  embree::Accel accel;
};

Tracer::Tracer(const Scene& scene, Context& context) : scene_(scene) {
  const StageTimer timer(context, "accel");
  impl_ = std::make_unique<Impl>(scene, context);
  bounds_ = lobelia::bounds(scene);
  context.statistics.setValue("embree_bytes", static_cast<double>(impl_->accel.bytes()));
}

Tracer::~Tracer() = default;

std::optional<Hit> Tracer::intersect(const Ray& ray) const {
  const FlushDenormals flush;
  embree::QueryContext context;
  context.ray = &ray;
  RTCRayHit query;
  setRay(ray, &query.ray);
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  embree::intersect1(impl_->accel.top(), context, query);
  const RTCHit& hit = query.hit;
  if (hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const bool instanced = hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
  return Hit{query.ray.tfar, hit.u, hit.v, instanced ? hit.instID[0] : hit.geomID, hit.primID};
}

bool Tracer::occluded(const Ray& ray) const {
  const FlushDenormals flush;
  embree::QueryContext context;
  context.ray = &ray;
  RTCRay query;
  setRay(ray, &query);
  embree::occluded1(impl_->accel.top(), context, query);
  return isBlocked(query.tfar);
}

uint32_t Tracer::visible(ShadowPacket& packet, bool coherent) const {
  constexpr int n = ShadowPacket::kSize;
  uint32_t active = 0;
  for (int i = 0; i < n; ++i) active |= packet.active[i] != 0 ? 1u << i : 0u;
  if (active == 0) return 0;
  const FlushDenormals flush;
  embree::QueryContext context;
  context.packet = &packet;
  RTCRay16 rays;
  static_assert(sizeof(rays.org_x) == sizeof(packet.ox));
  // Origins with tMin, and directions, lie in the same order in both.
  std::memcpy(rays.org_x, packet.ox, 4 * sizeof(packet.ox));
  std::memcpy(rays.dir_x, packet.dx, 3 * sizeof(packet.dx));
  std::memcpy(rays.tfar, packet.tMax, sizeof(packet.tMax));
  for (int i = 0; i < n; ++i) {
    rays.time[i] = 0;
    rays.mask[i] = 0xffffffffu;
    rays.id[i] = static_cast<unsigned>(i);
    rays.flags[i] = 0;
  }
  embree::occluded16(packet.active, impl_->accel.top(), context, coherent, rays);
  uint32_t blocked = 0;
  for (int i = 0; i < n; ++i) blocked |= isBlocked(rays.tfar[i]) ? 1u << i : 0u;
  return active & ~blocked;
}

bool Tracer::visible(Vec3f a, Vec3f b) const { return !occluded({a, b - a, 0, kShadowEnd}); }

}  // namespace lobelia
