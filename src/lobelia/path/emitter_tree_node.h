// A node of EmitterTree, and what is done with many of them: for every SIMD target in
// emitter_tree_kernels.cpp, chosen at run time; bit by bit the same for all.
#pragma once

#include <cstdint>

#include "lobelia/base/vec.h"

namespace lobelia {

// Eight clusters side by side: three levels of a binary tree. Of each its bounding sphere, whose
// radius is half the box's diagonal, its cone (axis in units of 1 / 32767, cosines in units of
// 1 / 127, rounded down: cones are never too narrow by them) and its intensity, 0 where there is
// none.
struct alignas(64) EmitterTreeNode {
  static constexpr int kBits = 3, kWidth = 1 << kBits;
  static constexpr uint32_t kLeafBit = 0x80000000u;
  float x[kWidth], y[kWidth], z[kWidth], radius[kWidth], intensity[kWidth];
  uint32_t next[kWidth];  // of a cluster that is divided its node; kLeafBit and the light
  int16_t axisX[kWidth], axisY[kWidth], axisZ[kWidth];
  int8_t cosThetaO[kWidth], cosThetaE[kWidth];
};
static_assert(sizeof(EmitterTreeNode) == 256);

// How little of its cosine an emitter is taken to send at least, and the slack of quantised axes.
inline constexpr float kLeastCosine = 1e-3f;

// From a root down; n, u: as EmitterTree::sample(). The light chosen, and the probability, 0 when
// nothing is expected to arrive.
struct EmitterTreeChoice {
  uint32_t light = 0;
  float probability = 0;
};
EmitterTreeChoice sampleEmitterTree(const EmitterTreeNode* nodes, Vec3f p, Vec3f n, double u);
// slots: below a leading one, kBits for each node on the way.
float emitterTreeProbability(const EmitterTreeNode* nodes, Vec3f p, Vec3f n, uint64_t slots);

}  // namespace lobelia
