// Of the lights one in sixteen is looked at, and the third nearest of these. A distance that
// depends on the lights themselves biases what is split by it, as each of the k nearest in a sphere
// that they define stands for (k - 1) / k of a light on average; so few of them leave 2 % of that.
#include "lobelia/lights/light_spacing.h"

#include <limits>
#include <nanoflann.hpp>

namespace lobelia {
namespace {

constexpr size_t kStep = 16;
constexpr size_t kNeighbours = 3;

struct Cloud {
  std::vector<Vec3f> points;
  size_t kdtree_get_point_count() const { return points.size(); }
  float kdtree_get_pt(size_t i, size_t axis) const { return points[i][static_cast<int>(axis)]; }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};
using Tree =
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Cloud, float, uint32_t>,
                                        Cloud, 3, uint32_t>;

template <class Light>
void addPlaces(const std::vector<Light>& lights, size_t* next, std::vector<Vec3f>* places) {
  for (; *next < lights.size(); *next += kStep) places->push_back(lights[*next].p);
  *next -= lights.size();
}

Cloud placesOf(std::initializer_list<const VirtualLights*> parts) {
  Cloud cloud;
  size_t next = 0;
  for (const VirtualLights* lights : parts) {
    addPlaces(lights->diffuse, &next, &cloud.points);
    addPlaces(lights->glossy, &next, &cloud.points);
    addPlaces(lights->spherical, &next, &cloud.points);
  }
  return cloud;
}

}  // namespace

struct LightSpacing::Search {
  explicit Search(std::initializer_list<const VirtualLights*> lights)
      : cloud(placesOf(lights)), tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(16)) {}
  const Cloud cloud;
  const Tree tree;
};

LightSpacing::LightSpacing(std::initializer_list<const VirtualLights*> lights)
    : search_(std::make_unique<Search>(lights)) {}
LightSpacing::LightSpacing(LightSpacing&&) noexcept = default;
LightSpacing& LightSpacing::operator=(LightSpacing&&) noexcept = default;
LightSpacing::~LightSpacing() = default;

float LightSpacing::distance(Vec3f p, float count) const {
  const float query[3] = {p.x, p.y, p.z};
  uint32_t nearest[kNeighbours];
  float squares[kNeighbours];
  const size_t found = search_->tree.knnSearch(query, kNeighbours, nearest, squares);
  if (found == 0) return std::numeric_limits<float>::infinity();
  return std::sqrt(squares[found - 1] * count / static_cast<float>(found * kStep));
}

}  // namespace lobelia
