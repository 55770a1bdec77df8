// The SIMD targets that this processor has, one at a time.
#pragma once

#include <hwy/highway.h>

#include <cstdint>
#include <vector>

namespace lobelia::test {

// Of files that leave out SSSE3; the baseline is always among them.
inline std::vector<int64_t> usableTargets() {
  std::vector<int64_t> targets;
  const int64_t usable = hwy::SupportedTargets() & HWY_TARGETS & ~HWY_SSSE3;
  for (int64_t left = usable; left != 0; left &= left - 1) targets.push_back(left & -left);
  return targets;
}

// Makes the next dispatch choose one target; all of the processor's again at the end.
class OnlyTarget {
 public:
  explicit OnlyTarget(int64_t target) {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(target);
  }
  ~OnlyTarget() {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
};

}  // namespace lobelia::test
