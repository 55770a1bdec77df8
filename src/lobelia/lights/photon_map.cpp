#include "lobelia/lights/photon_map.h"

#include <algorithm>

#include "lobelia/lights/place_tree.h"
#include "lobelia/lights/virtual_lights.h"

namespace lobelia {
namespace {

constexpr float kLeastCosine = 0.9f;  // between the normals of a surface
constexpr float kMostSine2 = 0.1f;    // of the elevation of a photon over the plane, squared

bool nearer(const PhotonsFound::Entry& a, const PhotonsFound::Entry& b) {
  return a.distance2 != b.distance2 ? a.distance2 < b.distance2 : a.index < b.index;
}

// Keeps the nearest of the photons that the tree offers, as a heap with the farthest on top.
class Nearest {
 public:
  using DistanceType = float;
  Nearest(const PhotonQuery& query, const std::vector<Photon>& photons,
          std::vector<PhotonsFound::Entry>* heap)
      : query_(query), photons_(photons), heap_(heap) {
    heap_->clear();
  }

  size_t size() const { return heap_->size(); }
  bool full() const { return true; }
  float worstDist() const {
    return heap_->size() > query_.count ? heap_->front().distance2
                                        : query_.maxRadius * query_.maxRadius;
  }
  bool addPoint(float distance2, uint32_t index) {
    if (!onSurface(photons_[index], distance2)) return true;
    heap_->push_back({distance2, index});
    std::push_heap(heap_->begin(), heap_->end(), nearer);
    if (heap_->size() > query_.count + 1) {
      std::pop_heap(heap_->begin(), heap_->end(), nearer);
      heap_->pop_back();
    }
    return true;
  }

 private:
  bool onSurface(const Photon& photon, float distance2) const {
    if (query_.maxDepth >= 0 && photon.depth() > query_.maxDepth) return false;
    const float height = dot(photon.p - query_.p, query_.n);
    const float rounding = 1e-6f * maxComponent(max(photon.p, -photon.p));
    return height * height <= kMostSine2 * distance2 + rounding * rounding &&
           dot(decodeOctahedral(photon.normal), query_.n) > kLeastCosine;
  }

  const PhotonQuery& query_;
  const std::vector<Photon>& photons_;
  std::vector<PhotonsFound::Entry>* heap_;
};

}  // namespace

struct PhotonMap::Tree : PlaceTree<Photon> {
  using PlaceTree::PlaceTree;
};

PhotonMap::PhotonMap(std::vector<Photon> photons) : photons_(std::move(photons)) {
  if (!photons_.empty()) tree_ = std::make_unique<Tree>(photons_);
}
PhotonMap::~PhotonMap() = default;

void PhotonMap::find(const PhotonQuery& query, PhotonsFound* found) const {
  found->entries.clear();
  if (!tree_) return;
  Nearest nearest(query, photons_, &found->entries);
  const float p[3] = {query.p.x, query.p.y, query.p.z};
  tree_->index().findNeighbors(nearest, p, nanoflann::SearchParams());
  std::sort(found->entries.begin(), found->entries.end(), nearer);
  float radius2 = query.maxRadius * query.maxRadius;
  if (found->entries.size() > query.count) {
    radius2 = found->entries.back().distance2;
    found->entries.pop_back();
  }
  found->area = kPi * radius2;
  if (!(found->area > 0)) found->entries.clear();  // as many photons in one point
}

}  // namespace lobelia
