// Rays in the orders in which they are traced, prepared for bare loops (trace/bare_rays.h).
#pragma once

#include <vector>

#include "lobelia/lights/virtual_lights.h"
#include "lobelia/path/path_tracer.h"
#include "lobelia/path/receivers.h"
#include "lobelia/trace/bare_rays.h"

namespace lobelia::app {

struct PointNormal {
  Vec3f p, n;  // p is off its surface already
};
std::vector<PointNormal> places(const VirtualLights& lights);  // of the diffuse and glossy ones

// Whole runs of neighbours, spread over `receivers`; about `count` points in all.
Receivers spreadReceivers(const Receivers& receivers, size_t count);

using Packets = std::vector<ShadowPacket>;
// Random points to random lights; here and below, only pairs that face each other.
Packets randomToRandom(const std::vector<PointNormal>& places, size_t packets, uint64_t seed);
// One point after another to the lights along a Morton curve.
Packets pointToSorted(std::vector<PointNormal> places, size_t packets, uint64_t seed);
// Receivers in their order to a few lights, one by one, as gatherAll() traces them where lights lie
// further apart than neighbouring receivers (gather/visibility-inl.h).
Packets tileToLights(std::span<const ReceiverPoint> tile, std::span<const PointNormal> lights);
// To each light from a receiver drawn at random, as shared stochastic cuts trace rays that answer
// for a cluster (gather/chosen_gather.h); pairs that do not face each other are left out.
Packets oneToEachLight(std::span<const ReceiverPoint> tile, std::span<const PointNormal> lights,
                       uint64_t seed);

// The rays of path tracing width x height pixels of a camera, tile by tile in the order in which
// renderPath() traces them.
std::vector<TracedRays> recordPathRays(const Tracer& tracer, const EmitterSampler& emitters,
                                       const Camera& camera, const PathSettings& settings,
                                       uint64_t seed);

}  // namespace lobelia::app
