#include "lobelia/transfer/geodesic_grid.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

namespace lobelia::transfer {
namespace {

using Triangle = std::array<uint32_t, 3>;

// Faces follow one another over shared edges, a path through all of them.
constexpr Triangle kIcosahedron[20] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11},
                                       {2, 11, 10}, {6, 2, 10}, {7, 6, 10}, {8, 6, 7},  {1, 8, 7},
                                       {9, 8, 1},   {5, 9, 1},  {4, 9, 5},  {11, 4, 5}, {2, 4, 11},
                                       {3, 4, 2},   {3, 2, 6},  {3, 6, 8},  {3, 8, 9},  {3, 9, 4}};

std::vector<Vec3f> icosahedron() {
  const float g = (1 + std::sqrt(5.f)) / 2;
  std::vector<Vec3f> corners;
  for (const Vec3f& c : {Vec3f(-1, g, 0), Vec3f(1, g, 0), Vec3f(-1, -g, 0), Vec3f(1, -g, 0),
                         Vec3f(0, -1, g), Vec3f(0, 1, g), Vec3f(0, -1, -g), Vec3f(0, 1, -g),
                         Vec3f(g, 0, -1), Vec3f(g, 0, 1), Vec3f(-g, 0, -1), Vec3f(-g, 0, 1)})
    corners.push_back(normalize(c));
  return corners;
}

// The four children of each triangle: at its corners and in the middle, which shares an edge with
// each of them.
std::vector<Triangle> subdivided(std::span<const Triangle> triangles, std::vector<Vec3f>* points) {
  std::unordered_map<uint64_t, uint32_t> middles;
  const auto middle = [&](uint32_t a, uint32_t b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [at, isNew] =
        middles.try_emplace(uint64_t{low} << 32 | high, static_cast<uint32_t>(points->size()));
    if (isNew) points->push_back(normalize((*points)[low] + (*points)[high]));
    return at->second;
  };
  std::vector<Triangle> out;
  out.reserve(4 * triangles.size());
  for (const auto& [a, b, c] : triangles) {
    const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    out.push_back({a, ab, ca});
    out.push_back({ab, bc, ca});
    out.push_back({ab, b, bc});
    out.push_back({ca, bc, c});
  }
  return out;
}

double solidAngle(Vec3f af, Vec3f bf, Vec3f cf) {  // [VanOosterom83]
  const auto toDouble = [](Vec3f v) { return Vec3d(v.x, v.y, v.z); };
  const Vec3d a = toDouble(af), b = toDouble(bf), c = toDouble(cf);
  return 2 * std::atan2(std::abs(dot(a, cross(b, c))), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

// Of a triangle's three sides, how far d lies inside of each: its barycentric coordinates in the
// plane of the corners, up to a common factor.
std::array<float, 3> insideOf(const Vec3f& a, const Vec3f& b, const Vec3f& c, Vec3f d) {
  return {dot(d, cross(b, c)), dot(d, cross(c, a)), dot(d, cross(a, b))};
}

}  // namespace

GeodesicGrid::GeodesicGrid(int level) : level_(level) {
  if (level < 0 || level > kMostGridLevel)
    throw std::invalid_argument("a geodesic grid has a level from 0 to 7");
  std::vector<Vec3f> points = icosahedron();
  triangles_.emplace_back(std::begin(kIcosahedron), std::end(kIcosahedron));
  for (int l = 0; l < level; ++l) triangles_.push_back(subdivided(triangles_.back(), &points));

  // In the order in which the finest triangles meet them.
  constexpr uint32_t kNone = 0xffffffffu;
  ofSubdivision_.assign(points.size(), kNone);
  std::vector<double> solidAngles(points.size(), 0);
  directions_.reserve(points.size());
  for (const Triangle& t : triangles_.back()) {
    const double third = solidAngle(points[t[0]], points[t[1]], points[t[2]]) / 3;
    for (const uint32_t v : t) {
      if (ofSubdivision_[v] == kNone) {
        ofSubdivision_[v] = static_cast<uint32_t>(directions_.size());
        directions_.push_back(points[v]);
      }
      solidAngles[ofSubdivision_[v]] += third;
    }
  }
  solidAngles_.assign(solidAngles.begin(), solidAngles.end());
  for (std::vector<Triangle>& triangles : triangles_)
    for (Triangle& t : triangles)
      for (uint32_t& v : t) v = ofSubdivision_[v];
}

GridPlace GeodesicGrid::locate(Vec3f d) const {
  // The triangle that holds d best, from level to level; rounding decides on edges.
  uint32_t first = 0, count = 20, best = 0;
  std::array<float, 3> weights{};
  for (const std::vector<Triangle>& triangles : triangles_) {
    float most = -1e30f;
    for (uint32_t t = first; t < first + count; ++t) {
      const auto inside = insideOf(directions_[triangles[t][0]], directions_[triangles[t][1]],
                                   directions_[triangles[t][2]], d);
      const float least = std::min({inside[0], inside[1], inside[2]});
      // Triangles of a level differ in size, by a third at most; the far side of the sphere has
      // negative coordinates.
      if (least > most) most = least, best = t, weights = inside;
    }
    first = 4 * best, count = 4;
  }
  GridPlace place{triangles_.back()[best], {}};
  float sum = 0;
  for (size_t k = 0; k < 3; ++k) sum += place.weight[k] = std::max(weights[k], 0.f);
  for (float& w : place.weight) w = sum > 0 ? w / sum : 1.f / 3;
  return place;
}

std::vector<uint32_t> GeodesicGrid::indicesOf(const GeodesicGrid& coarser) const {
  if (coarser.level_ > level_)
    throw std::invalid_argument("a geodesic grid holds directions of coarser ones only");
  std::vector<uint32_t> out(coarser.count());
  for (size_t i = 0; i < coarser.count(); ++i) out[coarser.ofSubdivision_[i]] = ofSubdivision_[i];
  return out;
}

}  // namespace lobelia::transfer
