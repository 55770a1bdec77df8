// Masks (opacity below one) by Embree's filter functions; private to the room.
#pragma once

#include "lobelia/trace/embree_api.h"

namespace lobelia::embree {

// For geometry whose material can let rays pass; its user pointer must be the Scene. Accepts a hit
// with the probability of the opacity there, decided by a hash of the ray's origin and direction,
// the instance and the triangle: the same ray has the same answer in every kind of query.
void filterMask(const RTCFilterFunctionNArguments* arguments);

}  // namespace lobelia::embree
