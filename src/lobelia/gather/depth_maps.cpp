#include "lobelia/gather/depth_maps.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <optional>

#include "lobelia/base/parallel.h"
#include "lobelia/gather/light_block.h"

namespace lobelia::gather {
namespace {

constexpr int kSide = 4;  // texels of a packet
static_assert(kSide * kSide == ShadowPacket::kSize);

class MapRays {
 public:
  MapRays(const Tracer& tracer, const PreparedGaussian& light, int place, int texels, float* depths)
      : tracer_(tracer),
        end_(light.ends[place]),
        normal_(light.diffuse.axis),
        // Half a texel more than light leaves by: looks may be anywhere in it.
        least_(-light.facingSine - 4.f / static_cast<float>(texels)),
        texels_(texels),
        depths_(depths) {}

  uint64_t run() {
    for (int row = 0; row < texels_; row += kSide)
      for (int column = 0; column < texels_; column += kSide) packet(row, column);
    return rays_;
  }

 private:
  void packet(int row, int column) {
    ShadowPacket packet;
    float* out[ShadowPacket::kSize] = {};
    bool any = false;
    for (int lane = 0; lane < ShadowPacket::kSize; ++lane) {
      const int y = row + lane / kSide, x = column + lane % kSide;
      packet.active[lane] = 0;
      if (y >= texels_ || x >= texels_) continue;
      const float step = 2.f / static_cast<float>(texels_);
      const Vec3f w = normalize(octahedralDirection((static_cast<float>(x) + 0.5f) * step - 1,
                                                    (static_cast<float>(y) + 0.5f) * step - 1));
      if (dot(normal_, w) < least_) continue;
      packet.set(lane, Ray{end_, w, 0, std::numeric_limits<float>::max()});
      out[lane] =
          &depths_[static_cast<size_t>(y) * static_cast<size_t>(texels_) + static_cast<size_t>(x)];
      any = true;
      ++rays_;
    }
    if (!any) return;
    std::optional<Hit> hits[ShadowPacket::kSize];
    tracer_.intersect(packet, true, hits);
    for (int lane = 0; lane < ShadowPacket::kSize; ++lane)
      if (out[lane] != nullptr)
        *out[lane] = hits[lane] ? hits[lane]->t : std::numeric_limits<float>::infinity();
  }

  const Tracer& tracer_;
  const Vec3f end_, normal_;
  const float least_;
  const int texels_;
  float* depths_;
  uint64_t rays_ = 0;
};

}  // namespace

Vec3f octahedralDirection(float u, float v) {
  const float z = 1 - std::abs(u) - std::abs(v);
  const float fold = std::max(-z, 0.f);
  return {u - std::copysign(fold, u), v - std::copysign(fold, v), z};
}

DepthMaps::DepthMaps(const Tracer& tracer, const VirtualLights& lights, int texels,
                     const Context& context)
    : texels_(texels) {
  depths_.assign(first(lights.gaussian.size(), 0), 0.f);
  std::atomic<uint64_t> rays{0};
  parallelFor(lights.gaussian.size(), 1, [&](size_t i) {
    if (context.cancelled()) return;
    const PreparedGaussian light = prepareGaussian(lights.gaussian[i], lights.gaussianShading);
    for (int place = 0; place < GaussianLight::kPlaces; ++place)
      rays += MapRays(tracer, light, place, this->texels(place), &depths_[first(i, place)]).run();
  });
  rays_ = rays;
}

}  // namespace lobelia::gather
