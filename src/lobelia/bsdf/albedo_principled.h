// Directional albedo of the principled diffuse lobe.
#pragma once

#include "lobelia/bsdf/lobe.h"

namespace lobelia {

Rgb principledDiffuseAlbedo(const Lobe& lobe, float cosine);  // cosine > 0; weight included

}  // namespace lobelia
