// The slices that frames of some cameras look up: three of each vertex' hundreds for a
// camera, which is what of transfer has to be made where nothing but these frames is to be judged.
#pragma once

#include <span>
#include <vector>

#include "lobelia/scene/camera.h"
#include "lobelia/transfer/slice_lookup.h"

namespace lobelia::transfer {

// By vertex, then direction to the eye.
using SliceMask = std::vector<bool>;

// lookup: of these data; both sides of vertices count, whether the cameras see them or not.
SliceMask seenSlices(const SliceLookup& lookup, const TransferData& data,
                     std::span<const Camera> cameras);

}  // namespace lobelia::transfer
