// Pixels for references too costly to render whole: the window is cut into bands, each band into as
// many cells as it shall have pixels, and one pixel is drawn in each cell.
#include <cmath>

#include "lobelia/base/random.h"
#include "lobelia/path/path_tracer.h"

namespace lobelia {

PixelSet spreadPixels(int width, int height, size_t count, uint64_t seed) {
  PixelSet set;
  const size_t w = static_cast<size_t>(std::max(width, 0));
  const size_t h = static_cast<size_t>(std::max(height, 0));
  count = std::min(count, w * h);
  if (count == 0) return set;
  // Bands as high as cells are wide; enough of them that no cell is narrower than a pixel.
  const double ideal =
      std::sqrt(static_cast<double>(count) * static_cast<double>(h) / static_cast<double>(w));
  const size_t fewest = (count + w - 1) / w;
  const size_t bands = std::clamp(static_cast<size_t>(std::lround(ideal)), fewest, h);
  Rng random(seed, 0x70697865);
  set.pixels.reserve(count);
  const auto draw = [&](size_t begin, size_t end) {
    const float x = random.next1D() * static_cast<float>(end - begin);
    return std::min(begin + static_cast<size_t>(x), end - 1);
  };
  for (size_t b = 0; b < bands; ++b) {
    const size_t cells = (b + 1) * count / bands - b * count / bands;
    const size_t y0 = b * h / bands, y1 = (b + 1) * h / bands;
    for (size_t c = 0; c < cells; ++c) {
      const size_t x = draw(c * w / cells, (c + 1) * w / cells);
      set.pixels.push_back(static_cast<uint32_t>(draw(y0, y1) * w + x));
    }
  }
  std::sort(set.pixels.begin(), set.pixels.end());
  return set;
}

void markPixels(Film& film, const PixelSet& pixels) {
  if (pixels.pixels.empty()) return;
  film.alpha.assign(film.pixelCount(), 0.f);
  for (const uint32_t pixel : pixels.pixels) film.alpha[pixel] = 1;
}

}  // namespace lobelia
