// What a strategy chose for receivers, when it is asked to keep it (GatherParts::recordCuts).
#pragma once

#include <cstdint>
#include <vector>

namespace lobelia {

struct RecordedCut {
  enum class Lobes : uint32_t { all, diffuse, glossy };
  struct Node {
    uint32_t tree = 0, node = 0;  // PreparedGather::exportTrees()
    int32_t light = -1;  // that stands for it, by place of the leaves' order; -1: none does
    float weight = 0;  // of that light (of the node itself, where no light stands for it); 0: none
    float estimate = 0;   // what the node gives the receivers, as the strategy says
    float bound = -1;     // of the same; -1: has none
    uint32_t beside = 0;  // 1: the light is gathered beside the cut, whose node covers it, too
  };
  std::vector<uint32_t> receivers;  // numbers of the points that share it
  Lobes lobes = Lobes::all;         // of theirs
  std::vector<Node> nodes;          // every light of the trees is below one, but for those beside
};

}  // namespace lobelia
