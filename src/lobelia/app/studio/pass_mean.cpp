#include "lobelia/app/studio/pass_mean.h"

#include <algorithm>
#include <cmath>

namespace lobelia::app {
namespace {

double luminanceOf(const double* rgb) {
  return static_cast<double>(luminance(
      Rgb(static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2]))));
}

}  // namespace

void PassMean::add(const Film& pass, int samples) {
  const size_t count = pass.pixelCount();
  if (passes_ == 0) {
    shape_ = pass;
    shape_.layers.clear();
    picture_.assign(3 * count, 0), squares_.assign(count, 0);
    if (pass.layers.contains("cost")) cost_.assign(count, 0);
  }
  for (size_t i = 0; i < count; ++i) {
    const Rgb value = pass.rgb(i);
    if (!isFinite(value)) {
      ++nonFinite_;
      continue;
    }
    for (size_t c = 0; c < 3; ++c)
      picture_[3 * i + c] += static_cast<double>(value[static_cast<int>(c)]) * samples;
    const double y = static_cast<double>(luminance(value));
    squares_[i] += y * y * samples;
  }
  if (!cost_.empty()) {
    const std::vector<float>& cost = pass.layers.at("cost").values;
    for (size_t i = 0; i < count; ++i) cost_[i] += static_cast<double>(cost[i]) * samples;
  }
  ++passes_;
  samples_ += samples;
}

double PassMean::variance(size_t pixel) const {
  const double sum = luminanceOf(&picture_[3 * pixel]), n = samples_;
  return std::max(squares_[pixel] - sum * sum / n, 0.) / (passes_ - 1) / n;
}

double PassMean::relativeError() const {
  if (passes_ < 2) return 0;
  double variances = 0, squares = 0;
  for (size_t i = 0; i < squares_.size(); ++i) {
    const double mean = luminanceOf(&picture_[3 * i]) / samples_;
    variances += variance(i), squares += mean * mean;
  }
  return squares > 0 ? std::sqrt(variances / squares) : 0;
}

Film PassMean::film() const {
  Film film = shape_;
  const double scale = samples_ > 0 ? 1. / samples_ : 0;
  const auto means = [&](const std::vector<double>& sums, std::vector<float>& out) {
    std::transform(sums.begin(), sums.end(), out.begin(),
                   [&](double sum) { return static_cast<float>(sum * scale); });
  };
  means(picture_, film.addLayer("").values);
  if (!cost_.empty()) means(cost_, film.addLayer("cost", 1).values);
  std::vector<float>& samples = film.addLayer("samples", 1).values;
  std::fill(samples.begin(), samples.end(), static_cast<float>(samples_));
  if (passes_ < 2) return film;
  std::vector<float>& error = film.addLayer("error", 1).values;
  for (size_t i = 0; i < error.size(); ++i) error[i] = static_cast<float>(std::sqrt(variance(i)));
  return film;
}

}  // namespace lobelia::app
