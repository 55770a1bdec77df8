// Linear least squares with coefficients that are zero or positive.
#pragma once

#include <array>

namespace lobelia {

inline constexpr int kMaxUnknowns = 8;
using Vector8 = std::array<double, kMaxUnknowns>;
using Matrix8 = std::array<Vector8, kMaxUnknowns>;

// Minimises x' A x - 2 b' x over x >= 0 for the first n unknowns (A: the Gram matrix, symmetric and
// positive semi-definite; b: projections of the data), by the active set method of Lawson and
// Hanson 1974, chapter 23. Unknowns that others can stand for may come out as zero.
Vector8 solveNonnegative(const Matrix8& a, const Vector8& b, int n);

}  // namespace lobelia
