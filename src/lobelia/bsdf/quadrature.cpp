#include "lobelia/bsdf/quadrature.h"

#include <cmath>

namespace lobelia {

// Roots of the Legendre polynomial by Newton's method from Tricomi's estimate.
GaussRule gaussLegendre(int n) {
  GaussRule rule;
  rule.nodes.resize(static_cast<size_t>(n));
  rule.weights.resize(static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) {
    double x = std::cos(3.14159265358979323846 * (i + 0.75) / (n + 0.5));
    double derivative = 1;
    for (int iteration = 0; iteration < 20; ++iteration) {
      double p0 = 1, p1 = x;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
        p0 = p1, p1 = p2;
      }
      derivative = n * (x * p1 - p0) / (x * x - 1);
      const double step = p1 / derivative;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    // Descending roots: store ascending nodes.
    const size_t at = static_cast<size_t>(n - 1 - i);
    rule.nodes[at] = 0.5 * (x + 1);
    rule.weights[at] = 1 / ((1 - x * x) * derivative * derivative);
  }
  return rule;
}

}  // namespace lobelia
