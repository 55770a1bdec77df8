// Tables of reflectance made from BSDFs.
#pragma once

#include "lobelia/base/parallel.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/bsdf/tabulated_brdf.h"

namespace lobelia::test {

inline TabulatedBrdf tabulate(const Bsdf& bsdf) {
  TabulatedBrdf table;
  parallelFor(TabulatedBrdf::kThetaH, 1, [&](size_t row) {
    const int h = static_cast<int>(row);
    for (int d = 0; d < TabulatedBrdf::kThetaD; ++d) {
      for (int p = 0; p < TabulatedBrdf::kPhiD; ++p) {
        const DirectionPair pair = toDirections(TabulatedBrdf::centre(h, d, p));
        if (!(pair.wo.z > 1e-4f && pair.wi.z > 1e-4f)) continue;
        table.values[TabulatedBrdf::index(h, d, p)] = evaluate(bsdf, pair.wo, pair.wi) / pair.wi.z;
      }
    }
  });
  countInvalid(table);
  return table;
}

}  // namespace lobelia::test
