// How finely a lobe needs light, and how far around the mirror direction.
//
// With half vectors of deviation alpha / sqrt(2) along an axis, reflected directions deviate by
// s = sqrt(2) alpha. Nodes of radius r, about 2 sqrt(leaves below / all leaves), see a lobe widened
// from s^2 to s^2 + r^2 / 4: r = 0.63 alpha adds 5 %. A lobe reaches 4 s: beyond it
// Gaussian ones have e^-8 of their light; GGX has a hundredth of its peak there, and a tail that
// nodes of the cut are fine enough for.
#pragma once

#include <optional>

#include "lobelia/bsdf/lobe.h"

namespace lobelia::relight {

struct LobeReach {
  int level = 0;      // of the light tree: nodes that are small enough
  float radius = 0;   // radians about the mirror direction
  bool ends = false;  // is there nothing to speak of beyond it?
};

// Of a lobe that is no delta lobe in a tree of 2^levels leaves over directions; empty: broad lobes,
// for which no node of a cut is too large. widened: the lobe, with roughness raised to what leaves
// resolve.
std::optional<LobeReach> lobeReach(const Lobe& lobe, int levels, Lobe* widened);

// Is the lobe so sharp that it shows the environment itself: a mirror, or as good as one? Its
// image of the environment is then sharper than samples are.
bool isMirror(const Lobe& lobe);

}  // namespace lobelia::relight
