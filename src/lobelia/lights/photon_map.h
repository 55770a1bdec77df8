// Photons in a tree, for looking up those around a point.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "lobelia/lights/photon.h"

namespace lobelia {

struct PhotonQuery {
  Vec3f p, n;         // n: geometric normal of the outside
  int maxDepth = -1;  // of the photons; -1: any
  size_t count = 1;   // the nearest so many, at least 1
  float maxRadius = 0;
};

// Photons found, nearest first, and what area they are spread over.
struct PhotonsFound {
  struct Entry {
    float distance2;
    uint32_t index;
  };
  std::vector<Entry> entries;
  float area = 0;  // > 0 where there are entries
};

class PhotonMap {
 public:
  explicit PhotonMap(std::vector<Photon> photons);
  ~PhotonMap();
  PhotonMap(const PhotonMap&) = delete;
  PhotonMap& operator=(const PhotonMap&) = delete;

  const std::vector<Photon>& photons() const { return photons_; }
  // The nearest photons on the query's surface: with a normal like n (within 25 degrees) and near
  // the plane through p. Of fewer than count + 1 within maxRadius all, and the area is that of the
  // radius; otherwise the nearest of those left out bounds the area, which leaves the density of
  // the others unbiased where it is even [Loftsgaarden65]. Thread-safe.
  void find(const PhotonQuery& query, PhotonsFound* found) const;

 private:
  struct Tree;
  std::vector<Photon> photons_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace lobelia
