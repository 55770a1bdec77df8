// Named refractive indices of dielectrics and conductors, by the names that Mitsuba's scenes use.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia::io {

// Index of refraction at 589 nm; names are not case-sensitive ("bk7", "air", "water ice").
std::optional<float> namedIor(std::string_view name);
std::vector<std::string> namedIors();

// Complex index eta - i k as linear sRGB triples.
struct ConductorConstants {
  Rgb eta, k;
};
// "none" is the perfect mirror (eta 0, k 1). A suffix "_palik" names the data of Palik's handbook,
// which are what most names stand for anyway.
std::optional<ConductorConstants> namedConductor(std::string_view name);
std::vector<std::string> namedConductors();

}  // namespace lobelia::io
