#include "lobelia/app/preview_rows.h"

#include <numeric>

namespace lobelia::app {

void previewRows(FilmPreview& preview, const Film& film, const RenderOptions& options, int y0,
                 int y1, float scale) {
  const size_t width = static_cast<size_t>(film.width);
  const size_t begin = static_cast<size_t>(y0) * width, end = static_cast<size_t>(y1) * width;
  std::vector<uint32_t> pixels(end - begin);
  std::iota(pixels.begin(), pixels.end(), static_cast<uint32_t>(begin));
  std::vector<Rgb> values(pixels.size());
  for (size_t i = 0; i < values.size(); ++i) {
    if (options.component != "indirect") values[i] += film.rgb(begin + i, "direct") * scale;
    if (options.component != "direct") values[i] += film.rgb(begin + i, "indirect") * scale;
  }
  preview.update(pixels, values);
}

}  // namespace lobelia::app
