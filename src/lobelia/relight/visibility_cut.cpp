// Selecting cuts of binary functions [P004 section 3.2, eq. 6].
//
// Where k of the n leaves below a node that matter are visible, the sum of squared differences from
// their mean is k - k^2/n: counts say it all, exactly, and need not be passed up the tree. A node's
// error does not grow by splitting it, so the order of refinement does not matter until a cut hits
// its largest size: the tree is walked from the root in the order of leaves. Only where the limit
// is hit is the node with the largest error refined first.
//
// Deviation: leaves that do not matter are left out of means and errors.
#include "lobelia/relight/visibility_cut.h"

#include <algorithm>
#include <bit>
#include <queue>

namespace lobelia::relight {

LeafBits::LeafBits(int levels_) : levels(levels_) {
  const size_t words = ((size_t{1} << levels) + 63) / 64;
  visible.assign(words, 0), matters.assign(words, 0);
}

CutSelector::CutSelector(float sigma, size_t mostNodes)
    : threshold_(static_cast<double>(sigma) * static_cast<double>(sigma)),
      mostNodes_(std::max<size_t>(mostNodes, 1)) {}

// Of the leaves [begin, end): whole words, or a part of one.
CutSelector::Count CutSelector::count(uint32_t begin, uint32_t end) const {
  const uint32_t first = begin / 64, last = end / 64;
  if (begin % 64 == 0 && end % 64 == 0)
    return {mattersBefore_[last] - mattersBefore_[first],
            visibleBefore_[last] - visibleBefore_[first]};
  const uint64_t mask = ((uint64_t{1} << (end - begin)) - 1) << (begin % 64);
  const uint64_t matters = bits_->matters[first] & mask;
  return {static_cast<uint32_t>(std::popcount(matters)),
          static_cast<uint32_t>(std::popcount(matters & bits_->visible[first]))};
}

CutSelector::Count CutSelector::count(int level, uint32_t place) const {
  return count(place << level, (place + 1) << level);
}

CutSelector::Node CutSelector::node(int level, uint32_t place) const {
  const Count c = count(level, place);
  const double n = c.matters, k = c.visible;
  return {static_cast<uint8_t>(level), place, n > 0 ? k - k * k / n : 0};
}

void CutSelector::refineAll(int level, uint32_t place) {
  if (chosen_.size() > mostNodes_) return;  // in vain
  const Node n = node(level, place);
  if (level == 0 || n.error <= threshold_) {
    chosen_.push_back(n);
    return;
  }
  refineAll(level - 1, 2 * place);
  refineAll(level - 1, 2 * place + 1);
}

void CutSelector::refineLargest() {
  const auto smaller = [](const Node& a, const Node& b) {
    if (a.error != b.error) return a.error < b.error;
    return a.place << a.level > b.place << b.level;
  };
  chosen_.assign(1, node(bits_->levels, 0));
  while (chosen_.size() < mostNodes_ && chosen_.front().error > threshold_) {
    std::pop_heap(chosen_.begin(), chosen_.end(), smaller);
    const Node n = chosen_.back();
    chosen_.pop_back();
    for (uint32_t side = 0; side < 2; ++side) {
      chosen_.push_back(node(n.level - 1, 2 * n.place + side));
      std::push_heap(chosen_.begin(), chosen_.end(), smaller);
    }
  }
  std::sort(chosen_.begin(), chosen_.end(),
            [](const Node& a, const Node& b) { return a.place << a.level < b.place << b.level; });
}

// What count() says, of the leaves at which errors are counted.
CutSelector::Count CutSelector::judged(uint32_t begin, uint32_t end) const {
  if (bits_->judged.empty()) return count(begin, end);
  Count c;
  for (uint32_t at = begin; at < end; at = at / 64 * 64 + 64) {
    const uint32_t stop = std::min(end, at / 64 * 64 + 64);
    const uint64_t part =
        stop - at == 64 ? ~uint64_t{0} : ((uint64_t{1} << (stop - at)) - 1) << (at % 64);
    const uint64_t mask = bits_->judged[at / 64] & part;
    c.matters += static_cast<uint32_t>(std::popcount(mask));
    c.visible += static_cast<uint32_t>(std::popcount(mask & bits_->visible[at / 64]));
  }
  return c;
}

void CutSelector::select(const LeafBits& bits, std::vector<CutNode>* nodes, CutReport* report) {
  bits_ = &bits;
  const size_t words = bits.wordCount();
  mattersBefore_.resize(words + 1), visibleBefore_.resize(words + 1);
  mattersBefore_[0] = visibleBefore_[0] = 0;
  for (size_t w = 0; w < words; ++w) {
    const uint64_t matters = bits.matters[w];
    mattersBefore_[w + 1] = mattersBefore_[w] + static_cast<uint32_t>(std::popcount(matters));
    visibleBefore_[w + 1] =
        visibleBefore_[w] + static_cast<uint32_t>(std::popcount(matters & bits.visible[w]));
  }
  chosen_.clear();
  refineAll(bits.levels, 0);
  const bool capped = chosen_.size() > mostNodes_;
  if (capped) refineLargest();

  uint8_t value = 0;  // of nodes without leaves that matter: that of the node before
  for (const Node& n : chosen_) {
    const Count c = count(n.level, n.place);
    if (c.matters > 0) {
      const double mean = static_cast<double>(c.visible) / c.matters;
      value = static_cast<uint8_t>(mean * 255 + 0.5);
    }
    const Count j = judged(n.place << n.level, (n.place + 1) << n.level);
    const double kept = value / 255.0;
    report->samples += j.matters;
    report->squaredError +=
        j.visible * (1 - kept) * (1 - kept) + (j.matters - j.visible) * kept * kept;
    nodes->push_back({n.level, value});
  }
  report->nodes += chosen_.size();
  report->capped += capped ? 1 : 0;
}

}  // namespace lobelia::relight
