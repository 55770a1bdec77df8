// The cuts of gather_cuts.h as they are kept for research: what a cut and the lights drawn for it
// leave behind, joined.
#pragma once

#include <span>

#include "lobelia/gather/cut_kernels.h"
#include "lobelia/gather/receiver_clusters.h"
#include "lobelia/gather/recorded_cut.h"

namespace lobelia::gather {

class CutRecorder {
 public:
  // lightCount: of all numbers. trees: must outlive it.
  CutRecorder(std::span<const trees::LightTree> trees, size_t lightCount);

  // After drawCutLights(). A node's estimate is its share of those of the whole cut; the rest of
  // the trees, which by the estimate gives nothing, follows with estimates of 0.
  void record(const CutScratch& scratch, std::span<const CutLight> drawn, RecordedCut* out) const;

 private:
  using Entry = CutScratch::Entry;
  void addRest(uint32_t tree, uint32_t node, std::span<const Entry> cut, RecordedCut* out) const;

  const std::span<const trees::LightTree> trees_;
  std::vector<DominantLights::Leaf> leaves_;  // by number of the light
};

// A record for each cluster, with its receivers.
std::vector<RecordedCut> recordedReceivers(const ReceiverClusters& clusters);

}  // namespace lobelia::gather
