// Node of a hierarchy of lights or of receivers with what bounds of their interaction need, and its
// representative [P000 section 4.1].
//
// Both sides are of one form: places in a box and in a sphere, a cone of normals, and either a
// cosine lobe or Gaussians, whose axes lie in a cone and whose sharpnesses lie in a range. Lights
// add up; of receivers the strongest and the weakest count.
//
// Corrections of the paper's equation 6 and deviations: the representative's Gaussian has the
// energy and the mean direction of all (moments, docs/lobes.md), where the printed mean of
// amplitudes loses energy and the mean of axes grows too sharp; its place is the mean by power (of
// receivers: by number). A merged normal is the mean of the children's. Several Gaussians of one
// item share a leaf. Amounts are luminances on the lights' side and largest components of the
// colour on the receivers', whose product is never below the luminance of the colours' product; the
// paper does not say how colours count.
#pragma once

#include <cstdint>

#include "lobelia/trees/cone.h"

namespace lobelia::trees {

// A light or a lobe of a receiver.
struct BoundItem {
  Vec3f p;
  float radius = 0;       // within which of p it is
  Vec3f n{};              // it has light on this side only; 0: on all
  float cosine = 0;       // amplitude of the cosine lobe along n; of lights on all sides: intensity
  int gaussianCount = 0;  // these are cut off behind n
  struct Gaussian {
    Vec3f axis;
    float sharpness = 0, amplitude = 0;
  } gaussians[2];
  // Shares of all amplitudes. A light of one colour on a receiver of another has a luminance
  // between the light's times the receiver's least and largest component: a receiver's amplitudes
  // are its largest components, and these its luminance and its least component over them.
  float mean = 1, least = 1;
};

struct BoundNode {
  Vec3f lo, hi;      // box
  Vec3f centre;      // of the representative; all lies within
  float radius = 0;  // ...this distance of it
  // Cones of normals and of the Gaussians' axes: octahedral axes, angles as codeOfAngle().
  uint32_t normalAxis = 0, lobeAxis = 0;
  uint16_t normalAngle = 0, lobeAngle = 0;
  float leastSharpness = 0, mostSharpness = 0;
  // Of lights the sums, of receivers the largest: amplitudes of cosine lobes and of Gaussians, and
  // the Gaussians' integrals over the sphere. Upper bounds.
  float cosine = 0, peak = 0, energy = 0;
  // Of lights the same sums, of receivers the smallest, times their BoundItem::least: cosine or
  // peak (of what they have), energy. Lower bounds.
  float leastPeak = 0, leastEnergy = 0;
  // Representative: normal and axis (octahedral), sharpness, amplitude of the cosine or integral of
  // the Gaussian, times BoundItem::mean.
  uint32_t n = 0, axis = 0;
  float sharpness = 0, amount = 0;
  uint32_t first = 0, count = 0;  // its items are [first, first + count) of the leaves' order
  bool leaf() const { return count == 1; }
};
static_assert(sizeof(BoundNode) == 104);

// Half-angles of cones by the sine of their half, from which kernels have sine and cosine without
// trigonometry: in 65,535ths, rounded up (small angles by up to 3e-5).
inline constexpr float kAngleCodes = 65535;
uint16_t codeOfAngle(float angle);
float angleOfCode(uint16_t code);

BoundNode leafOf(const BoundItem& item, uint32_t place);
BoundNode mergedLights(const BoundNode& a, const BoundNode& b);
BoundNode mergedReceivers(const BoundNode& a, const BoundNode& b);

}  // namespace lobelia::trees
