// The vertices of transfer: one for each way to reflect light at a place.
//
// The paper has the vertices of its meshes [P002 section 6.1] and does not say what it does where
// smoothing groups or materials meet. Here places are welded as for visibility cuts
// (relight::weldedMesh), and each is then split by what its corners look like. Corners are compared
// with the first of each vertex, not by cells of a grid, so that the normals of a plane, which
// rounding makes differ, are one.
#include "lobelia/transfer/transfer_mesh.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "lobelia/base/random.h"
#include "lobelia/relight/vertex_faces.h"
#include "lobelia/scene/material_parameters.h"

namespace lobelia::transfer {
namespace {

using relight::LeafTriangle;
using relight::SampleMesh;
using relight::SampleTriangle;

// Deeper trees than any file has; a cycle (validate() reports it) ends here.
constexpr int kMaxDepth = 64;
// What lengths of differences may be. Tangents are constant on a triangle, so that on curved
// surfaces those of neighbours differ although nothing ends there.
constexpr float kNormalTolerance = 1e-3f, kUvTolerance = 1e-3f, kTangentTolerance = 0.2f;
constexpr uint32_t kNone = 0xffffffffu;

// f(material) for it and what it wraps, until one is true.
template <class F>
bool anyOf(const Scene& scene, MaterialHandle handle, const F& f, int depth = 0) {
  if (!handle.valid() || depth > kMaxDepth) return false;
  const Material& m = scene[handle];
  return f(m) || anyOf(scene, m.a, f, depth + 1) || anyOf(scene, m.b, f, depth + 1);
}

bool hasTextures(const Material& m) {
  bool any = m.map.valid() || m.clearcoatNormal.valid() || m.anisotropicDirection.valid();
  const auto look = [&](const auto& param) { any |= param.texture.valid(); };
  eachColorParam(m, look);
  eachFloatParam(m, look);
  for (const CapturedLobe& lobe : m.capturedLobes) look(lobe.amplitude), look(lobe.sharpness);
  return any;
}

// Does the material depend on where the tangents point? Those of normal maps do.
bool usesTangents(const Material& m) {
  const auto differ = [](const FloatParam& u, const FloatParam& v) {
    return u.texture.valid() || v.texture.valid() ? !(u.texture == v.texture) : u.value != v.value;
  };
  const bool maps = m.map.valid() || m.clearcoatNormal.valid();
  return maps || m.anisotropicDirection.valid() || m.anisotropic.texture.valid() ||
         m.anisotropic.value != 0 || differ(m.coatAlphaU, m.coatAlphaV) ||
         (m.type != MaterialType::phong && differ(m.alphaU, m.alphaV));
}

// What a corner of a triangle looks like; 0 what its material does not depend on.
struct CornerLook {
  MaterialHandle material;
  Vec3f n, tangent;
  Vec2f uv;
  uint64_t attributes = 0;  // hash of the mesh's attributes there

  bool like(const CornerLook& o) const {
    const Vec2f d = uv - o.uv;
    return material == o.material && attributes == o.attributes &&
           lengthSquared(n - o.n) < sqr(kNormalTolerance) &&
           lengthSquared(tangent - o.tangent) < sqr(kTangentTolerance) &&
           sqr(d.x) + sqr(d.y) < sqr(kUvTolerance);
  }
};

uint64_t attributesAt(const Mesh& mesh, uint32_t triangle, int corner) {
  uint64_t key = 0;
  for (const MeshAttribute& attribute : mesh.attributes) {
    const size_t at = attribute.perFace ? triangle : mesh.triangles[triangle][corner];
    const size_t size = static_cast<size_t>(attribute.size);
    for (size_t i = at * size; i < std::min((at + 1) * size, attribute.values.size()); ++i)
      key = hashCombine(key, std::bit_cast<uint32_t>(attribute.values[i]));
  }
  return key;
}

class CornerLooks {
 public:
  explicit CornerLooks(const Scene& scene) : scene_(scene) {
    for (uint32_t m = 0; m < scene.materials.size(); ++m) {
      textured_.push_back(isTextured(scene, {m}) ? 1 : 0);
      turned_.push_back(anyOf(scene, {m}, usesTangents) ? 1 : 0);
    }
  }
  CornerLook at(uint32_t instance, uint32_t triangle, int corner) const {
    const Hit hit{0, corner == 1 ? 1.f : 0.f, corner == 2 ? 1.f : 0.f, instance, triangle};
    const SurfacePoint point = surfacePoint(scene_, hit);
    CornerLook look{point.material, point.frame.n, {}, {}, 0};
    if (!point.material.valid()) return look;
    if (turned_[point.material.index] != 0) look.tangent = point.frame.s;
    if (textured_[point.material.index] == 0) return look;
    look.uv = point.uv;
    look.attributes = attributesAt(*point.texture.mesh, triangle, corner);
    return look;
  }

