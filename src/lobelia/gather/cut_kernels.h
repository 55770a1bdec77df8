// Lights for a cluster of receivers, from a cut of the light trees: stratified by the cut, drawn
// below its nodes (gather_cuts.h).
#pragma once

#include <span>
#include <vector>

#include "lobelia/base/key_sort.h"
#include "lobelia/gather/cut_receivers.h"
#include "lobelia/gather/dominant_lights.h"
#include "lobelia/gather/kernels.h"
#include "lobelia/trees/light_tree.h"

namespace lobelia::gather {

struct CutSettings {
  size_t nodes = 1024;  // of a cluster's cut, at most
  // Relative error aimed at in what a cluster gets: the cut ends where the estimated standard
  // deviation says so; 0: it has as many nodes as it may.
  float error = 0;
  // The estimate of a node's contribution has at least this share for either end of what it would
  // be at the peak of that end's lobes (the node's are merged ones): where shapes are told wrongly,
  // what is drawn too rarely flares.
  float floor = 0.01f;
};

struct CutLight {
  uint32_t number;    // of the light
  float probability;  // that it stands for its node
  float share;        // of all that the receivers get, as estimated
};

struct CutScratch {
  struct Entry {
    float priority, importance;
    uint32_t tree, node;
  };
  std::vector<Entry> heap, done;
  KeySort<Entry> byNode;
  std::vector<CutLight> drawn;
  struct Dominant {
    DominantLights::Leaf leaf;
    float value;
  };
  std::vector<Dominant> strongest;
  std::vector<DominantLights::Leaf> dominant;
  bool missed = false;  // the last cut ended by its size before CutSettings::error was met
};

// A light that makes at least this share of what a cluster gets is not left to chance.
inline constexpr float kDominant = 0.005f;

// What the receivers get from all lights, roughly, by a cut of so few nodes. Adds the number of
// nodes whose importance was computed.
float estimateAll(const CutReceivers& receivers, int representatives,
                  std::span<const trees::LightTree> trees, const CutSettings& settings,
                  size_t nodes, CutScratch* scratch, uint64_t* evaluations);

// What each node contributes to the receivers, roughly, by which cuts and lights are chosen: the
// root of the sum of squares over representatives of theirs. values: as many as nodes.
void estimateNodes(const CutReceivers& receivers, int representatives, float floor,
                   std::span<const trees::LightNode* const> nodes, float* values);

// By one cut of several trees, no light twice. dominant: lights that may make much of what the
// receivers get; those that do are taken as they are, at most as many as the cut may have nodes.
// seed: of what is drawn. representatives: of the receivers, by which lights are drawn below the
// cut's nodes. Returns the number of nodes whose importance was computed.
size_t drawCutLights(const CutReceivers& receivers, int representatives,
                     std::span<const trees::LightTree> trees,
                     std::span<const DominantLights::Leaf> dominant, const CutSettings& settings,
                     uint64_t seed, CutScratch* scratch, std::vector<CutLight>* lights);

// As keepVisible() for a tile of one strip, but by one ray per light, from one of the points that
// face it: it answers for all of them.
size_t keepVisibleByOne(const Tile& tile, const LightBlock& block, const Tracer& tracer,
                        uint64_t seed, PairMasks* pairs);

}  // namespace lobelia::gather
