// A film that grows sample by sample, row by row: what is taken back when a band of rows is not
// finished, means where rows have fewer samples than others, and the variance of the mean.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "lobelia/base/checkpoints.h"
#include "lobelia/film/film.h"

namespace lobelia::app {

// Adds to a pixel of an RGB layer.
void addTo(Layer& layer, size_t pixel, Rgb value);

// All layers of the film, as state of a render.
void addFields(StateFields& state, Film& film);

// Rows of every layer of a band, to take back what an unfinished band has added.
class BandBackup {
 public:
  BandBackup(Film& film, int bandRows);
  void take(int y0, int y1);
  void restore(int y0, int y1) const;
  void addFields(StateFields& state);

 private:
  Film& film_;
  std::vector<std::vector<float>> layers_;  // in the film's order, for bandRows rows
};

// Samples that every row got, when not all: rows are brought to the mean of what they have.
void finishPartial(Film& film, const std::vector<int>& rowSamples, int sampleCount);

// Variance of the mean over the samples of a pixel, from the picture after each sample. Samples
// that gather the same lights share those lights' error, which does not show in it.
class VarianceMeter {
 public:
  explicit VarianceMeter(Film& film);
  // count: of samples since the last call, whose mean then counts as one value.
  void afterSamples(int sampleCount, int count);
  // rowSamples, rowGroups: how many samples every row got, in how many calls.
  void finish(const std::vector<int>& rowSamples, const std::vector<int>& rowGroups,
              int sampleCount);
  void addFields(StateFields& state);

 private:
  Film& film_;
  bool used_;
  std::vector<float> previous_;
  std::vector<double> squares_;
};

}  // namespace lobelia::app
