// Light of local sources at a few points at once: shadow rays in packets, one for each point, from
// all points to one place of a source.
#pragma once

#include <bit>
#include <span>

#include "lobelia/path/direct_light.h"
#include "lobelia/relight/local_sources.h"

namespace lobelia::relight {

// Where light is asked for.
struct LitPoint {
  Vec3f p, ng;
  float error = 0;  // SurfacePoint::error
  Vec2f numbers{};  // in [0, 1): which places of area emitters
  bool asked = true;
};

// Of up to 16 points. worth(i, wi, value, point): what `value`, irradiance across the direction wi,
// is worth at point i, and whether it is from a point-like source; sums[i] grows by it where
// nothing is in the way. areaPlaces: of each area emitter, >= 1; they follow a lattice from the
// point's numbers on. Returns the rays traced.
template <class Worth>
uint64_t addLocalLight(const Tracer& tracer, const LocalSources& sources,
                       std::span<const LitPoint> points, int areaPlaces, std::span<Rgb> sums,
                       const Worth& worth) {
  uint64_t rays = 0;
  for (size_t source = 0; source < sources.count(); ++source) {
    const int places = sources.isPoint(source) ? 1 : areaPlaces;
    const float each = 1 / static_cast<float>(places);
    for (int k = 0; k < places; ++k) {
      ShadowPacket packet{};
      Rgb values[ShadowPacket::kSize];
      bool any = false;
      for (size_t i = 0; i < points.size(); ++i) {
        const LitPoint& point = points[i];
        if (!point.asked) continue;
        const Vec3f u = directLightNumbers({0, point.numbers.x, point.numbers.y}, k, places);
        const auto light = sources.sample(source, point.p, {u.y, u.z});
        if (!light) continue;
        values[i] = worth(i, light->wi, light->value * each, sources.isPoint(source));
        if (values[i] == Rgb{}) continue;
        packet.set(static_cast<int>(i), offsetOrigin(point.p, point.ng, point.error, light->wi),
                   light->target);
        any = true, ++rays;
      }
      if (!any) continue;
      for (uint32_t seen = tracer.visible(packet, true); seen != 0; seen &= seen - 1) {
        const auto i = static_cast<size_t>(std::countr_zero(seen));
        sums[i] += values[i];
      }
    }
  }
  return rays;
}

}  // namespace lobelia::relight
