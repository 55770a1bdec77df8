// Light of surfaces at a pixel, in registers of nodes (local_kernels.h).
#if defined(LOBELIA_RELIGHT_LOCAL_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_RELIGHT_LOCAL_SHADING_INL_H_
#undef LOBELIA_RELIGHT_LOCAL_SHADING_INL_H_
#else
#define LOBELIA_RELIGHT_LOCAL_SHADING_INL_H_
#endif

#include "lobelia/base/simd-inl.h"
#include "lobelia/relight/local_kernels.h"

LOBELIA_CORE_BEGIN

HWY_INLINE V3<Vf> loadVector(const float* const values[3], size_t at) {
  return {Vf::load(values[0] + at), Vf::load(values[1] + at), Vf::load(values[2] + at)};
}

HWY_INLINE Vf interpolatedRow(const relight::NearLights& lights, size_t channel, size_t at) {
  return Vf::load(lights.rows[0].channel(channel) + at) * Vf(lights.weight[0]) +
         Vf::load(lights.rows[1].channel(channel) + at) * Vf(lights.weight[1]) +
         Vf::load(lights.rows[2].channel(channel) + at) * Vf(lights.weight[2]);
}

inline void gatherNearLight(const relight::NearLights& lights, size_t chunkCount, Vec3f place,
                            Vec3f normal, relight::DirectedLight* out) {
  const V3<Vf> p{Vf(place.x), Vf(place.y), Vf(place.z)};
  const V3<Vf> n{Vf(normal.x), Vf(normal.y), Vf(normal.z)};
  const Vf softening(lights.softening), zero(0.f);
  float* const light[3] = {out->r.data(), out->g.data(), out->b.data()};
  out->chunkCount = 0;
  for (size_t chunk = 0; chunk < chunkCount; ++chunk) {
    const size_t to = out->chunkCount * relight::kChunk;
    uint32_t lit = 0;
    for (size_t lane = 0; lane < relight::kChunk; lane += kLanes) {
      const size_t at = chunk * relight::kChunk + lane;
      const V3<Vf> v = loadVector(lights.place, at) - p;
      const Vf away = dot(v, n), facing = zero - dot(v, loadVector(lights.normal, at));
      const Mf front = (away > zero) & (facing > zero);
      if (!any(front)) {
        for (float* values : light) zero.store(values + to + lane);
        continue;
      }
      const Vf d2 = max(dot(v, v), Vf(1e-30f));
      const Vf inverse = Vf(1.f) / sqrt(d2);
      const Vf geometry = select(front, facing * inverse / (d2 + softening), zero);
      Mf some = front;
      for (size_t c = 0; c < 3; ++c) {
        const Vf value = interpolatedRow(lights, c, at) * geometry;
        value.store(light[c] + to + lane);
        some = c == 0 ? value != zero : some | (value != zero);
      }
      lit |= maskBits(some) << lane;
      (v.x * inverse).store(out->x.data() + to + lane);
      (v.y * inverse).store(out->y.data() + to + lane);
      (v.z * inverse).store(out->z.data() + to + lane);
    }
    if (lit == 0) continue;
    out->chunk[out->chunkCount] = static_cast<uint32_t>(chunk);
    out->lit[out->chunkCount++] = static_cast<uint16_t>(lit);
  }
}

LOBELIA_CORE_END

#endif  // per-target include guard
