// Packets of pixels in registers (packet_kernels.h).
#if defined(LOBELIA_TRANSFER_PACKET_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_TRANSFER_PACKET_SHADING_INL_H_
#undef LOBELIA_TRANSFER_PACKET_SHADING_INL_H_
#else
#define LOBELIA_TRANSFER_PACKET_SHADING_INL_H_
#endif

#include "lobelia/base/simd-inl.h"
#include "lobelia/transfer/interpolation-inl.h"
#include "lobelia/transfer/packet_kernels.h"
#include "lobelia/transfer/resultant.h"

LOBELIA_CORE_BEGIN

using D4 = hn::CappedTag<float, 4>;  // four numbers of a row; scalars where a target has no more
inline constexpr size_t kAtOnce = hn::MaxLanes(D4());

HWY_INLINE V3<Vf> loadVectors(const transfer::PixelPacket::Vectors& v, size_t lane) {
  return {Vf::load(v.x.at + lane), Vf::load(v.y.at + lane), Vf::load(v.z.at + lane)};
}
HWY_INLINE void storeVectors(V3<Vf> from, size_t lane, transfer::PixelPacket::Vectors* v) {
  from.x.store(v->x.at + lane), from.y.store(v->y.at + lane), from.z.store(v->z.at + lane);
}
HWY_INLINE V3<Vf> selectVector(Mf mask, V3<Vf> a, V3<Vf> b) {
  return {select(mask, a.x, b.x), select(mask, a.y, b.y), select(mask, a.z, b.z)};
}
HWY_INLINE V3<Vf> noVector() { return {Vf(0.f), Vf(0.f), Vf(0.f)}; }
HWY_INLINE Vf lengthOf(V3<Vf> v) { return sqrt(dot(v, v)); }

// Four numbers of each lane.
struct Quad {
  V3<Vf> v;
  Vf w;
};
HWY_INLINE Quad loadQuad(const float* rows) {
  const Df df;
  hn::Vec<Df> x, y, z, w;
  hn::LoadInterleaved4(df, rows, x, y, z, w);
  return {{Vf(x), Vf(y), Vf(z)}, Vf(w)};
}

// What the lanes from `lane` on read of the vertices around them.
struct LaneVertices {
  const uint32_t* slot[3];
  const float* weight[3];
};
HWY_INLINE LaneVertices verticesOf(const transfer::PixelPacket& packet, size_t lane) {
  return {{packet.slot[0] + lane, packet.slot[1] + lane, packet.slot[2] + lane},
          {packet.weight[0].at + lane, packet.weight[1].at + lane, packet.weight[2].at + lane}};
}
// rows: of slot 0, from the first of the four numbers on; stride: from slot to slot, in floats.
HWY_INLINE Quad quadAt(const float* rows, size_t stride, const uint32_t* slot) {
  const D4 d4;
  alignas(64) float buffer[4 * kLanes];
  for (size_t i = 0; i < kLanes; ++i)
    for (size_t c = 0; c < 4; c += kAtOnce)
      hn::Store(hn::Load(d4, rows + slot[i] * stride + c), d4, buffer + 4 * i + c);
  return loadQuad(buffer);
}
// Summed over the three vertices by weight.
HWY_INLINE Quad quadBetween(const float* rows, size_t stride, const LaneVertices& at) {
  const D4 d4;
  alignas(64) float buffer[4 * kLanes];
  for (size_t i = 0; i < kLanes; ++i)
    for (size_t c = 0; c < 4; c += kAtOnce) {
      const auto part = [&](size_t v) HWY_ATTR {
        return hn::Mul(hn::Load(d4, rows + at.slot[v][i] * stride + c),
                       hn::Set(d4, at.weight[v][i]));
      };
      hn::Store(hn::Add(hn::Add(part(0), part(1)), part(2)), d4, buffer + 4 * i + c);
    }
  return loadQuad(buffer);
}

HWY_INLINE Vf kappaOf(Vf resultant) {
  return kappaByTable(resultant, transfer::resultantCorrections(), transfer::kResultantCells,
                      transfer::kMostKappa);
}

HWY_INLINE void storeWhole(Vf v, int32_t* to) { hn::Store(hn::ConvertTo(Di(), v.v), Di(), to); }

// The four texels around each lane's spot in one level.
struct LaneTexels {
  alignas(64) int32_t level[kLanes], first[kLanes], stride[kLanes];  // in floats
  alignas(64) float weight[4][kLanes];
};
// share: of this level.
HWY_INLINE void placeTexels(const transfer::LightLevels& light, const CubeSpot<Vf>& spot, Vf level,
                            Vf share, LaneTexels* out) {
  const Vf size = gather(light.sizes, level), one(1.f);
  const auto [index, u, v] = texelPlace(spot, size);
  storeWhole(level, out->level);
  storeWhole(size * Vf(4.f), out->stride);
  storeWhole(index * Vf(4.f), out->first);
  (share * (one - u) * (one - v)).store(out->weight[0]);
  (share * u * (one - v)).store(out->weight[1]);
  (share * (one - u) * v).store(out->weight[2]);
  (share * u * v).store(out->weight[3]);
}

