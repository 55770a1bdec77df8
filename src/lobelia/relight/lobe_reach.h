// How finely a lobe needs light, and how far around the mirror direction.
//
// With half vectors of deviation alpha / sqrt(2) along an axis, reflected directions deviate by
// s = sqrt(2) alpha. Nodes of radius r, about 2 sqrt(leaves below / all leaves), see a lobe widened
// from s^2 to s^2 + r^2 / 4: r = 0.63 alpha adds 5 %. Gaussian lobes end at 4 s, where they have
// e^-8 of their peak; GGX has a tail. Nodes of the cut are fine enough beyond 3 s, of GGX
// beyond 2.5, where lobes have 1 and 6 % of their peak: whole pictures differ by less than a
// hundredth of what the cut costs by itself.
#pragma once

#include <optional>

#include "lobelia/bsdf/lobe.h"

namespace lobelia::relight {

struct LobeReach {
  int level = 0;     // of the light tree: nodes that are small enough
  float radius = 0;  // radians about the mirror direction, within which they are needed
  float end = kPi;   // beyond it there is nothing to speak of
};

// Of a lobe that is no delta lobe in a tree of 2^levels leaves over directions; empty: broad lobes,
// for which no node of a cut is too large. widened: the lobe, with roughness raised to what leaves
// resolve.
std::optional<LobeReach> lobeReach(const Lobe& lobe, int levels, Lobe* widened);

// Is the lobe so sharp that it shows the environment itself: a mirror, or as good as one? Its
// image of the environment is then sharper than samples are.
bool isMirror(const Lobe& lobe);

}  // namespace lobelia::relight
