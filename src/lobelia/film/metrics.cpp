#include "lobelia/film/metrics.h"

#include <fmt/format.h>

#include "lobelia/base/error.h"

namespace lobelia {
namespace {

void requireSameWindow(const Film& a, const Film& b, const char* what) {
  if (a.width == b.width && a.height == b.height && a.x0 == b.x0 && a.y0 == b.y0) return;
  throw InputError({},
                   fmt::format("the {} is {}x{} at ({},{}) but the image is {}x{} at ({},{}); "
                               "compare images of the same size and crop",
                               what, b.width, b.height, b.x0, b.y0, a.width, a.height, a.x0, a.y0));
}

bool isPresent(const Film& film, size_t i) { return film.alpha.empty() || film.alpha[i] > 0.5f; }

// FLIP needs neighbourhoods: all pixels of both images present and finite.
std::optional<double> meanFlip(const Film& image, const Film& reference, const Film* mask) {
  if (mask != nullptr) return {};
  for (size_t i = 0; i < image.pixelCount(); ++i) {
    if (!isPresent(image, i) || !isPresent(reference, i)) return {};
  }
  const std::vector<float> map = flipMap(image, reference);
  double sum = 0;
  for (float v : map) sum += v;
  return sum / static_cast<double>(map.size());
}

}  // namespace

Comparison compare(const Film& image, const Film& reference, const Film* reference2,
                   const Film* mask) {
  requireSameWindow(image, reference, "reference");
  if (reference2 != nullptr) requireSameWindow(image, *reference2, "second reference");
  if (mask != nullptr) requireSameWindow(image, *mask, "mask");
  Comparison r;
  double square = 0, relative = 0, absolute = 0, cross = 0, norm = 0, sumA = 0, sumB = 0;
  uint64_t values = 0;
  for (size_t i = 0; i < image.pixelCount(); ++i) {
    if (!isPresent(image, i) || !isPresent(reference, i)) continue;
    if (reference2 != nullptr && !isPresent(*reference2, i)) continue;
    if (mask != nullptr && !(mask->rgb(i).x > 0.5f)) continue;
    ++r.pixels;
    const Rgb a3 = image.rgb(i), b3 = reference.rgb(i);
    const Rgb b23 = reference2 != nullptr ? reference2->rgb(i) : b3;
    for (int c = 0; c < 3; ++c) {
      const double a = a3[c], b = b3[c], b2 = b23[c];
      if (!std::isfinite(a) || !std::isfinite(b) || !std::isfinite(b2)) {
        ++r.nonfinite;
        continue;
      }
      ++values;
      square += (a - b) * (a - b);
      relative += (a - b) * (a - b) / (b * b + 1e-2);
      absolute += std::abs(a - b);
      cross += (a - b) * (a - b2);
      norm += b * b2;
      sumA += a;
      sumB += b;
    }
  }
  if (values == 0) {
    throw InputError({}, "the images have no finite pixel in common; nothing can be compared");
  }
  const double n = static_cast<double>(values);
  r.rmse = std::sqrt(square / n);
  r.relmse = relative / n;
  // The cross product of two independent references estimates the squared error without their
  // noise; an estimate below zero means an error below what the references can show.
  r.l2 = norm > 0 ? std::sqrt(std::max(cross, 0.) / norm) : (square > 0 ? INFINITY : 0);
  r.mae = absolute / n;
  r.meanRatio = sumB != 0 ? sumA / sumB : (sumA == 0 ? 1 : INFINITY);
  r.flip = r.nonfinite == 0 ? meanFlip(image, reference, mask) : std::nullopt;
  return r;
}

}  // namespace lobelia
