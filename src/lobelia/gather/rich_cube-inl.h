// The half of a cube map that lies above a plane: where a direction meets its texels.
//
// Five faces in local directions (z: the plane's normal): +z whole, n x n texels, then +x, -x, +y
// and -y, of which n x n/2 are above the plane. Between the middles of four texels of a face values
// are bilinear; at its edges the last ones go on.
#if defined(LOBELIA_GATHER_RICH_CUBE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_RICH_CUBE_INL_H_
#undef LOBELIA_GATHER_RICH_CUBE_INL_H_
#else
#define LOBELIA_GATHER_RICH_CUBE_INL_H_
#endif

#include "lobelia/base/core-inl.h"

LOBELIA_CORE_BEGIN

// Texels as whole numbers in F: `first`, the next of its row, and the two below (+ n).
template <class F>
struct CubeTaps {
  F first;
  F across, down;  // in [0, 1]: weights of the second column, of the second row
};

// d: local, z >= 0, not 0 but of any length. n: texels along an edge, even, at least 4.
template <class F>
LOBELIA_HD CubeTaps<F> cubeTaps(V3<F> d, float n) {
  const F ax = abs(d.x), ay = abs(d.y), zero(0.f);
  const auto top = (d.z >= ax) & (d.z >= ay);
  const auto alongX = ax >= ay;
  const F inverse = F(1.f) / select(top, d.z, max(ax, ay));
  const F u = select(top, d.x, select(alongX, d.y, d.x)) * inverse;
  const F v = select(top, d.y, d.z) * inverse;
  const F half(0.5f * n);
  const F rows = select(top, F(n), half);
  const F x = min(max((u + F(1.f)) * half - F(0.5f), zero), F(n - 1));
  const F y = min(max(select(top, v + F(1.f), v) * half - F(0.5f), zero), rows - F(1.f));
  const F column = min(floor(x), F(n - 2)), row = min(floor(y), rows - F(2.f));
  const F side =
      select(alongX, select(d.x < zero, F(1.f), zero), select(d.y < zero, F(3.f), F(2.f)));
  const F face = select(top, zero, F(n * n) + side * F(0.5f * n * n));
  return {face + row * F(n) + column, x - column, y - row};
}

LOBELIA_CORE_END

#endif  // per-target include guard
