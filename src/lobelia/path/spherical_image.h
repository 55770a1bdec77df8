// Images over the sphere of directions: equirectangular, bilinear between texels.
//
// Orientation and interpolation are Mitsuba 3's for environments, so that images agree: u =
// atan2(x, -z) / 2 pi, v = acos(y) / pi; texel centres lie at u = (i + 1/2) / width, periodic, and
// at v = j / (height-1), so that the first and last rows are the poles. A single row of texels is
// repeated.
//
// Goniometric emitters use the same with other names for the axes: their +z is y here, their +x is
// -z, their +y is x (fromEmitterAxes()). So the angle from +z runs down the rows, 0 at the first
// and pi at the last, and column i holds the azimuth (i + 1/2) / width of a turn, from +x towards
// +y.
#pragma once

#include <algorithm>

#include "lobelia/scene/texture.h"

namespace lobelia {

class SphericalImage {
 public:
  struct Cell {  // four neighbouring texels and the position between them
    int x0, x1, y0, y1;
    float fx, fy;
  };

  SphericalImage() = default;
  explicit SphericalImage(const Image& image)  // keeps a reference
      : image_(&image), rows_(image.height > 1 ? image.height - 1 : 8) {}

  int width() const { return image_->width; }
  int rows() const { return rows_; }  // of cells, from pole to pole
  Rgb texel(int x, int y) const {     // y from 0 to rows()
    const size_t row = static_cast<size_t>(std::min(y, image_->height - 1));
    const size_t channels = static_cast<size_t>(image_->channels);
    const float* v = image_->pixels.data() +
                     (row * static_cast<size_t>(image_->width) + static_cast<size_t>(x)) * channels;
    return channels < 3 ? Rgb(v[0]) : Rgb(v[0], v[1], v[2]);
  }
  // The unit square: u moved by half a texel, so that cells have texels as corners, and v.
  Cell cellAt(Vec2f s) const;
  Vec2f toSquare(Vec3f unit) const;
  Vec3f fromSquare(Vec2f s) const;
  Rgb at(Vec3f unit) const { return at(cellAt(toSquare(unit))); }
  Rgb at(const Cell& cell) const;

 private:
  const Image* image_ = nullptr;
  int rows_ = 0;
};

inline Vec3f fromEmitterAxes(Vec3f d) { return {d.y, d.z, -d.x}; }

}  // namespace lobelia
