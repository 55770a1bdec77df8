#include "lobelia/app/sampled_film.h"

#include <algorithm>

namespace lobelia::app {

void addTo(Layer& layer, size_t pixel, Rgb value) {
  float* p = &layer.values[pixel * 3];
  p[0] += value.x, p[1] += value.y, p[2] += value.z;
}

void addFields(StateFields& state, Film& film) {
  for (auto& [name, layer] : film.layers) state.add("layer/" + name, layer.values);
}

BandBackup::BandBackup(Film& film, int bandRows) : film_(film) {
  for (const auto& [name, layer] : film.layers) {
    layers_.emplace_back(static_cast<size_t>(bandRows) * static_cast<size_t>(film.width) *
                         static_cast<size_t>(layer.channels));
  }
}

void BandBackup::take(int y0, int y1) {
  size_t i = 0;
  for (const auto& [name, layer] : film_.layers) {
    const ptrdiff_t row = static_cast<ptrdiff_t>(film_.width) * layer.channels;
    std::copy(layer.values.begin() + y0 * row, layer.values.begin() + y1 * row,
              layers_[i++].begin());
  }
}

void BandBackup::restore(int y0, int y1) const {
  size_t i = 0;
  for (auto& [name, layer] : film_.layers) {
    const ptrdiff_t row = static_cast<ptrdiff_t>(film_.width) * layer.channels;
    std::copy_n(layers_[i++].begin(), (y1 - y0) * row, layer.values.begin() + y0 * row);
  }
}

void BandBackup::addFields(StateFields& state) {
  size_t i = 0;
  for (const auto& [name, layer] : film_.layers) state.add("backup/" + name, layers_[i++]);
}

void finishPartial(Film& film, const std::vector<int>& rowSamples, int sampleCount) {
  if (std::all_of(rowSamples.begin(), rowSamples.end(), [&](int n) { return n == sampleCount; }))
    return;
  if (film.alpha.empty()) film.alpha.assign(film.pixelCount(), 1.f);
  const size_t width = static_cast<size_t>(film.width);
  for (size_t y = 0; y < rowSamples.size(); ++y) {
    const int n = rowSamples[y];
    if (n == 0) std::fill_n(film.alpha.begin() + static_cast<ptrdiff_t>(y * width), width, 0.f);
    if (n == 0 || n == sampleCount) continue;
    for (auto& [name, layer] : film.layers) {
      const size_t row = width * static_cast<size_t>(layer.channels);
      for (size_t i = 0; i < row; ++i) {
        layer.values[y * row + i] *= static_cast<float>(sampleCount) / static_cast<float>(n);
      }
    }
  }
}

VarianceMeter::VarianceMeter(Film& film) : film_(film), used_(film.layers.contains("variance")) {
  if (!used_) return;
  previous_.assign(film.pixelCount() * 3, 0.f);
  squares_.assign(film.pixelCount() * 3, 0.);
}

void VarianceMeter::afterSamples(int sampleCount, int count) {
  if (!used_) return;
  const auto& d = film_.layers.at("direct").values;
  const auto& i = film_.layers.at("indirect").values;
  for (size_t k = 0; k < previous_.size(); ++k) {
    const double sample = static_cast<double>(d[k] + i[k] - previous_[k]) * sampleCount;
    squares_[k] += sample * sample / count;
    previous_[k] = d[k] + i[k];
  }
}

// Groups of samples have the variance of one over their number.
void VarianceMeter::finish(const std::vector<int>& rowSamples, const std::vector<int>& rowGroups,
                           int sampleCount) {
  if (!used_) return;
  auto& out = film_.layers.at("variance").values;
  const size_t row = static_cast<size_t>(film_.width) * 3;
  for (size_t k = 0; k < out.size(); ++k) {
    const double n = rowSamples[k / row];
    const int groups = rowGroups[k / row];
    if (groups < 2) continue;
    const double mean = static_cast<double>(previous_[k]) * sampleCount / n;
    out[k] = static_cast<float>(std::max(squares_[k] / n - mean * mean, 0.) / (groups - 1));
  }
}

void VarianceMeter::addFields(StateFields& state) {
  if (!used_) return;
  state.add("variance/previous", previous_);
  state.add("variance/squares", squares_);
}

}  // namespace lobelia::app
