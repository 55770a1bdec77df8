// A lobe of a slice of transfer as it is stored [P002 sections 4, 6.2; methods.md 3.1].
#pragma once

#include <cstdint>

#include "lobelia/base/vec.h"

namespace lobelia::transfer {

// share: what of the light that the surface reflects (of its albedo towards the eye) comes this
// way, in [0, 1] for each colour, so that the transfer's alpha is the surface's own albedo times
// this: textures and Fresnel terms stay sharp. r: mean of the directions in which the light comes
// from infinity, world; its length, below 1, is a vMF lobe's mean resultant
// (lobes::inverseMeanResultant).
struct TransferLobe {
  Rgb share{};
  Vec3f r{};
};

// 8 bytes instead of the paper's 24: shares with a common exponent (error at most 1/512 of the
// largest), direction octahedral in 2 x 11 bits (error below .1 degree), kappa by its logarithm in
// 10 bits (error below 1 %), from 1/64 to kMostKappa.
struct SliceRecord {
  uint32_t share = 0;
  uint32_t lobe = 0;
  friend bool operator==(SliceRecord, SliceRecord) = default;
};
static_assert(sizeof(SliceRecord) == 8);

inline constexpr float kMostKappa = 8192;
// Roughness of Beckmann's microfacets that reflect such a lobe: kappa is 1 / (2 alpha^2).
inline constexpr float kLeastAlpha = 1.f / 128;
static_assert(1 / (2 * kLeastAlpha * kLeastAlpha) == kMostKappa);

SliceRecord pack(const TransferLobe& lobe);
TransferLobe unpack(SliceRecord record);

}  // namespace lobelia::transfer
