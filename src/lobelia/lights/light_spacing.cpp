// Of the lights one in sixteen is looked at, and the third nearest of these. A distance that
// depends on the lights themselves biases what is split by it, as each of the k nearest in a sphere
// that they define stands for (k - 1) / k of a light on average; so few of them leave 2 % of that.
#include "lobelia/lights/light_spacing.h"

#include <limits>

#include "lobelia/lights/place_tree.h"

namespace lobelia {
namespace {

constexpr size_t kStep = 16;
constexpr size_t kNeighbours = 3;

struct Place {
  Vec3f p;
};

template <class Light>
void addPlaces(const std::vector<Light>& lights, size_t* next, std::vector<Place>* places) {
  for (; *next < lights.size(); *next += kStep) places->push_back({lights[*next].p});
  *next -= lights.size();
}

std::vector<Place> placesOf(std::initializer_list<const VirtualLights*> parts) {
  std::vector<Place> places;
  size_t next = 0;
  for (const VirtualLights* lights : parts) {
    addPlaces(lights->diffuse, &next, &places);
    addPlaces(lights->glossy, &next, &places);
    addPlaces(lights->spherical, &next, &places);
  }
  return places;
}

}  // namespace

struct LightSpacing::Search {
  explicit Search(std::initializer_list<const VirtualLights*> lights)
      : places(placesOf(lights)), tree(places) {}
  const std::vector<Place> places;
  const PlaceTree<Place> tree;
};

LightSpacing::LightSpacing(std::initializer_list<const VirtualLights*> lights)
    : search_(std::make_unique<Search>(lights)) {}
LightSpacing::~LightSpacing() = default;

float LightSpacing::distance(Vec3f p, float count) const {
  const float query[3] = {p.x, p.y, p.z};
  uint32_t nearest[kNeighbours];
  float squares[kNeighbours];
  const size_t found = search_->tree.index().knnSearch(query, kNeighbours, nearest, squares);
  if (found == 0) return std::numeric_limits<float>::infinity();
  return std::sqrt(squares[found - 1] * count / static_cast<float>(found * kStep));
}

}  // namespace lobelia
