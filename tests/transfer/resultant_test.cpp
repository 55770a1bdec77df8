#include "lobelia/transfer/resultant.h"

#include <gtest/gtest.h>

#include "lobelia/lobes/spherical_gaussian.h"
#include "lobelia/transfer/slice_record.h"

namespace lobelia::transfer {
namespace {

TEST(Resultant, IsTheInverseOfTheMean) {
  for (float kappa = 0.02f; kappa < 5000; kappa *= 1.07f) {
    const float r = lobes::meanResultant(kappa);
    // Near one a float's last bit is more than the formula's error.
    const float tolerance = 2e-4f + 2e-7f * kappa;
    EXPECT_NEAR(kappaOfResultant(r) / kappa, 1, tolerance) << kappa;
  }
}

TEST(Resultant, HasEnds) {
  EXPECT_EQ(kappaOfResultant(0), 0);
  EXPECT_EQ(kappaOfResultant(-1), 0);
  EXPECT_EQ(kappaOfResultant(1), kMostKappa);
  EXPECT_EQ(kappaOfResultant(2), kMostKappa);
}

}  // namespace
}  // namespace lobelia::transfer
