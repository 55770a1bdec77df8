// Receivers of a tile as structure of arrays, in strips of 16 points whose lobes are of the same
// kinds: a strip fills one register (or 2, 4, 16) for every field, and the kinds of its lobes are
// branches that all its points take alike.
#pragma once

#include <array>
#include <vector>

#include "lobelia/path/receivers.h"

namespace lobelia::gather {

inline constexpr int kStrip = 16;

struct StripV3 {
  alignas(64) float x[kStrip];
  alignas(64) float y[kStrip];
  alignas(64) float z[kStrip];
  void set(int lane, Vec3f v) { x[lane] = v.x, y[lane] = v.y, z[lane] = v.z; }
  Vec3f get(int lane) const { return {x[lane], y[lane], z[lane]}; }
};

// One lobe of each of the 16 points; the fields of Lobe that evaluation reads.
struct LobeStrip {
  LobeType type;
  Distribution distribution;
  Fresnel fresnel;
  uint8_t variant;
  alignas(64) float alphaX[kStrip];
  alignas(64) float alphaY[kStrip];
  StripV3 weight, eta, k, parameters, tint;
  alignas(64) float sides[kStrip];        // bsdf/kernels-inl.h
  alignas(64) float tableOffset[kStrip];  // into Tile::tables, lobes under a coat only
};

struct PointStrip {
  StripV3 p, s, t, n;
  StripV3 base;  // normal before bump maps; n where there are none
  alignas(64) float bumpAlpha2[kStrip];
  bool perturbed = false;  // any lane
  // gatheredShare() of a light at distance d is d * nearScale - 1, cut to [0,1]: 0 up to the
  // square root of squaredNear.
  alignas(64) float nearScale[kStrip];
  alignas(64) float squaredNear[kStrip];
  bool near = false;  // any lane: where it is false, all lights count whole
  StripV3 wo;         // in the frame (s, t, n)
  StripV3 ng;
  StripV3 front, back;              // origins of rays that leave on the side of ng, on the other
  alignas(64) float above[kStrip];  // 1 where light from the side of n can be scattered to wo
  alignas(64) float below[kStrip];  // 1 where light from the other side can
  uint32_t point[kStrip];           // index into Receivers::points
  uint8_t depth[kStrip];
  uint32_t active = 0;   // bit per lane; the other lanes repeat an active one
  size_t firstLobe = 0;  // into Tile::lobes
  size_t lobeCount = 0;
  size_t firstGaussian = 0;  // into Tile::gaussians
  size_t gaussianCount = 0;
};

// What drawing directions towards spherical lights needs to know of the 16 points: one of their
// strongest Gaussians (gather/sphere.h), amplitude 0 where a point has fewer.
struct GaussianStrip {
  StripV3 axis;
  alignas(64) float sharpness[kStrip];
  alignas(64) float amplitude[kStrip];
};
struct SamplingStrip {
  alignas(64) float diffuse[kStrip];   // luminance of the cosine-like rest, per steradian
  alignas(64) float sharpest[kStrip];  // of the lobes, across their thinner axis
  int halfLobe = -1;  // of the strip's lobes, the one that most points draw by its half vector
  alignas(64) float random[3][kStrip];  // in [0,1)
};

struct Tile {
  std::vector<PointStrip> strips;
  std::vector<LobeStrip> lobes;
  std::vector<float> tables;  // kTransmittanceSize values each
  // Empty unless asked for.
  std::vector<GaussianStrip> gaussians;
  std::vector<SamplingStrip> sampling;  // parallel to strips
  const Receivers* receivers = nullptr;
};

inline constexpr size_t kMaxTilePoints = 256;

// The kinds of a point's lobes as one comparable value: four bytes a lobe, then the count.
using LobeKinds = std::array<uint8_t, 4 * kMaxLobes + 1>;
LobeKinds kindsOf(const Receivers& receivers, const ReceiverPoint& point);

// Strips of receivers.points[begin, end), at most kMaxTilePoints. Points without lobes are left
// out. Points of one kind keep their order, so that neighbours stay together.
Tile makeTile(const Receivers& receivers, size_t begin, size_t end);
// Adds what spherical lights need. The tile keeps a reference to the receivers.
void addSampling(const Receivers& receivers, Tile* tile);

}  // namespace lobelia::gather
