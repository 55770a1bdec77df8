// Kinds of lobes, for code that sorts them without evaluating any.
#pragma once

#include "lobelia/bsdf/lobe.h"

namespace lobelia {

// Scatters into single directions; nothing but its own sampling finds them.
constexpr bool isDelta(LobeType type) {
  return type == LobeType::deltaReflection || type == LobeType::deltaTransmission ||
         type == LobeType::null;
}
// Leads to the other side of the surface.
constexpr bool isTransmission(LobeType type) {
  return type == LobeType::microfacetTransmission || type == LobeType::diffuseTransmission ||
         type == LobeType::deltaTransmission || type == LobeType::null ||
         type == LobeType::thinTransmission;
}
// Reflects about evenly in all directions: no spherical Gaussians, but cosine lobes.
constexpr bool isDiffuse(LobeType type) {
  return type == LobeType::lambert || type == LobeType::coatedDiffuse ||
         type == LobeType::principledDiffuse || type == LobeType::sheen;
}

}  // namespace lobelia
