// Gauss-Legendre rules.
#pragma once

#include <vector>

namespace lobelia {

// Nodes in (0, 1) and weights that sum to one.
struct GaussRule {
  std::vector<double> nodes, weights;
};
GaussRule gaussLegendre(int n);

}  // namespace lobelia
