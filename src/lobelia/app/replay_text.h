// What the replays of all methods print alike.
#pragma once

#include <fmt/format.h>

#include <string>

#include "lobelia/base/vec.h"
#include "lobelia/film/film.h"

namespace lobelia::app {

// Samples printed unless all are asked for.
inline constexpr int kReplaySamples = 16;

// Nine digits tell any two floats apart.
inline std::string text(Rgb c) {
  return fmt::format("({:.9g} {:.9g} {:.9g}){}", c.x, c.y, c.z, isFinite(c) ? "" : " NOT FINITE");
}
inline std::string place(Vec3f p) { return fmt::format("({:.6g} {:.6g} {:.6g})", p.x, p.y, p.z); }

inline void printPixel(const Film& film, uint32_t pixel, int sampleCount) {
  fmt::print("mean of {} samples: direct {}  indirect {}\n", sampleCount,
             text(film.rgb(pixel, "direct")), text(film.rgb(pixel, "indirect")));
}

}  // namespace lobelia::app
