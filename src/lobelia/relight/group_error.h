// What a node of light may cost the pixels of a tile in accuracy, in registers of groups of pixels;
// compiled for every SIMD target and chosen at run time.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "lobelia/relight/surface_light.h"

namespace lobelia::relight {

// Some pixels that lie close together.
struct PixelGroup {
  Bounds3f box;
  Vec3f normal;    // unit mean of geometric normals on the side of the eye
  float bend = 0;  // sine of what normals deviate from it by; 1 from a right angle on
  // The narrowest of the glossy lobes, around mirror directions: chord (2 sin of half the angle)
  // about the axis that holds its reach at all pixels.
  Vec3f axis;
  float chord = 0;
  float width = 1;  // of the lobe, radians
  float peak = 0;   // over that of a diffuse lobe; 0: there is none
};

// The groups of a tile as structure of arrays.
struct GroupLanes {
  static constexpr size_t kMost = 16;
  explicit GroupLanes(std::span<const PixelGroup> groups);  // at least one, at most kMost
  struct alignas(64) Lane : std::array<float, kMost> {};
  Lane centre[3], half[3], normal[3], bend, axis[3], chord, width, peak, size;
};

// A node as errors are judged by it.
struct NodeShape {
  static constexpr float kReach = 2;  // of an even disc in deviations along an axis
  Vec3f place, normal;                // unit, or zero
  float radius = 0;                   // of an even disc with the node's extent
  float thickness = 0;                // how far its light lies off its middle along its normal
  float tilt = 0;                     // sine of what normals deviate by
  Spread spread;
};

// The largest error that evaluating lobes at a node's place brings to a group, of a node of unit
// power: geometry times (extent over distance + tilt), and more in a glossy lobe. 0 where no group
// can see light of the node. softening: NearLights.
float largestError(const GroupLanes& groups, const NodeShape& node, float softening);

}  // namespace lobelia::relight
