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
  // Receivers are gathered pixel by pixel: a run has all of a pixel's, and samples of one set of
  // lights, so many at most, are traced together.
  bool wholePixels = false;
  int samplesTogether = 1;

  std::pair<int, int> rows(int band, const Film& film) const {
    return {band * bandRows, std::min((band + 1) * bandRows, film.height)};
  }
  int set(int sample) const { return lightSetOf(sample, eye.sampleCount, sets); }
  // Behind the samples that are traced together from `sample` on.
  int samplesEnd(int sample) const;
  // Into how many such groups the first samples fall.
  int groupsOf(int samples) const;
};

// lights: of the first set.
BandPlan planBands(const Tracer& tracer, const PixelSet& pixels, int maxDepth, size_t lights,
                   const RenderOptions& options, const Film& film);

// How many receivers are gathered at once: some seconds of work.
size_t runLength(size_t lights);
// Where the run that begins with receiver `begin` ends: after `length` of them, or, where pixels
// are kept whole, after the last one's pixel.
size_t endOfRun(const Receivers& receivers, size_t begin, size_t length, const BandPlan& plan);
void append(const Receivers& more, Receivers* all);
// Keeps the order of each pixel's receivers.
void sortByPixel(Receivers* receivers);
// Receivers of the samples from plan.eye.sample on that are traced together, pixel by pixel where
// these are kept whole. trace(eye): those of one sample.
template <class Trace>
Receivers traceTogether(const BandPlan& plan, const Trace& trace) {
  EyeSettings eye = plan.eye;
  Receivers all = trace(eye);
  for (++eye.sample; eye.sample < plan.samplesEnd(plan.eye.sample); ++eye.sample)
    append(trace(eye), &all);
  if (plan.wholePixels) sortByPixel(&all);
  return all;
}
// Receivers [begin, end), alone.
Receivers slice(const Receivers& all, size_t begin, size_t end);

}  // namespace lobelia::app
