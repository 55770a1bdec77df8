// A k-d tree over the places `p` of what an array holds, by nanoflann.
#pragma once

#include <cstdint>
#include <nanoflann.hpp>
#include <vector>

namespace lobelia {

template <class T>
class PlaceTree {
 public:
  // The items must outlive the tree and stay as they are.
  explicit PlaceTree(const std::vector<T>& items)
      : cloud_{items}, index_(3, cloud_, nanoflann::KDTreeSingleIndexAdaptorParams(kLeaf)) {}
  PlaceTree(const PlaceTree&) = delete;
  PlaceTree& operator=(const PlaceTree&) = delete;

  const auto& index() const { return index_; }

 private:
  static constexpr size_t kLeaf = 16;
  struct Cloud {
    const std::vector<T>& items;
    size_t kdtree_get_point_count() const { return items.size(); }
    float kdtree_get_pt(size_t i, size_t axis) const { return items[i].p[static_cast<int>(axis)]; }
    template <class Box>
    bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using Distance = nanoflann::L2_Simple_Adaptor<float, Cloud, float, uint32_t>;
  using Index = nanoflann::KDTreeSingleIndexAdaptor<Distance, Cloud, 3, uint32_t>;

  const Cloud cloud_;
  const Index index_;
};

}  // namespace lobelia
