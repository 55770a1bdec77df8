// Which of Highway's targets the gather's kernels run on.
#pragma once

#include <string>

namespace lobelia {

// Its name. The kernels take sums in the order of its lanes, so that it decides about last bits.
std::string simdTarget();

}  // namespace lobelia
