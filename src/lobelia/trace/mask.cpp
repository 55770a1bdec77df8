// Stochastic opacity as a filter function.
#include "lobelia/trace/mask.h"

#include <bit>

#include "lobelia/base/random.h"

namespace lobelia::embree {
namespace {

uint64_t pair(float a, float b) {
  return uint64_t{std::bit_cast<uint32_t>(a)} << 32 | std::bit_cast<uint32_t>(b);
}

float uniform(Vec3f o, Vec3f d, uint32_t instance, uint32_t triangle) {
  uint64_t h = hashCombine(pair(o.x, o.y), pair(o.z, d.x));
  h = hashCombine(h, pair(d.y, d.z));
  h = hashCombine(h, uint64_t{instance} << 32 | triangle);
  return toUnitFloat(static_cast<uint32_t>(h >> 32));
}

bool stops(const Scene& scene, uint32_t instanceIndex, uint32_t triangle, Vec2f b, Vec3f o,
           Vec3f d) {
  const Instance& instance = scene.instances[instanceIndex];
  const Mesh& mesh = scene[instance.mesh];
  TextureContext at{b, &mesh, triangle, b};
  if (!mesh.uvs.empty()) {
    const Vec3u v = mesh.triangles[triangle];
    at.uv = mesh.uvs[v.x] * (1 - b.x - b.y) + mesh.uvs[v.y] * b.x + mesh.uvs[v.z] * b.y;
  }
  const float alpha = opacity(scene, instance.material, at);
  if (alpha <= 0) return false;
  return alpha >= 1 || uniform(o, d, instanceIndex, triangle) < alpha;
}

}  // namespace

void filterMask(const RTCFilterFunctionNArguments* arguments) {
  const Scene& scene = *static_cast<const Scene*>(arguments->geometryUserPtr);
  const QueryContext& context = *reinterpret_cast<const QueryContext*>(arguments->context);
  const unsigned n = arguments->N;
  for (unsigned i = 0; i < n; ++i) {
    if (arguments->valid[i] != -1) continue;
    const unsigned top = RTCHitN_instID(arguments->hit, n, i, 0);
    const uint32_t instance =
        top != RTC_INVALID_GEOMETRY_ID ? top : RTCHitN_geomID(arguments->hit, n, i);
    const uint32_t triangle = RTCHitN_primID(arguments->hit, n, i);
    const Vec2f b{RTCHitN_u(arguments->hit, n, i), RTCHitN_v(arguments->hit, n, i)};
    Vec3f o, d;
    if (context.ray) {
      o = context.ray->o, d = context.ray->d;
    } else {
      const ShadowPacket& p = *context.packet;
      const unsigned lane = RTCRayN_id(arguments->ray, n, i);
      o = {p.ox[lane], p.oy[lane], p.oz[lane]}, d = {p.dx[lane], p.dy[lane], p.dz[lane]};
    }
    if (!stops(scene, instance, triangle, b, o, d)) arguments->valid[i] = 0;
  }
}

}  // namespace lobelia::embree
