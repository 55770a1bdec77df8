// Are two parts of a scene the same? What designs leave out (internal to io).
#pragma once

#include "lobelia/scene/scene.h"

namespace lobelia::io::mitsuba {

// All that is inside counts, names do not. Textures are the same when their handles are.
bool sameMaterial(const std::vector<Material>& a, MaterialHandle x, const std::vector<Material>& b,
                  MaterialHandle y);
bool sameEmitter(const Emitter& a, const Emitter& b);
// Without a lens it does not count where it would focus.
bool sameCamera(const Camera& a, const Camera& b);

}  // namespace lobelia::io::mitsuba
