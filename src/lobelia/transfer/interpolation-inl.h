// Lobes between directions and vertices, light looked up, tables by elevation: for one pixel or a
// register of pixels. What the numbers mean is said at the classes that hold them (lobe_sum.h,
// visible_part.h, prefiltered_light.h, reflection_table.h).
#if defined(LOBELIA_TRANSFER_INTERPOLATION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_TRANSFER_INTERPOLATION_INL_H_
#undef LOBELIA_TRANSFER_INTERPOLATION_INL_H_
#else
#define LOBELIA_TRANSFER_INTERPOLATION_INL_H_
#endif

#include "lobelia/base/core-inl.h"
#include "lobelia/transfer/elevation_rows.h"

LOBELIA_CORE_BEGIN

// v turned by the smallest rotation that takes `from` to `to`, both unit: half a turn about `from`,
// then one about the direction midway, or where there is none about any across.
template <class F>
LOBELIA_HD V3<F> turnedWith(V3<F> v, V3<F> from, V3<F> to) {
  V3<F> midway = from + to;
  F length2 = dot(midway, midway);
  const auto opposite = length2 < F(1e-8f);
  if (any(opposite)) {
    const auto steep = abs(from.z) > F(0.7f);
    const F zero(0.f);
    const V3<F> across{select(steep, zero, from.y), select(steep, from.z, zero - from.x),
                       select(steep, zero - from.y, zero)};
    midway = {select(opposite, across.x, midway.x), select(opposite, across.y, midway.y),
              select(opposite, across.z, midway.z)};
    length2 = select(opposite, dot(across, across), length2);
  }
  const V3<F> once = from * (F(2.f) * dot(from, v)) - v;
  return midway * (F(2.f) * dot(midway, once) / length2) - once;
}

// Sums over lobes, weighted by energy.
template <class F>
struct LobeTotals {
  V3<F> moment, mirrors;  // of r; of the mirror directions
  F lengths, energy;      // of |r|; > 0
};
// |r| of the lobe between them; its axis is the moment's. moment: length of totals.moment.
// magnification2: LobeSum::kMagnification squared.
template <class F>
LOBELIA_HD F resultantBetween(const LobeTotals<F>& totals, F moment, F magnification2) {
  const F mean = totals.lengths / totals.energy;
  const F apart = max(F(0.f), F(1.f) - sqrt(dot(totals.mirrors, totals.mirrors)) / totals.energy);
  return min(mean, moment / totals.energy + mean * magnification2 * apart);
}

// Width of what is visible between parts (VisiblePart::width): parts on different sides of what is
// in the way make a wider lobe; for narrow ones 1 - |r| is 1 / kappa. widths, axes: sums by energy
// of widths and of axes, of the latter the length; kappa: of the unoccluded lobe.
template <class F>
LOBELIA_HD F widthBetween(F widths, F axes, F energy, F kappa) {
  return widths / energy + kappa * max(F(0.f), F(1.f) - axes / energy);
}

// kappaOfResultant() with its table of corrections, of `cells` cells and one more.
template <class F>
LOBELIA_HD F kappaByTable(F resultant, const float* corrections, float cells, float most) {
  const F r = max(min(resultant, F(1.f)), F(0.f));
  const F at = r * F(cells);
  const F cell = floor(at), share = at - cell;
  const F correction =
      gather(corrections, cell) * (F(1.f) - share) + gather(corrections, cell + F(1.f)) * share;
  const F banerjee = correction * r * (F(3.f) - r * r) / max((F(1.f) - r) * (F(1.f) + r), F(1e-7f));
  return min(banerjee, F(most));
}

// Of a cube's faces, by coordinates nearly proportional to angles (cube_map.h).
template <class F>
struct CubeSpot {
  F face, x, y;
};
template <class F>
LOBELIA_HD F warpedTangent(F t) {
  const F q = t * t;
  return t * (F(1.2664f) - q * (F(0.3674f) - q * F(0.101f)));
}
// d: not zero, of any length.
template <class F>
LOBELIA_HD CubeSpot<F> cubeSpot(V3<F> d) {
  const F x = abs(d.x), y = abs(d.y), z = abs(d.z);
  const auto onX = (x >= y) && (x >= z);
  const auto onY = y >= z;
  const F major = select(onX, d.x, select(onY, d.y, d.z));
  const F u = select(onX, d.y, select(onY, d.z, d.x)), v = select(onX, d.z, select(onY, d.x, d.y));
  const F face = select(onX, F(0.f), select(onY, F(2.f), F(4.f)));
  return {face + select(major < F(0.f), F(1.f), F(0.f)), warpedTangent(u / abs(major)),
          warpedTangent(v / abs(major))};
}

