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

#include "lobelia/base/prefetch.h"
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
    const float* v = address(x, y);
    return image_->channels < 3 ? Rgb(v[0]) : Rgb(v[0], v[1], v[2]);
  }
  // The unit square: u moved by half a texel, so that cells have texels as corners, and v.
  Cell cellAt(Vec2f s) const;
  Vec2f toSquare(Vec3f unit) const;
  Vec3f fromSquare(Vec2f s) const;
  Rgb at(Vec3f unit) const { return at(cellAt(toSquare(unit))); }
  Rgb at(const Cell& cell) const { return between(texels(cell), cell); }
  struct Texels {  // at a cell's corners
    Rgb c00, c10, c01, c11;
  };
  Texels texels(const Cell& c) const {
    return {texel(c.x0, c.y0), texel(c.x1, c.y0), texel(c.x0, c.y1), texel(c.x1, c.y1)};
  }
  static Rgb between(const Texels& t, const Cell& c) {
    return lerp(lerp(t.c00, t.c10, c.fx), lerp(t.c01, t.c11, c.fx), c.fy);
  }
  void prefetch(int x, int y) const {  // the cell at x, y, but for the last one of a row
    touch(address(x, y)), touch(address(x, y + 1));
  }

 private:
  const float* address(int x, int y) const {
    const size_t row = static_cast<size_t>(std::min(y, image_->height - 1));
    const size_t channels = static_cast<size_t>(image_->channels);
    return image_->pixels.data() +
           (row * static_cast<size_t>(image_->width) + static_cast<size_t>(x)) * channels;
  }
  const Image* image_ = nullptr;
  int rows_ = 0;
};

inline Vec3f fromEmitterAxes(Vec3f d) { return {d.y, d.z, -d.x}; }

}  // namespace lobelia