 private:
  const Scene& scene_;
  std::vector<uint8_t> textured_, turned_;  // by material
};

// Vertices at the places of a welded mesh, a list for each place.
class SplitVertices {
 public:
  explicit SplitVertices(std::span<const Vec3f> places)
      : places_(places), first_(places.size(), kNone) {}

  uint32_t withLook(uint32_t place, const CornerLook& look) {
    uint32_t* at = &first_[place];
    while (*at != kNone) {
      if (looks_[*at].like(look)) return *at;
      at = &next_[*at];
    }
    const uint32_t vertex = static_cast<uint32_t>(looks_.size());
    *at = vertex;  // before the vectors grow
    looks_.push_back(look), next_.push_back(kNone), positions_.push_back(places_[place]);
    return vertex;
  }
  // For triangles that nothing can meet: any.
  uint32_t whichever(uint32_t place) {
    return first_[place] != kNone ? first_[place] : withLook(place, {});
  }
  std::vector<Vec3f> takePositions() { return std::move(positions_); }

 private:
  std::span<const Vec3f> places_;
  std::vector<uint32_t> first_, next_;
  std::vector<CornerLook> looks_;
  std::vector<Vec3f> positions_;
};

// Twice the area; of triangles without one, and such as are not finite, 0.
float areaOf(std::span<const Vec3f> positions, const std::array<uint32_t, 3>& vertex) {
  const Vec3f p = positions[vertex[0]];
  const float area = length(cross(positions[vertex[1]] - p, positions[vertex[2]] - p));
  return std::isfinite(area) ? area : 0.f;
}

}  // namespace

relight::SurroundingVertices TransferMesh::around(const Hit& hit) const {
  // A place closer to a buried corner than this takes it in: there is nothing else to know.
  constexpr float kLeast = 1e-4f;
  relight::SurroundingVertices out = mesh.at(hit.instance, hit.triangle, hit.b1, hit.b2);
  if (buried.empty()) return out;
  float sum = 0;
  std::array<float, 3> weight{};
  for (size_t k = 0; k < 3; ++k)
    if (buried[out.vertex[k]] == 0) sum += weight[k] = out.weight[k];
  if (sum < kLeast || sum >= 1) return out;
  for (size_t k = 0; k < 3; ++k) out.weight[k] = weight[k] / sum;
  return out;
}

bool isTextured(const Scene& scene, MaterialHandle material) {
  return anyOf(scene, material, hasTextures);
}

SampleMesh splitMesh(const Scene& scene) {
  const SampleMesh welded = relight::weldedMesh(scene);
  const CornerLooks looks(scene);
  SplitVertices vertices(welded.positions());
  std::vector<SampleTriangle> triangles(welded.triangles().begin(), welded.triangles().end());
  const auto first = welded.firstTriangle();
  // Triangles without area come last: they have no normal of their own.
  for (const bool withArea : {true, false})
    for (uint32_t i = 0; i + 1 < first.size(); ++i)
      for (uint32_t t = first[i]; t < first[i + 1]; ++t) {
        const auto& places = welded.triangles()[t].vertex;
        if ((areaOf(welded.positions(), places) > 0) != withArea) continue;
        for (size_t k = 0; k < 3; ++k)
          triangles[t].vertex[k] =
              withArea
                  ? vertices.withLook(places[k], looks.at(i, t - first[i], static_cast<int>(k)))
                  : vertices.whichever(places[k]);
      }
  return {vertices.takePositions(), std::move(triangles), {first.begin(), first.end()}};
}

std::vector<TransferVertex> transferVertices(const Scene& scene, const SampleMesh& mesh) {
  const std::vector<LeafTriangle> leaves = relight::leafTriangles(mesh);
  std::vector<float> areas(mesh.positions().size(), -1);
  std::vector<TransferVertex> vertices(areas.size());
  for (const LeafTriangle& leaf : leaves) {
    const float area = areaOf(mesh.positions(), leaf.vertex);
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = leaf.vertex[k];
      if (area <= areas[v]) continue;  // the earlier of equals
      areas[v] = area;
      vertices[v].instance = leaf.instance, vertices[v].triangle = leaf.triangle;
      vertices[v].b1 = leaf.corner[k].x, vertices[v].b2 = leaf.corner[k].y;
    }
  }
  for (TransferVertex& vertex : vertices) {
    const SurfacePoint at = surfacePoint(scene, vertex.hit());
    vertex.p = at.p, vertex.n = at.frame.n;
  }
  return vertices;
}

}  // namespace lobelia::transfer