// PrefilteredLight::lookUp(); axis: in the frame of the light, of any length.
HWY_INLINE V3<Vf> lightAt(const transfer::LightLevels& light, V3<Vf> axis, Vf kappa) {
  const Vf level =
      levelOfKappa(kappa, light.sharpest, transfer::PrefilteredLight::kLevelsPerOctave, light.last);
  const Vf sharper = min(floor(level), Vf(light.last - 1)), share = level - sharper;
  const CubeSpot<Vf> spot = cubeSpot(axis);
  LaneTexels texels[2];
  placeTexels(light, spot, sharper, Vf(1.f) - share, &texels[0]);
  placeTexels(light, spot, sharper + Vf(1.f), share, &texels[1]);
  const D4 d4;
  alignas(64) float sums[4 * kLanes];
  for (size_t i = 0; i < kLanes; ++i)
    for (size_t c = 0; c < 4; c += kAtOnce) {
      const auto bilinear = [&](const LaneTexels& of) HWY_ATTR {
        const float* const t = light.texels[of.level[i]] + of.first[i] + c;
        const float* const below = t + of.stride[i];
        const auto texel = [&](const float* from, size_t k) HWY_ATTR {
          return hn::Mul(hn::Load(d4, from), hn::Set(d4, of.weight[k][i]));
        };
        return hn::Add(hn::Add(texel(t, 0), texel(t + 4, 1)),
                       hn::Add(texel(below, 2), texel(below + 4, 3)));
      };
      hn::Store(hn::Add(bilinear(texels[0]), bilinear(texels[1])), d4, sums + 4 * i + c);
    }
  return loadQuad(sums).v;
}

// VisiblePart between the vertices, and whether it is all of the lobe.
struct VisibleBetween {
  V3<Vf> share, own, axis;
  Vf width;
  Mf whole;
};
HWY_INLINE VisibleBetween visibleBetween(const transfer::VisibleRow* rows, const LaneVertices& at,
                                         V3<Vf> r) {
  constexpr size_t kStride = sizeof(transfer::VisibleRow) / sizeof(float);
  const auto* const first = reinterpret_cast<const float*>(rows);
  const Vf size = lengthOf(r), zero(0.f);
  const V3<Vf> up{zero, zero, Vf(1.f)};
  VisibleBetween out;
  out.own = selectVector(size > zero, r * (Vf(1.f) / size), up);
  const Quad shares = quadBetween(first, kStride, at);
  V3<Vf> axes = noVector();
  Vf widths(0.f), wholes(0.f);
  for (size_t v = 0; v < 3; ++v) {
    const Vf weight = Vf::load(at.weight[v]);
    const Quad own = quadAt(first + 4, kStride, at.slot[v]);
    const Quad axis = quadAt(first + 8, kStride, at.slot[v]);
    const Mf whole = axis.w > zero;
    axes = axes + selectVector(whole, out.own, turnedWith(axis.v, own.v, out.own)) * weight;
    widths += own.w * weight;
    wholes += axis.w;
  }
  out.whole = wholes > Vf(2.5f);
  out.share = shares.v;
  const Vf apart = lengthOf(axes), energy = shares.w;
  const Mf any = (energy > zero) & (apart > zero);
  out.axis = selectVector(any, axes * (Vf(1.f) / apart), out.own);
  out.width = select(any, widthBetween(widths, apart, energy, kappaOf(size)), Vf(1.f));
  return out;
}

HWY_INLINE V3<Vf> toLight(const transfer::PacketLight& light, V3<Vf> d) {
  const auto row = [&](size_t i) HWY_ATTR {
    const Vec3f of = light.toLight[i];
    return d.x * Vf(of.x) + d.y * Vf(of.y) + d.z * Vf(of.z);
  };
  return {row(0), row(1), row(2)};
}

inline bool anyVisible(const transfer::VertexRows& vertices, const LaneVertices& at, bool* whole) {
  bool any = false;
  *whole = true;
  for (size_t v = 0; v < 3; ++v)
    for (size_t i = 0; i < kLanes; ++i) {
      const transfer::VisibleRow& row = vertices.visible[at.slot[v][i]];
      *whole = *whole && row.whole > 0;
      any = any || row.energy > 0;
    }
  return any;
}

// Straight from infinity, over glossy lobes.
HWY_INLINE V3<Vf> directLight(const transfer::VertexRows& vertices,
                              const transfer::PacketLight& light,
                              const transfer::PixelPacket& packet, size_t lane, size_t* lookups) {
  const LaneVertices at = verticesOf(packet, lane);
  V3<Vf> sum = noVector();
  bool whole = true;
  if (!anyVisible(vertices, at, &whole)) return sum;
  VisibleBetween part;
  if (!whole) part = visibleBetween(vertices.visible, at, loadVectors(packet.r, lane));
  for (int j = 0; j < packet.lobeCount; ++j) {
    const transfer::PixelPacket::Lobe& lobe = packet.lobes[j];
    V3<Vf> axis = loadVectors(lobe.axis, lane), alpha = loadVectors(lobe.alpha, lane);
    Vf kappa = Vf::load(lobe.kappa.at + lane);
    if (!whole) {
      axis = selectVector(part.whole, axis, turnedWith(axis, part.own, part.axis));
      kappa = select(part.whole, kappa, kappa / part.width);
      alpha = selectVector(part.whole, alpha, alpha * part.share);
    }
    sum = sum + alpha * lightAt(light.levels, toLight(light, axis), kappa);
    ++*lookups;
  }
  return sum;
}

