// Ray queries by Embree.
//
// Embree takes rays with NaN or huge coordinates for a programmer's error (builds with assertions,
// Debian's among them, abort). Here they hit nothing and count as visible: what caused them then
// shows up in the values that the stages check and count, instead of becoming shadow.
#include "lobelia/trace/tracer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

#include "lobelia/trace/accel.h"
#include "lobelia/trace/flush_denormals.h"

namespace lobelia {
namespace {

// Embree's own limit (its FLT_LARGE).
constexpr float kLarge = 1.844e18f;

bool isSmall(Vec3f v) {  // false for NaN
  return std::abs(v.x) <= kLarge && std::abs(v.y) <= kLarge && std::abs(v.z) <= kLarge;
}
bool isValid(const Ray& r) {
  return isSmall(r.o) && isSmall(r.d) && !std::isnan(r.tMin) && !std::isnan(r.tMax);
}

void setRay(const Ray& ray, RTCRay* r) {
  r->org_x = ray.o.x, r->org_y = ray.o.y, r->org_z = ray.o.z, r->tnear = std::max(ray.tMin, 0.f);
  r->dir_x = ray.d.x, r->dir_y = ray.d.y, r->dir_z = ray.d.z, r->time = 0;
  r->tfar = ray.tMax, r->mask = 0xffffffffu, r->id = 0, r->flags = 0;
}

// "Blocked" is what Embree writes into tfar.
bool isBlocked(float tfar) { return tfar == -std::numeric_limits<float>::infinity(); }

// A sufficient test of a whole packet, made for vectorisation.
bool allValid(const ShadowPacket& p) {
  int bad = 0;
  for (int i = 0; i < ShadowPacket::kSize; ++i) {
    const float sum = std::abs(p.ox[i]) + std::abs(p.oy[i]) + std::abs(p.oz[i]) +
                      std::abs(p.dx[i]) + std::abs(p.dy[i]) + std::abs(p.dz[i]) +
                      std::abs(p.tMin[i]);
    bad |= static_cast<int>(!(sum <= kLarge)) | static_cast<int>(std::isnan(p.tMax[i]));
  }
  return bad == 0;
}

struct alignas(64) Lanes {
  int32_t active[ShadowPacket::kSize];
};
Lanes validLanes(const ShadowPacket& p) {
  Lanes lanes;
  for (int i = 0; i < ShadowPacket::kSize; ++i) {
    const Ray ray{{p.ox[i], p.oy[i], p.oz[i]}, {p.dx[i], p.dy[i], p.dz[i]}, p.tMin[i], p.tMax[i]};
    lanes.active[i] = isValid(ray) ? p.active[i] : 0;
  }
  return lanes;
}

// Bit i: is v[i] negative?
template <int n>
uint32_t signBits(const float* v) {
  uint32_t bits = 0;
#if defined(__SSE__)
  for (int i = 0; i < n; i += 4) {
    bits |= static_cast<uint32_t>(_mm_movemask_ps(_mm_loadu_ps(v + i))) << i;
  }
#else
  for (int i = 0; i < n; ++i) bits |= std::signbit(v[i]) ? 1u << i : 0u;
#endif
  return bits;
}

// Copies the lanes from `first` on, as many as Rays has.
template <class Rays>
void setRays(const ShadowPacket& packet, int first, Rays& rays) {
  constexpr int n = sizeof(Rays::org_x) / sizeof(float);
  const auto copy = [&](float* to, const float* from) {
    std::memcpy(to, from + first, n * sizeof(float));
  };
  copy(rays.org_x, packet.ox), copy(rays.org_y, packet.oy), copy(rays.org_z, packet.oz);
  copy(rays.dir_x, packet.dx), copy(rays.dir_y, packet.dy), copy(rays.dir_z, packet.dz);
  for (int i = 0; i < n; ++i) {
    rays.tnear[i] = std::max(packet.tMin[first + i], 0.f);
    rays.tfar[i] = std::max(0.f, packet.tMax[first + i]);
    rays.time[i] = 0;
    rays.mask[i] = 0xffffffffu;
    rays.id[i] = static_cast<unsigned>(first + i);
    rays.flags[i] = 0;
  }
}

// Traces the lanes from `first` on; returns which are blocked.
template <class Rays>
uint32_t blockedLanes(const embree::Accel& accel, const ShadowPacket& packet, const int32_t* active,
                      int first, bool coherent) {
  constexpr int n = sizeof(Rays::org_x) / sizeof(float);
  Rays rays;
  setRays(packet, first, rays);
  embree::QueryContext context;
  context.packet = &packet;
  embree::occludedPacket(active + first, accel.top(), context, coherent, rays);
  // Blocked lanes are at minus infinity; no other end is negative (nor NaN: max keeps the 0 then).
  return signBits<n>(rays.tfar) << first;
}

Hit toHit(float t, float u, float v, uint32_t top, uint32_t geometry, uint32_t triangle) {
  return {t, u, v, top != RTC_INVALID_GEOMETRY_ID ? top : geometry, triangle};
}

template <class Rays>
void intersectLanes(const embree::Accel& accel, const ShadowPacket& packet, const int32_t* active,
                    int first, bool coherent, std::optional<Hit>* hits) {
  constexpr int n = sizeof(Rays::hit.u) / sizeof(float);
  Rays rays;
  setRays(packet, first, rays.ray);
  for (int i = 0; i < n; ++i) rays.hit.geomID[i] = rays.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  embree::QueryContext context;
  context.packet = &packet;
  embree::intersectPacket(active + first, accel.top(), context, coherent, rays);
  const auto& hit = rays.hit;
  for (int i = 0; i < n; ++i) {
    if (hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    hits[first + i] =
        toHit(rays.ray.tfar[i], hit.u[i], hit.v[i], hit.instID[0][i], hit.geomID[i], hit.primID[i]);
  }
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
  return toHit(query.ray.tfar, hit.u, hit.v, hit.instID[0], hit.geomID, hit.primID);
}

void Tracer::intersect(ShadowPacket& packet, bool coherent,
                       std::span<std::optional<Hit>, ShadowPacket::kSize> hits) const {
  std::fill(hits.begin(), hits.end(), std::nullopt);
  const FlushDenormals flush;
  const embree::Accel& accel = impl_->accel;
  Lanes valid;
  const int32_t* lanes = packet.active;
  if (!allValid(packet)) valid = validLanes(packet), lanes = valid.active;
  if (!accel.instanced()) {
    intersectLanes<RTCRayHit16>(accel, packet, lanes, 0, coherent, hits.data());
  } else {  // as visible()
    intersectLanes<RTCRayHit8>(accel, packet, lanes, 0, coherent, hits.data());
    intersectLanes<RTCRayHit8>(accel, packet, lanes, 8, coherent, hits.data());
  }
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
  static_assert(sizeof(int32_t) == sizeof(float));
  float signs[ShadowPacket::kSize];
  std::memcpy(signs, packet.active, sizeof(signs));
  const uint32_t active = signBits<ShadowPacket::kSize>(signs);
  if (active == 0) return 0;
  const FlushDenormals flush;
  const embree::Accel& accel = impl_->accel;
  Lanes valid;
  const int32_t* lanes = packet.active;
  if (!allValid(packet)) valid = validLanes(packet), lanes = valid.active;
  if (!accel.instanced()) {
    return active & ~blockedLanes<RTCRay16>(accel, packet, lanes, 0, coherent);
  }
  // Embree 3.13.5 compiled for AVX-512 hangs in packets of 16 over instances, when coherent and
  // incoherent ones alternate (tests/trace/tracer_test.cpp shows it); packets of 8 are sound.
  return active & ~(blockedLanes<RTCRay8>(accel, packet, lanes, 0, coherent) |
                    blockedLanes<RTCRay8>(accel, packet, lanes, 8, coherent));
}

bool Tracer::visible(Vec3f a, Vec3f b) const { return !occluded({a, b - a, 0, kShadowEnd}); }

}  // namespace lobelia
