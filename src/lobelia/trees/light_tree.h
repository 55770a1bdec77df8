// A binary tree over virtual lights of all classes, for strategies that choose among very many.
//
// A node knows of its lights what an estimate of their contribution to a receiver needs: where they
// are, and the sum of their radiant intensity as a cosine lobe and one spherical Gaussian. Lights
// are told by luminance.
//
// Deviations from [P000 section 4.1]: a tree takes lights of all classes (a light may have both
// lobes); Gaussians merge by their moments, which keep energy and mean direction, where the paper's
// means of sharpness and amplitude lose energy (docs/lobes.md); nodes are split where that leaves
// the least variance, of places and directions, by power, where the paper sorts by its metric.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "lobelia/base/large_pages.h"
#include "lobelia/base/vec.h"

namespace lobelia::trees {

// Normals of this length or less are means of several: light may leave on either side.
inline constexpr float kSpreadNormal = 0.99f;

// A light as the tree takes it.
struct TreeLight {
  Vec3f p;
  float variance = 0;  // mean square of the distance to p of what the light stands for
  float radius = 0;    // within which of p it may seem to be
  Vec3f n{};           // light leaves on this side only; 0: on all; see kSpreadNormal
  float diffuse = 0;   // W/sr along n, by cosine; where n is 0, four times the mean over the sphere
  Vec3f axis{0, 0, 1};  // of the Gaussian
  float sharpness = 0;
  float glossy = 0;  // W: integral of the Gaussian
  bool mostlyGlossy() const { return glossy > kPi * diffuse; }
};

// In preorder: the first child of node i is i + 1.
struct alignas(64) LightNode {  // a cache line
  Vec3f centre;                 // mean of the places, by power
  float variance = 0;           // mean square distance to it
  // Mean by power: its length tells how far the lights' normals agree.
  Vec3f n{};
  float diffuse = 0;
  Vec3f axis{0, 0, 1};
  float sharpness = 0;
  float glossy = 0;
  float radius = 0;   // all lights lie within this distance of the centre
  uint32_t link = 0;  // inner nodes: the right child; leaves: the place of the light
  uint32_t count = 0;
  bool leaf() const { return count == 1; }
};
static_assert(sizeof(LightNode) == 64);

class LightTree {
 public:
  LightTree() = default;
  // numbers: what the lights are called outside. scale: size of the scene, what distances count by
  // against directions. The same for any number of threads. At most 2^31 lights.
  LightTree(const std::vector<TreeLight>& lights, const std::vector<uint32_t>& numbers,
            float scale);

  bool empty() const { return nodes_.empty(); }
  std::span<const LightNode> nodes() const { return nodes_; }
  // Children of an inner node i.
  uint32_t left(uint32_t i) const { return i + 1; }
  uint32_t right(uint32_t i) const { return nodes_[i].link; }
  // Number of the light at a place of the leaves' order.
  uint32_t light(uint32_t place) const { return lights_[place]; }
  const uint32_t* lightAt(uint32_t place) const { return &lights_[place]; }  // for prefetches

 private:
  LargePageVector<LightNode> nodes_;
  std::vector<uint32_t> lights_;
};

}  // namespace lobelia::trees
