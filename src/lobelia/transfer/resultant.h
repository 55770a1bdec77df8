// kappa of a vMF lobe by its mean resultant, at the price of a few multiplications.
#pragma once

namespace lobelia::transfer {

// r: mean resultant, in [0, 1); at most kMostKappa. Banerjee's formula [P002 eq. 3], which errs by
// 5 %, times a tabulated correction: relative error below 1e-4.
float kappaOfResultant(float r);

}  // namespace lobelia::transfer
