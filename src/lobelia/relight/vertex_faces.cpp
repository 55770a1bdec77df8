#include "lobelia/relight/vertex_faces.h"

#include <algorithm>

#include "lobelia/base/parallel.h"
#include "lobelia/scene/shading.h"

namespace lobelia::relight {
namespace {

// How far inside of a face its place is: of the way from the vertex to the middle.
constexpr float kInside = 1.f / 16;

bool hasArea(const SampleMesh& mesh, const LeafTriangle& t) {
  const Vec3f p = mesh.positions()[t.vertex[0]];
  const Vec3f c = cross(mesh.positions()[t.vertex[1]] - p, mesh.positions()[t.vertex[2]] - p);
  return lengthSquared(c) > 0;
}

void addLeaves(const SampleMesh& mesh, const SampleTriangle& triangle, const LeafTriangle& at,
               std::vector<LeafTriangle>* leaves) {
  if (triangle.splitEdges == 0) {
    leaves->push_back(at);
    return;
  }
  Vec2f points[6] = {at.corner[0], at.corner[1], at.corner[2]};
  for (size_t e = 0; e < 3; ++e) points[3 + e] = (points[e] + points[(e + 1) % 3]) * 0.5f;
  const auto children = childCorners(triangle.splitEdges);
  for (size_t i = 0; i < children.size(); ++i) {
    const SampleTriangle& child = mesh.triangles()[triangle.firstChild + i];
    LeafTriangle in = at;
    in.vertex = child.vertex, in.index = triangle.firstChild + static_cast<uint32_t>(i);
    for (size_t k = 0; k < 3; ++k) in.corner[k] = points[children[i][k]];
    addLeaves(mesh, child, in, leaves);
  }
}

constexpr size_t kMostLeading = 8;

bool turnedAway(std::span<const FacePlace> from, const FacePlace& face) {
  return std::all_of(from.begin(), from.end(),
                     [&](const FacePlace& f) { return dot(f.n, face.n) < 0.7071f; });
}

// Puts leading faces first.
void order(std::span<FacePlace> faces) {
  Vec3f sum;
  for (const FacePlace& f : faces) sum += f.n;
  const auto best = std::max_element(
      faces.begin(), faces.end(),
      [&](const FacePlace& a, const FacePlace& b) { return dot(a.n, sum) < dot(b.n, sum); });
  if (best != faces.end()) std::iter_swap(faces.begin(), best);
  size_t leading = 1;
  for (size_t i = 1; i < faces.size() && leading < kMostLeading; ++i)
    if (turnedAway(faces.first(leading), faces[i])) std::swap(faces[leading++], faces[i]);
}

}  // namespace

std::vector<LeafTriangle> leafTriangles(const SampleMesh& mesh) {
  std::vector<LeafTriangle> leaves;
  const auto first = mesh.firstTriangle();
  for (uint32_t i = 0; i + 1 < first.size(); ++i)
    for (uint32_t t = first[i]; t < first[i + 1]; ++t) {
      const SampleTriangle& triangle = mesh.triangles()[t];
      addLeaves(mesh, triangle, {triangle.vertex, i, t - first[i], {{{0, 0}, {1, 0}, {0, 1}}}, t},
                &leaves);
    }
  return leaves;
}

size_t leadingFaces(std::span<const FacePlace> faces) {
  size_t count = std::min<size_t>(faces.size(), 1);
  while (count < std::min(faces.size(), kMostLeading) &&
         turnedAway(faces.first(count), faces[count]))
    ++count;
  return count;
}

FacePlace facePlace(const Scene& scene, const LeafTriangle& triangle, const Vec3f& weights,
                    bool bothSides) {
  Vec2f b;
  for (int k = 0; k < 3; ++k)
    b = b + triangle.corner[static_cast<size_t>(k)] * (weights[k] * (1 - kInside) + kInside / 3);
  const SurfacePoint at = surfacePoint(scene, {0, b.x, b.y, triangle.instance, triangle.triangle});
  return {at.p + at.ng * at.error, at.p - at.ng * at.error, at.ng, bothSides};
}

VertexFaces::VertexFaces(const Scene& scene, const SampleMesh& mesh,
                         std::span<const LeafTriangle> triangles,
                         std::span<const uint8_t> bothSides) {
  begin_.assign(mesh.positions().size() + 1, 0);
  std::vector<uint8_t> good(triangles.size());
  for (size_t t = 0; t < triangles.size(); ++t) {
    good[t] = hasArea(mesh, triangles[t]) ? 1 : 0;
    if (good[t] != 0)
      for (const uint32_t v : triangles[t].vertex) ++begin_[v + 1];
  }
  for (size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
  std::vector<uint64_t> corners(begin_.back());  // triangle * 3 + corner, by vertex
  std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (size_t t = 0; t < triangles.size(); ++t)
    for (size_t k = 0; k < 3 && good[t] != 0; ++k)
      corners[next[triangles[t].vertex[k]]++] = 3 * t + k;
  faces_.resize(corners.size());
  parallelFor(begin_.size() - 1, 256, [&](size_t v) {
    for (uint32_t i = begin_[v]; i < begin_[v + 1]; ++i) {
      const LeafTriangle& t = triangles[corners[i] / 3];
      Vec3f weights(0.f);
      weights[static_cast<int>(corners[i] % 3)] = 1;
      faces_[i] = facePlace(scene, t, weights, bothSides[t.instance] != 0);
    }
    order({faces_.data() + begin_[v], faces_.data() + begin_[v + 1]});
  });
}

VertexNeighbours::VertexNeighbours(size_t vertexCount, std::span<const LeafTriangle> triangles) {
  std::vector<uint64_t> pairs;
  for (const LeafTriangle& t : triangles)
    for (size_t k = 0; k < 3; ++k) {
      const uint64_t a = t.vertex[k], b = t.vertex[(k + 1) % 3];
      if (a == b) continue;
      pairs.push_back(a << 32 | b);
      pairs.push_back(b << 32 | a);
    }
  parallelSort(&pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  begin_.assign(vertexCount + 1, 0);
  for (const uint64_t pair : pairs) {
    ++begin_[(pair >> 32) + 1];
    others_.push_back(static_cast<uint32_t>(pair));
  }
  for (size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
}

}  // namespace lobelia::relight
