// Are two parts of a scene the same? What designs leave out (internal to io).
#pragma once

#include "lobelia/scene/scene.h"

namespace lobelia::io::mitsuba {

// Names do not count. What is wrapped, textures and images are the same when their handles are.
bool sameMaterial(const Material& a, const Material& b);
bool sameEmitter(const Emitter& a, const Emitter& b);
// Without a lens it does not count where it would focus.
bool sameCamera(const Camera& a, const Camera& b);

}  // namespace lobelia::io::mitsuba
