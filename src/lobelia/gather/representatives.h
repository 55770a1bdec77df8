// The light that stands for the lights of each node of light trees, with their power: that of one
// of its children, drawn by their powers, so that every light may stand for all and a child shares
// it [Walter05 section 3.1].
#pragma once

#include "lobelia/gather/light_forest.h"

namespace lobelia::gather {

class Representatives {
 public:
  Representatives() = default;
  // forest: must outlive it. The same for any number of threads.
  Representatives(const LightForest& forest, uint64_t seed);

  // Leaf below a node, the node itself if it is one.
  uint32_t leaf(uint32_t tree, uint32_t node) const { return leaves_[tree][node]; }
  // Its light's index in the class.
  uint32_t light(uint32_t tree, uint32_t node) const;
  // What its light is scaled by: luminance of the node's power over its own.
  float scale(uint32_t tree, uint32_t node) const;
  size_t lightCount() const { return lightCount_; }  // of the whole forest

 private:
  const LightForest* forest_ = nullptr;
  std::vector<std::vector<uint32_t>> leaves_;  // by tree and node
  size_t lightCount_ = 0;
};

}  // namespace lobelia::gather
