#include "lobelia/film/film.h"

namespace lobelia {

Layer& Film::addLayer(const std::string& name, int channels) {
  Layer& layer = layers[name];
  layer.channels = channels;
  layer.values.assign(pixelCount() * static_cast<size_t>(channels), 0.f);
  return layer;
}

Rgb Film::rgb(size_t pixel, const std::string& layer) const {
  const Layer& l = layers.at(layer);
  const float* v = &l.values[pixel * static_cast<size_t>(l.channels)];
  return l.channels >= 3 ? Rgb{v[0], v[1], v[2]} : Rgb(v[0]);
}

uint64_t countNonFinite(const Film& film) {
  uint64_t count = 0;
  for (float v : film.layers.at("").values) count += std::isfinite(v) ? 0 : 1;
  return count;
}

}  // namespace lobelia