// Over other surfaces, by glossy lobes; over the albedo.
HWY_INLINE V3<Vf> bouncedLight(const transfer::VertexRows& vertices,
                               const transfer::PacketLight& light,
                               const transfer::PixelPacket& packet, size_t lane, size_t* lookups) {
  const LaneVertices at = verticesOf(packet, lane);
  V3<Vf> sum = noVector();
  bool bounced = false;
  for (size_t v = 0; v < 3; ++v)
    for (size_t i = 0; i < kLanes; ++i) bounced = bounced || vertices.hasLobes[at.slot[v][i]] != 0;
  if (!bounced) return sum;
  constexpr size_t kRow = sizeof(transfer::LobeRow) / sizeof(float);
  const size_t stride = kRow * vertices.lobeCount;
  const Vf zero(0.f);
  for (size_t c = 0; c < vertices.lobeCount; ++c) {
    const float* const rows = reinterpret_cast<const float*>(vertices.lobes) + kRow * c;
    const Quad shares = quadBetween(rows, stride, at);
    const Mf lit = shares.w > zero;
    if (!any(lit)) continue;
    const Quad moments = quadBetween(rows + 4, stride, at),
               mirrors = quadBetween(rows + 8, stride, at);
    const Vf moment = lengthOf(moments.v);
    const LobeTotals<Vf> totals{moments.v, mirrors.v, moments.w, shares.w};
    const Vf size =
        select(moment > zero,
               resultantBetween(totals, moment, Vf(sqr(transfer::LobeSum::kMagnification))), zero);
    const V3<Vf> axis = selectVector(moment > zero, moments.v * (Vf(1.f) / moment),
                                     loadVectors(packet.mirror, lane));
    sum = sum + selectVector(lit, shares.v, noVector()) *
                    lightAt(light.levels, toLight(light, axis), kappaOf(size));
    ++*lookups;
  }
  return sum;
}

inline size_t shadePacket(const transfer::VertexRows& vertices, const transfer::PacketLight& light,
                          transfer::PixelPacket* packet) {
  size_t lookups = 0;
  for (size_t lane = 0; lane < packet->count; lane += kLanes) {
    size_t found = 0;  // by a register
    V3<Vf> sum = loadVectors(packet->emitted, lane);
    const Quad diffuse =
        quadBetween(reinterpret_cast<const float*>(vertices.diffuse),
                    sizeof(transfer::LightRow) / sizeof(float), verticesOf(*packet, lane));
    sum = sum + loadVectors(packet->diffuse, lane) * diffuse.v;
    if (packet->lobeCount > 0) {
      if (light.direct) sum = sum + directLight(vertices, light, *packet, lane, &found);
      sum = sum + loadVectors(packet->glossy, lane) *
                      bouncedLight(vertices, light, *packet, lane, &found);
    }
    storeVectors(sum, lane, &packet->radiance);
    lookups += found * std::min(kLanes, packet->count - lane);
  }
  return lookups;
}

inline void lookUpLight(const transfer::PacketLight& light, transfer::LobePacket* packet) {
  for (size_t lane = 0; lane < transfer::PixelPacket::kSize; lane += kLanes) {
    const V3<Vf> r = loadVectors(packet->r, lane);
    const Vf size = lengthOf(r), zero(0.f);
    const V3<Vf> found =
        loadVectors(packet->share, lane) * lightAt(light.levels, toLight(light, r), kappaOf(size));
    storeVectors(selectVector(size > zero, found, noVector()), lane, &packet->light);
  }
}

inline void lookUpReflection(const transfer::ElevationRows& table, transfer::PixelPacket* packet) {
  for (size_t lane = 0; lane < packet->count; lane += kLanes) {
    const V3<Vf> n = loadVectors(packet->n, lane), wo = loadVectors(packet->wo, lane);
    const SummaryBetween<Vf> own = summaryBetween(table, dot(n, wo), n, wo);
    storeVectors(own.diffuse, lane, &packet->diffuse);
    storeVectors(own.glossy, lane, &packet->glossy);
    storeVectors(own.mirror, lane, &packet->mirror);
    storeVectors(own.r, lane, &packet->r);
    for (int j = 0; j < table.lobeCount; ++j) {
      const LobeBetween<Vf> lobe = lobeBetween(table, j, own, n);
      storeVectors(lobe.axis, lane, &packet->lobes[j].axis);
      storeVectors(lobe.alpha, lane, &packet->lobes[j].alpha);
      lobe.kappa.store(packet->lobes[j].kappa.at + lane);
    }
  }
  packet->lobeCount = table.lobeCount;
}

LOBELIA_CORE_END

#endif  // per-target include guard
