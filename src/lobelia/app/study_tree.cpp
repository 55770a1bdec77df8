#include "lobelia/app/study_tree.h"

#include <numeric>
#include <utility>

namespace lobelia::app {
namespace {

using Node = StudyTree::Node;

// Divides the node at `index` into quarters or halves, and these, down to single leaves.
void divide(uint32_t index, bool quarters, StudyTree* tree) {
  const Node node = tree->nodes[index];
  const uint32_t size = node.end - node.begin;
  if (size <= 1) return;
  const uint32_t count = quarters ? 4 : 2, first = static_cast<uint32_t>(tree->nodes.size());
  tree->nodes[index].firstChild = first, tree->nodes[index].childCount = count;
  for (uint32_t i = 0; i < count; ++i)
    tree->nodes.push_back(
        {node.begin + size * i / count, node.begin + size * (i + 1) / count, 0, 0});
  for (uint32_t i = 0; i < count; ++i) divide(first + i, quarters, tree);
}

// Every other bit of v, from the lowest on.
uint32_t evenBits(uint32_t v) {
  uint32_t out = 0;
  for (uint32_t bit = 0; bit < 16; ++bit) out |= (v >> (2 * bit) & 1) << bit;
  return out;
}

// Faces one after the other, each by quarters of quarters.
std::vector<uint32_t> cubeOrder(uint32_t side) {
  std::vector<uint32_t> order;
  for (uint32_t face = 0; face < 6; ++face)
    for (uint32_t i = 0; i < side * side; ++i)
      order.push_back((face * side + evenBits(i >> 1)) * side + evenBits(i));
  return order;
}

// `parts` even parts below the root.
StudyTree cubeTree(uint32_t side, uint32_t parts) {
  StudyTree tree;
  tree.order = cubeOrder(side);
  const uint32_t all = 6 * side * side;
  tree.nodes.push_back({0, all, 1, parts});
  for (uint32_t i = 0; i < parts; ++i)
    tree.nodes.push_back({all / parts * i, all / parts * (i + 1), 0, 0});
  return tree;
}

}  // namespace

StudyTree cubeQuadTree(uint32_t side) {
  StudyTree tree = cubeTree(side, 6);
  for (uint32_t i = 1; i <= 6; ++i) divide(i, true, &tree);
  return tree;
}

StudyTree cubeBinaryTree(uint32_t side) {
  StudyTree tree = cubeTree(side, 3);
  for (uint32_t i = 1; i <= 3; ++i) divide(i, false, &tree);
  return tree;
}

StudyTree halvedTree(std::vector<uint32_t> order) {
  StudyTree tree;
  tree.nodes.push_back({0, static_cast<uint32_t>(order.size()), 0, 0});
  tree.order = std::move(order);
  divide(0, false, &tree);
  return tree;
}

CutCounter::CutCounter(const StudyTree& tree)
    : tree_(tree),
      visibleBefore_(tree.order.size() + 1, 0),
      mattersBefore_(tree.order.size() + 1, 0) {
  std::iota(mattersBefore_.begin(), mattersBefore_.end(), 0u);
}

void CutCounter::set(std::span<const uint64_t> visible, std::span<const uint64_t> matters) {
  for (size_t i = 0; i < tree_.order.size(); ++i) {
    const uint32_t item = tree_.order[i];
    const uint32_t counts =
        matters.empty() ? 1 : static_cast<uint32_t>(matters[item / 64] >> (item % 64) & 1);
    const uint32_t seen = static_cast<uint32_t>(visible[item / 64] >> (item % 64) & 1);
    mattersBefore_[i + 1] = mattersBefore_[i] + counts;
    visibleBefore_[i + 1] = visibleBefore_[i] + (counts & seen);
  }
}

double CutCounter::squaredError(uint32_t begin, uint32_t end) const {
  const double n = mattersBefore_[end] - mattersBefore_[begin];
  const double k = visibleBefore_[end] - visibleBefore_[begin];
  return n > 0 ? k - k * k / n : 0;
}

void CutCounter::add(const Node& node, double most, CutCost* cost) const {
  const double error = squaredError(node.begin, node.end);
  if (node.childCount == 0 || error <= most) {
    ++cost->nodes;
    cost->squaredError += error;
    return;
  }
  for (uint32_t i = 0; i < node.childCount; ++i) add(tree_.nodes[node.firstChild + i], most, cost);
}

CutCost CutCounter::cost(double sigma) const {
  CutCost cost;
  add(tree_.nodes.front(), sigma * sigma, &cost);
  return cost;
}

}  // namespace lobelia::app
