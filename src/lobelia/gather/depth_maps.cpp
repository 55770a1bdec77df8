#include "lobelia/gather/depth_maps.h"

#include <fmt/format.h>
#include <unistd.h>

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

void requireMemory(size_t needed, int texels) {
  const double present =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (static_cast<double>(needed) <= present) return;
  constexpr double kGiB = 1 << 30;
  throw RuntimeError(
      fmt::format("shadow maps of {} texels on a side need {:.0f} GiB for all lights and the "
                  "machine has {:.0f}; "
                  "ask for fewer texels or lights",
                  texels, static_cast<double>(needed) / kGiB, present / kGiB));
}

}  // namespace

Vec3f octahedralDirection(float u, float v) {
  const float z = 1 - std::abs(u) - std::abs(v);
  const float fold = std::max(-z, 0.f);
  return {u - std::copysign(fold, u), v - std::copysign(fold, v), z};
}

size_t DepthMaps::bytes(int texels) {
  const size_t whole = static_cast<size_t>(texels) * static_cast<size_t>(texels);
  const size_t half = static_cast<size_t>(texels / 2) * static_cast<size_t>(texels / 2);
  return sizeof(float) * (whole + (GaussianLight::kPlaces - 1) * half);
}

DepthMaps::DepthMaps(const Tracer& tracer, const VirtualLights& lights, int texels,
                     Context& context)
    : texels_(texels) {
  const StageTimer timer(context, "visibility");
  requireMemory(lights.gaussian.size() * bytes(texels), texels);
  depths_.assign(first(lights.gaussian.size(), 0), 0.f);
  std::atomic<uint64_t> rays{0};
  parallelFor(lights.gaussian.size(), 1, [&](size_t i) {
    if (context.cancelled()) return;
    const PreparedGaussian light = prepareGaussian(lights.gaussian[i], lights.gaussianShading);
    uint64_t own = 0;
    for (int place = 0; place < GaussianLight::kPlaces; ++place)
      own += MapRays(tracer, light, place, this->texels(place), &depths_[first(i, place)]).run();
    rays += own;
  });
  context.statistics.addCount("shadow_rays", rays);
}

}  // namespace lobelia::gather
