#include "lobelia/relight/distant_light.h"

#include <algorithm>
#include <cmath>

#include "lobelia/base/parallel.h"
#include "lobelia/path/direction_rows.h"
#include "lobelia/path/environment_sampling.h"

namespace lobelia::relight {
namespace {

// Cells of an image are between texels; so many points of each are looked at, and so many cells
// become one power. A single bright texel reaches into the four cells around it, whose points
// together have its light.
struct CellGrid {
  int columns, rows;  // of points
  int perPower;       // points along an edge of one power
  explicit CellGrid(const Image& image) {
    const int cellRows = std::max(image.height - 1, 1);
    const int finer = std::max(
        {1, (kColumns + image.width - 1) / image.width, (kColumns / 2 + cellRows - 1) / cellRows});
    columns = finer * image.width;
    rows = finer * cellRows;
    perPower = std::max(1, std::min(columns / kColumns, rows / (kColumns / 2)));
  }
  static constexpr int kColumns = 512;
};

class ImageLight {
 public:
  ImageLight(const Scene& scene, const Emitter& emitter)
      : environment_(scene, emitter),
        grid_(scene[emitter.image]),
        halfTexel_(0.5f / static_cast<float>(scene[emitter.image].width)),
        toWorld_(emitter.toWorld.to) {}

  std::vector<DirectedPower> powers() const {
    const int across = (grid_.columns + grid_.perPower - 1) / grid_.perPower;
    const int down = (grid_.rows + grid_.perPower - 1) / grid_.perPower;
    std::vector<DirectedPower> out(static_cast<size_t>(across) * static_cast<size_t>(down));
    parallelFor(static_cast<size_t>(down), 1, [&](size_t row) {
      for (int x = 0; x < across; ++x)
        out[row * static_cast<size_t>(across) + static_cast<size_t>(x)] =
            powerOf(x * grid_.perPower, static_cast<int>(row) * grid_.perPower);
    });
    std::erase_if(out, [](const DirectedPower& p) { return p.power == Rgb{}; });
    return out;
  }

 private:
  DirectedPower powerOf(int x0, int y0) const {
    Rgb sum{};
    Vec3f weighted{};
    for (int y = y0; y < std::min(y0 + grid_.perPower, grid_.rows); ++y)
      for (int x = x0; x < std::min(x0 + grid_.perPower, grid_.columns); ++x) {
        float solidAngle;
        const Vec3f d = direction(x, y, &solidAngle);
        const Rgb power = environment_.radiance(d) * solidAngle;
        sum += power;
        weighted += d * std::abs(luminance(power));
      }
    const float size = length(weighted);
    return {size > 0 ? weighted / size : Vec3f(0, 1, 0), sum};
  }

  // Of a point's middle (spherical_image.h has the orientation), and the solid angle of its cell.
  Vec3f direction(int x, int y, float* solidAngle) const {
    const float rows = static_cast<float>(grid_.rows), columns = static_cast<float>(grid_.columns);
    const float phi = ((static_cast<float>(x) + 0.5f) / columns + halfTexel_) * kTwoPi;
    const float theta = (static_cast<float>(y) + 0.5f) / rows * kPi;
    const float sine = std::sin(theta);
    const Vec3f turned =
        toWorld_ * Vec3f(std::sin(phi) * sine, std::cos(theta), -std::cos(phi) * sine);
    const float size = length(turned);
    // cos(y pi / rows) - cos((y + 1) pi / rows), without its cancellation.
    *solidAngle = kTwoPi / columns * 2 * std::sin(0.5f * kPi / rows) * sine * toWorld_.determinant /
                  (size * size * size);
    return turned / size;
  }

  EnvironmentSampler environment_;
  CellGrid grid_;
  float halfTexel_;
  DirectionRows toWorld_;
};

}  // namespace

DistantLight distantLight(const Scene& scene) {
  DistantLight light;
  for (const Emitter& emitter : scene.emitters) {
    const bool image = emitter.type == EmitterType::environment && emitter.image.valid();
    if (image) {
      const std::vector<DirectedPower> more = ImageLight(scene, emitter).powers();
      light.powers.insert(light.powers.end(), more.begin(), more.end());
    } else if (emitter.type == EmitterType::environment || emitter.type == EmitterType::constant) {
      light.everywhere += EnvironmentSampler(scene, emitter).radiance({0, 1, 0});
    } else if (emitter.type == EmitterType::directional || emitter.type == EmitterType::sun) {
      light.powers.push_back({-normalize(emitter.direction), mean(scene, emitter.radiance)});
    }
  }
  return light;
}

}  // namespace lobelia::relight
