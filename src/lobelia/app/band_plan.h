// How a picture with virtual lights is cut into pieces of work: samples, bands of rows, runs of
// receivers. By scene and settings alone, so that every run, resumed or replayed, works on the same
// pieces and gets the same bits.
#pragma once

#include "lobelia/app/light_sets.h"
#include "lobelia/film/film.h"
#include "lobelia/gather/gather.h"

namespace lobelia::app {

struct BandPlan {
  EyeSettings eye;
  GatherSettings gather;
  int sets = 1;      // of lights
  int bandRows = 8;  // rows whose receivers are traced at once
  int bands = 1;

  std::pair<int, int> rows(int band, const Film& film) const {
    return {band * bandRows, std::min((band + 1) * bandRows, film.height)};
  }
  int set(int sample) const { return lightSetOf(sample, eye.sampleCount, sets); }
};

// lights: of the first set.
BandPlan planBands(const Tracer& tracer, const PixelSet& pixels, int maxDepth, size_t lights,
                   const RenderOptions& options, const Film& film);

// How many receivers are gathered at once: some seconds of work.
size_t runLength(size_t lights);
// Receivers [begin, end), alone.
Receivers slice(const Receivers& all, size_t begin, size_t end);

}  // namespace lobelia::app
