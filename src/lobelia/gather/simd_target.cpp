#include "lobelia/gather/simd_target.h"

#include <hwy/targets.h>

namespace lobelia {

// Of all that are compiled and that the processor has, the one of the lowest bit is the best.
std::string simdTarget() {
  const int64_t usable = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(usable & -usable);
}

}  // namespace lobelia
