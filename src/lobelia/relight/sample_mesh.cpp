#include "lobelia/relight/sample_mesh.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>
#include <utility>

#include "lobelia/base/random.h"

namespace lobelia::relight {
namespace {

using Corners = std::array<uint8_t, 3>;

constexpr int kMostChildren = 4;
// By splitEdges. One edge: two halves; two edges: a corner and a quadrangle cut in two; all: the
// corners and the middle.
constexpr Corners kChildren[8][kMostChildren] = {
    {},
    {{0, 3, 2}, {3, 1, 2}},
    {{0, 1, 4}, {0, 4, 2}},
    {{3, 1, 4}, {0, 3, 4}, {0, 4, 2}},
    {{0, 1, 5}, {5, 1, 2}},
    {{0, 3, 5}, {3, 1, 5}, {5, 1, 2}},
    {{5, 4, 2}, {0, 1, 5}, {1, 4, 5}},
    {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}},
};
constexpr int kChildCount[8] = {0, 2, 2, 3, 2, 3, 3, 4};

struct Barycentric {
  float b[3];
};
// Of the six points of childCorners() in their triangle.
constexpr Barycentric kPoint[6] = {{{1, 0, 0}},     {{0, 1, 0}},     {{0, 0, 1}},
                                   {{.5f, .5f, 0}}, {{0, .5f, .5f}}, {{.5f, 0, .5f}}};

// Barycentrics of a place in a child, from those in its parent: the inverse of the matrix whose
// columns are the child's corners. Its determinant is the child's share of the area.
Barycentric inChild(Corners corners, const Barycentric& at) {
  const float *a = kPoint[corners[0]].b, *b = kPoint[corners[1]].b, *c = kPoint[corners[2]].b;
  const auto det = [](const float* x, const float* y, const float* z) {
    return x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0]) +
           x[2] * (y[0] * z[1] - y[1] * z[0]);
  };
  const float inverse = 1 / det(a, b, c);
  return {{det(at.b, b, c) * inverse, det(a, at.b, c) * inverse, det(a, b, at.b) * inverse}};
}

// Places that are the same but for rounding have one key; on the border of a cell there may be two,
// which leaves two vertices where one would do.
class PlaceKeys {
 public:
  explicit PlaceKeys(const Scene& scene) {
    // A power of two, so that what is exact stays so.
    const float size = maxComponent(bounds(scene).extent());
    if (size > 0 && std::isfinite(size)) inverse_ = std::exp2(22 - std::floor(std::log2(size)));
  }
  uint64_t operator()(Vec3f p) const {
    uint64_t key = 0;
    for (int c = 0; c < 3; ++c)
      key = hashCombine(key, static_cast<uint64_t>(std::llround(double{p[c]} * double{inverse_})));
    return key;
  }

 private:
  float inverse_ = 1;
};

void requireValid(const std::vector<Vec3f>& positions, const std::vector<SampleTriangle>& triangles,
                  const std::vector<uint32_t>& firstTriangle) {
  bool good = !firstTriangle.empty() && firstTriangle.front() == 0 &&
              std::is_sorted(firstTriangle.begin(), firstTriangle.end()) &&
              firstTriangle.back() <= triangles.size();
  for (size_t i = 0; i < triangles.size() && good; ++i) {
    const SampleTriangle& t = triangles[i];
    for (const uint32_t v : t.vertex) good &= v < positions.size();
    good &= t.splitEdges < 8;
    if (t.splitEdges == 0 || !good) continue;
    const size_t children = childCorners(t.splitEdges).size();
    good &= t.firstChild > i && t.firstChild + children <= triangles.size();
  }
  if (!good) throw std::invalid_argument("the triangles of a sample mesh do not fit its vertices");
}

}  // namespace

std::span<const std::array<uint8_t, 3>> childCorners(uint32_t splitEdges) {
  return {kChildren[splitEdges], static_cast<size_t>(kChildCount[splitEdges])};
}

SampleMesh::SampleMesh(std::vector<Vec3f> positions, std::vector<SampleTriangle> triangles,
                       std::vector<uint32_t> firstTriangle)
    : positions_(std::move(positions)),
      triangles_(std::move(triangles)),
      firstTriangle_(std::move(firstTriangle)) {
  requireValid(positions_, triangles_, firstTriangle_);
}

SurroundingVertices SampleMesh::at(uint32_t instance, uint32_t triangle, float u, float v) const {
  const SampleTriangle* t = &triangles_[firstTriangle_[instance] + triangle];
  Barycentric at{{1 - u - v, u, v}};
  while (t->splitEdges != 0) {
    // On an edge between children rounding decides: that which holds the place best.
    float best = -1e30f;
    uint32_t chosen = 0;
    Barycentric inside{};
    const auto children = childCorners(t->splitEdges);
    for (uint32_t i = 0; i < children.size(); ++i) {
      const Barycentric in = inChild(children[i], at);
      const float least = std::min({in.b[0], in.b[1], in.b[2]});
      if (least > best) best = least, chosen = i, inside = in;
    }
    at = inside, t = &triangles_[t->firstChild + chosen];
  }
  SurroundingVertices out{t->vertex, {}};
  float sum = 0;
  for (size_t i = 0; i < 3; ++i) sum += out.weight[i] = std::max(0.f, at.b[i]);
  for (float& w : out.weight) w = sum > 0 ? w / sum : 1.f / 3;
  return out;
}

SampleMesh weldedMesh(const Scene& scene) {
  std::vector<Vec3f> positions;
  std::vector<SampleTriangle> triangles;
  std::vector<uint32_t> firstTriangle{0};
  const PlaceKeys keyOf(scene);
  std::unordered_map<uint64_t, uint32_t> known;
  std::vector<uint32_t> ofMesh;  // by vertex of the mesh; those no triangle uses stay out
  constexpr uint32_t kNone = 0xffffffffu;
  for (const Instance& instance : scene.instances) {
    const Mesh& mesh = scene[instance.mesh];
    ofMesh.assign(mesh.positions.size(), kNone);
    for (const Vec3u& corners : mesh.triangles) {
      SampleTriangle triangle;
      for (int k = 0; k < 3; ++k) {
        uint32_t& vertex = ofMesh[corners[k]];
        if (vertex == kNone) {
          const Vec3f p = instance.toWorld.point(mesh.positions[corners[k]]);
          const auto [at, isNew] =
              known.try_emplace(keyOf(p), static_cast<uint32_t>(positions.size()));
          if (isNew) positions.push_back(p);
          vertex = at->second;
        }
        triangle.vertex[static_cast<size_t>(k)] = vertex;
      }
      triangles.push_back(triangle);
    }
    firstTriangle.push_back(static_cast<uint32_t>(triangles.size()));
  }
  return {std::move(positions), std::move(triangles), std::move(firstTriangle)};
}

}  // namespace lobelia::relight
