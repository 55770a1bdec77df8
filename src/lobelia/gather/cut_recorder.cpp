#include "lobelia/gather/cut_recorder.h"

#include <algorithm>

namespace lobelia::gather {

CutRecorder::CutRecorder(std::span<const trees::LightTree> trees, size_t lightCount)
    : trees_(trees), leaves_(lightCount) {
  for (uint32_t t = 0; t < trees.size(); ++t) {
    const auto nodes = trees[t].nodes();
    for (uint32_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].leaf()) leaves_[trees[t].light(nodes[i].link)] = {t, i};
  }
}

void CutRecorder::record(const CutScratch& scratch, std::span<const CutLight> drawn,
                         RecordedCut* out) const {
  const std::span<const Entry> cut = scratch.done;  // by tree and node
  const auto after = [](const DominantLights::Leaf& leaf, const Entry& entry) {
    return leaf.tree != entry.tree ? leaf.tree < entry.tree : leaf.node < entry.node;
  };
  float all = 0;
  for (const Entry& entry : cut) all += entry.importance;
  for (const Entry& entry : cut)
    out->nodes.push_back({entry.tree, entry.node, -1, 0, entry.importance / all, -1, 0});
  for (const CutLight& light : drawn) {
    const DominantLights::Leaf leaf = leaves_[light.number];
    const int32_t place = static_cast<int32_t>(trees_[leaf.tree].nodes()[leaf.node].link);
    const bool beside = std::binary_search(scratch.dominant.begin(), scratch.dominant.end(), leaf);
    if (beside) {
      out->nodes.push_back({leaf.tree, leaf.node, place, 1, light.share, -1, 1});
      continue;
    }
    // The last entry that begins before the leaf holds it.
    const auto holder = std::upper_bound(cut.begin(), cut.end(), leaf, after) - cut.begin() - 1;
    RecordedCut::Node& node = out->nodes[static_cast<size_t>(holder)];
    node.light = place;
    node.weight = 1 / light.probability;
  }
  for (uint32_t t = 0; t < trees_.size(); ++t)
    if (!trees_[t].empty()) addRest(t, 0, cut, out);
}

// The largest nodes below this one that hold no node of the cut and lie in none.
void CutRecorder::addRest(uint32_t tree, uint32_t node, std::span<const Entry> cut,
                          RecordedCut* out) const {
  const trees::LightNode& at = trees_[tree].nodes()[node];
  const auto before = [](const Entry& entry, const DominantLights::Leaf& place) {
    return entry.tree != place.tree ? entry.tree < place.tree : entry.node < place.node;
  };
  const auto first =
      std::lower_bound(cut.begin(), cut.end(), DominantLights::Leaf{tree, node}, before);
  const bool any =
      first != cut.end() && first->tree == tree && first->node < node + 2 * at.count - 1;
  if (!any) return out->nodes.push_back({tree, node, -1, 0, 0, -1, 0});
  if (first->node == node) return;
  addRest(tree, trees_[tree].left(node), cut, out);
  addRest(tree, trees_[tree].right(node), cut, out);
}

std::vector<RecordedCut> recordedReceivers(const ReceiverClusters& clusters) {
  std::vector<RecordedCut> records(clusters.clusters.size());
  for (size_t i = 0; i < records.size(); ++i) {
    const ReceiverClusters::Cluster& cluster = clusters.clusters[i];
    records[i].receivers.assign(clusters.order.begin() + cluster.begin,
                                clusters.order.begin() + cluster.end);
  }
  return records;
}

}  // namespace lobelia::gather
