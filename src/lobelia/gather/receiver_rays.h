// Light that receivers find by rays of their own, beside or instead of virtual lights: the loop
// that compensation (compensation.h) and final gathering (final_gather.h) share.
#pragma once

#include <functional>

#include "lobelia/gather/gather.h"

namespace lobelia {

struct ReceiverRaySettings {
  int sample = 0;  // index of the eye sample, of EyeSettings
  int x0 = 0, y0 = 0,
      width = 1;  // of the data window: a pixel's random numbers do not depend on it
  uint32_t onlyPixel = GatherSettings::kAllPixels;  // of which alone the receivers count (--replay)
};

struct ReceiverRayCounts {
  uint64_t pathRays = 0, shadowRays = 0, nonFinite = 0;
};

// Light that a point's lobes scatter to its wo, without the point's weight. stream: of the point's
// random numbers, the same for all samples of its pixel. groups: where the light is added by light
// group; null: not wanted.
using ReceiverLight = std::function<Rgb(const ReceiverPoint& point, uint64_t stream, Rgb* groups,
                                        ReceiverRayCounts* counts)>;

// Adds to radiance[i] the light of receiver point i, times its weight; fills groups and rays of
// parts as gatherAll() does (types stay empty). Counts "path_rays", "shadow_rays", "nonfinite" and
// sets "first_nonfinite_pixel"; books seconds to `stage`. Same seed, same bits with any number of
// threads. When cancelled, some points may have nothing.
void lightReceivers(const Receivers& receivers, const ReceiverRaySettings& settings,
                    const ReceiverLight& light, const char* stage, std::span<Rgb> radiance,
                    Context& context, GatherParts* parts);

}  // namespace lobelia
