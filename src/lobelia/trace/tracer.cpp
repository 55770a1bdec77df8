// Ray queries by Embree.
//
// Embree asks for denormal numbers to be flushed to zero. The mode is set around each query and
// restored after it: results must not depend on which thread ran what, and the mode must not leak
// into the rest of the program.
//
// Embree takes rays with NaN or huge coordinates for a programmer's error (builds with assertions,
// Debian's among them, abort). Here they hit nothing and count as visible: what caused them then
// shows up in the values that the stages check and count, instead of becoming shadow.
#include "lobelia/trace/tracer.h"

#include <cmath>
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

// Embree's own limits (its FLT_LARGE); false for NaN.
bool isValid(float ox, float oy, float oz, float dx, float dy, float dz, float tMin, float tMax) {
  constexpr float kLarge = 1.844e18f, kInfinity = std::numeric_limits<float>::infinity();
  return (std::abs(ox) <= kLarge) & (std::abs(oy) <= kLarge) & (std::abs(oz) <= kLarge) &
         (std::abs(dx) <= kLarge) & (std::abs(dy) <= kLarge) & (std::abs(dz) <= kLarge) &
         (std::abs(tMin) <= kInfinity) & (std::abs(tMax) <= kInfinity);
}
bool isValid(const Ray& r) {
  return isValid(r.o.x, r.o.y, r.o.z, r.d.x, r.d.y, r.d.z, r.tMin, r.tMax);
}

void setRay(const Ray& ray, RTCRay* r) {
  r->org_x = ray.o.x, r->org_y = ray.o.y, r->org_z = ray.o.z, r->tnear = std::max(ray.tMin, 0.f);
  r->dir_x = ray.d.x, r->dir_y = ray.d.y, r->dir_z = ray.d.z, r->time = 0;
  r->tfar = ray.tMax, r->mask = 0xffffffffu, r->id = 0, r->flags = 0;
}

// "Blocked" is what Embree writes into tfar.
bool isBlocked(float tfar) { return tfar == -std::numeric_limits<float>::infinity(); }

// Traces the lanes from `first` on, as many as Rays has; returns which are blocked.
template <class Rays>
uint32_t blockedLanes(const embree::Accel& accel, const ShadowPacket& packet, int first,
                      bool coherent) {
  constexpr int n = sizeof(Rays::org_x) / sizeof(float);
  Rays rays;
  alignas(64) int32_t valid[n];
  for (int i = 0; i < n; ++i) {
    const int k = first + i;
    valid[i] =
        packet.active[k] != 0 && isValid(packet.ox[k], packet.oy[k], packet.oz[k], packet.dx[k],
                                         packet.dy[k], packet.dz[k], packet.tMin[k], packet.tMax[k])
            ? -1
            : 0;
    rays.org_x[i] = packet.ox[k], rays.org_y[i] = packet.oy[k], rays.org_z[i] = packet.oz[k];
    rays.dir_x[i] = packet.dx[k], rays.dir_y[i] = packet.dy[k], rays.dir_z[i] = packet.dz[k];
    rays.tnear[i] = std::max(packet.tMin[k], 0.f), rays.tfar[i] = packet.tMax[k];
    rays.time[i] = 0;
    rays.mask[i] = 0xffffffffu;
    rays.id[i] = static_cast<unsigned>(k);
    rays.flags[i] = 0;
  }
  embree::QueryContext context;
  context.packet = &packet;
  embree::occludedPacket(valid, accel.top(), context, coherent, rays);
  uint32_t blocked = 0;
  for (int i = 0; i < n; ++i) blocked |= isBlocked(rays.tfar[i]) ? 1u << (first + i) : 0u;
  return blocked;
}

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
  if (!isValid(ray)) return std::nullopt;
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
  if (!isValid(ray)) return false;
  const FlushDenormals flush;
  embree::QueryContext context;
  context.ray = &ray;
  RTCRay query;
  setRay(ray, &query);
  embree::occluded1(impl_->accel.top(), context, query);
  return isBlocked(query.tfar);
}

uint32_t Tracer::visible(ShadowPacket& packet, bool coherent) const {
  uint32_t active = 0;
  for (int i = 0; i < ShadowPacket::kSize; ++i) active |= packet.active[i] != 0 ? 1u << i : 0u;
  if (active == 0) return 0;
  const FlushDenormals flush;
  const embree::Accel& accel = impl_->accel;
  if (!accel.instanced()) return active & ~blockedLanes<RTCRay16>(accel, packet, 0, coherent);
  // Embree 3.13.5 compiled for AVX-512 hangs in packets of 16 over instances, when coherent and
  // incoherent ones alternate (tests/trace/tracer_test.cpp shows it); packets of 8 are sound.
  return active & ~(blockedLanes<RTCRay8>(accel, packet, 0, coherent) |
                    blockedLanes<RTCRay8>(accel, packet, 8, coherent));
}

bool Tracer::visible(Vec3f a, Vec3f b) const { return !occluded({a, b - a, 0, kShadowEnd}); }

}  // namespace lobelia
