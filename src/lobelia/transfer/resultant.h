// kappa of a vMF lobe by its mean resultant, at the price of a few multiplications.
#pragma once

namespace lobelia::transfer {

// r: mean resultant, in [0, 1); at most kMostKappa. Banerjee's formula [P002 eq. 3], which errs by
// 5 %, times a tabulated correction: relative error below 1e-4.
float kappaOfResultant(float r);

// The table, for registers of r: at r = i / kResultantCells, and one beyond the last.
inline constexpr float kResultantCells = 256;
const float* resultantCorrections();

}  // namespace lobelia::transfer
