// Integration over the sphere by product quadrature, for tests: slow and exact.
#pragma once

#include <cmath>

#include "lobelia/base/frame.h"

namespace lobelia::test {

// Sum over directions of f(w) dw. The pole is at `pole`, around which the rows are denser:
// 1 - cos = 2 s^4 with s uniform, so that lobes as sharp as 10^4 are resolved.
template <class Function>
double integrateSphere(Vec3f pole, int rows, int columns, const Function& f) {
  const Frame frame = frameFromNormal(pole);
  double sum = 0;
  for (int i = 0; i < rows; ++i) {
    const double s = (i + 0.5) / rows;
    const double t = 2 * s * s * s * s, weight = 8 * s * s * s / rows;
    const double sine = std::sqrt(t * (2 - t));
    for (int j = 0; j < columns; ++j) {
      const double phi = 2 * 3.14159265358979323846 * (j + 0.5) / columns;
      const Vec3f local{static_cast<float>(sine * std::cos(phi)),
                        static_cast<float>(sine * std::sin(phi)), static_cast<float>(1 - t)};
      sum += weight * 2 * 3.14159265358979323846 / columns *
             static_cast<double>(f(frame.toWorld(local)));
    }
  }
  return sum;
}

}  // namespace lobelia::test