// The first of four texels around a spot and how far it is to the others.
template <class F>
struct TexelPlace {
  F index, u, v;
};
// size: texels along an edge of a face, with a border of one beyond each. In bounds whatever the
// spot is.
template <class F>
LOBELIA_HD TexelPlace<F> texelPlace(const CubeSpot<F>& spot, F size) {
  const F half = F(0.5f) * (size - F(2.f)), last = size - F(2.f);
  const F x = (spot.x + F(1.f)) * half + F(0.5f), y = (spot.y + F(1.f)) * half + F(0.5f);
  const F column = max(min(floor(x), last), F(0.f)), row = max(min(floor(y), last), F(0.f));
  return {(spot.face * size + row) * size + column, x - column, y - row};
}

// Level of a lobe among those of kappa sharpest / 2^(level / perOctave), not a whole number.
template <class F>
LOBELIA_HD F levelOfKappa(F kappa, float sharpest, float perOctave, float last) {
  constexpr float kPerLog = 1.44269504f;
  const F level = F(perOctave * kPerLog) * log(F(sharpest) / max(kappa, F(1e-6f)));
  return max(min(level, F(last)), F(0.f));
}

// Nodes of a table by elevation: which two, and how far from the first.
template <class F>
struct ElevationPlace {
  F node, t;
};
template <class F>
LOBELIA_HD ElevationPlace<F> elevationPlace(F cosine, float nodes) {
  const F x = sqrt(max(min(cosine, F(1.f)), F(0.f))) * F(nodes - 1);
  const F node = min(floor(x), F(nodes - 2));
  return {node, x - node};
}
// Number `column` of the nodes' rows, `stride` long, between the two.
template <class F>
LOBELIA_HD F betweenNodes(const float* rows, float stride, float column, ElevationPlace<F> place) {
  const F at = place.node * F(stride) + F(column);
  return gather(rows, at) * (F(1.f) - place.t) + gather(rows, at + F(stride)) * place.t;
}

template <class F>
struct SummaryBetween {
  ElevationPlace<F> place;
  V3<F> diffuse, glossy, mirror, r;
};
// cosine: of n, on wo's side, and wo; > 0.
template <class F>
LOBELIA_HD SummaryBetween<F> summaryBetween(const transfer::ElevationRows& rows, F cosine, V3<F> n,
                                            V3<F> wo) {
  SummaryBetween<F> out;
  out.place = elevationPlace(cosine, static_cast<float>(rows.nodeCount));
  const auto at = [&](float column) {
    return betweenNodes(rows.nodes, transfer::ElevationRows::kNodeStride, column, out.place);
  };
  out.diffuse = {at(0), at(1), at(2)};
  out.glossy = {at(3), at(4), at(5)};
  out.mirror = n * (F(2.f) * cosine) - wo;
  out.r = out.mirror * at(6) + n * at(7);
  return out;
}
template <class F>
struct LobeBetween {
  V3<F> axis;
  F kappa;
  V3<F> alpha;
};
template <class F>
LOBELIA_HD LobeBetween<F> lobeBetween(const transfer::ElevationRows& rows, int lobe,
                                      const SummaryBetween<F>& summary, V3<F> n) {
  constexpr int kStride = transfer::ElevationRows::kLobeStride;
  const auto stride = static_cast<float>(kStride * rows.lobeCount);
  const auto at = [&](float column) {
    return betweenNodes(rows.lobes + kStride * lobe, stride, column, summary.place);
  };
  const V3<F> axis = summary.mirror * at(0) + n * at(1);
  const F width = at(2);
  return {axis * (F(1.f) / sqrt(dot(axis, axis))), F(1.f) / (width * width), {at(3), at(4), at(5)}};
}

LOBELIA_CORE_END

#endif  // per-target include guard
