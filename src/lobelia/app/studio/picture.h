// A finished picture with what it cost, as the worker hands it to the window. Never changed again:
// shared between threads.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lobelia/film/film.h"

namespace lobelia::app {

struct Picture {
  // Scene-linear RGB in layer ""; where asked for or known: "cost" (cuts: evaluations of lobes for
  // directions, others: rays, per sample), "samples", "error" (standard error of the luminance).
  Film film;
  std::string method;  // "cuts", "transfer", "path"...
  std::string part;    // of light, which the picture has alone (partOf()); "": all of it
  bool quick = false;  // a first look, smaller than what was asked for
  bool white = false;  // of white surfaces (irradiance over pi)
  int passes = 1, samples = 1;
  double seconds = 0;        // of this frame or pass
  double secondsInAll = 0;   // since the picture was begun
  double relativeError = 0;  // estimated (pass_mean.h); 0: not known
  // Time of this frame or pass by stage, the largest first.
  std::vector<std::pair<std::string, double>> parts;
  double framesPerSecond() const { return seconds > 0 ? 1 / seconds : 0; }
};

}  // namespace lobelia::app
