// Layers over a base: what they leave of the light that goes through them.
//
// A base under layers is multiplied by T(cos wo) T(cos wi), T being one minus the reflectance of
// the layers (directional albedo, largest channel). That is reciprocal and never brighter than what
// came in; a diffuse base is divided by the mean of T for diffuse light, by which light that is
// caught between base and layers comes out in the end (as in Kelemen and Szirmay-Kalos 2001).
#pragma once

#include <array>
#include <span>

#include "lobelia/bsdf/lobe.h"

namespace lobelia {

// T over cosines, as Lobe::table has it; then its mean for diffuse light, twice the integral of
// T(c) c.
using TransmittanceTable = std::array<float, kTransmittanceSize + 1>;

// That mean: the integral of the table's linear interpolant, exact per interval.
float diffuseMean(const TransmittanceTable& table);

// T at a cosine in [0, 1].
float tableAt(const TransmittanceTable& table, float cosine);

inline constexpr int kMaxLayers = 3;
// Of up to kMaxLayers reflecting lobes above each other, none of them under another's table.
// Integrated on first use and kept for the process: round what varies over a surface first. Threads
// may call this together; the reference stays valid.
const TransmittanceTable& layerTransmittance(std::span<const Lobe> layers);

}  // namespace lobelia
