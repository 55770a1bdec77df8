// Round shapes have 256 segments a turn and 128 from pole to pole, as io/unit_shapes.cpp explains.
// Parallelograms, the usual patches, become two triangles; other patches 16 x 16 cells.
#include "lobelia/io/pbrt/tessellation.h"

#include <cmath>

#include "lobelia/io/mesh_io.h"

namespace lobelia::io::pbrt {
namespace {

constexpr float kSegmentsPerTurn = 256, kStacks = 128;
constexpr int kPatchCells = 16;

struct Vertex {
  Vec3f p, n;
};

// A grid of nu x nv cells over (u, v) in the unit square; its triangles turn from u to v.
template <class F>
void addGrid(Mesh& mesh, int nu, int nv, const F& vertexAt) {
  const auto base = static_cast<uint32_t>(mesh.positions.size());
  for (int j = 0; j <= nv; ++j) {
    for (int i = 0; i <= nu; ++i) {
      const Vec2f uv{static_cast<float>(i) / static_cast<float>(nu),
                     static_cast<float>(j) / static_cast<float>(nv)};
      const Vertex vertex = vertexAt(uv);
      mesh.positions.push_back(vertex.p);
      mesh.normals.push_back(vertex.n);
      mesh.uvs.push_back(uv);
    }
  }
  const auto row = static_cast<uint32_t>(nu + 1);
  for (uint32_t j = 0; j < static_cast<uint32_t>(nv); ++j) {
    for (uint32_t i = 0; i < static_cast<uint32_t>(nu); ++i) {
      const uint32_t a = base + j * row + i, b = a + 1, c = a + row, d = c + 1;
      // Cells at a pole have only one triangle.
      if (mesh.positions[a] != mesh.positions[b]) mesh.triangles.push_back({a, b, d});
      if (mesh.positions[c] != mesh.positions[d]) mesh.triangles.push_back({a, d, c});
    }
  }
}

int segments(float phiMax) {
  return std::max(3, static_cast<int>(std::ceil(kSegmentsPerTurn * phiMax / kFullTurn)));
}
float radians(float degrees) { return degrees * (kPi / 180); }

// Exactly closed: the last point of a full turn is the first.
Vec2f onCircle(float u, float phiMax) {
  if (phiMax >= kFullTurn && u >= 1) return {1, 0};
  return {std::cos(u * radians(phiMax)), std::sin(u * radians(phiMax))};
}

}  // namespace

// v runs from zMin to zMax, evenly in the angle.
Mesh tessellateSphere(const SphereShape& s) {
  Mesh mesh;
  mesh.name = "sphere";
  const float bottom = std::acos(std::clamp(s.zMin / s.radius, -1.f, 1.f));
  const float top = std::acos(std::clamp(s.zMax / s.radius, -1.f, 1.f));
  const int stacks = std::max(2, static_cast<int>(std::ceil(kStacks * (bottom - top) / kPi)));
  addGrid(mesh, segments(s.phiMax), stacks, [&](Vec2f uv) {
    const Vec2f c = onCircle(uv.x, s.phiMax);
    const float theta = bottom + (top - bottom) * uv.y;
    const bool isPole = theta <= 0 || theta >= kPi;
    const float sine = isPole ? 0.f : std::sin(theta);
    const Vec3f n{sine * c.x, sine * c.y, std::cos(theta)};
    return Vertex{n * s.radius, n};
  });
  return mesh;
}

Mesh wholeUnitSphere() {
  Mesh mesh = unitSphere();
  for (Vec2f& uv : mesh.uvs) uv.y = 1 - uv.y;  // PBRT's v grows with z
  return mesh;
}

// v is 0 at the rim and 1 inside.
Mesh tessellateDisk(const DiskShape& s) {
  Mesh mesh;
  mesh.name = "disk";
  addGrid(mesh, segments(s.phiMax), 1, [&](Vec2f uv) {
    const Vec2f c = onCircle(uv.x, s.phiMax) * (s.radius + (s.innerRadius - s.radius) * uv.y);
    return Vertex{{c.x, c.y, s.height}, {0, 0, 1}};
  });
  return mesh;
}

Mesh tessellateCylinder(const CylinderShape& s) {
  Mesh mesh;
  mesh.name = "cylinder";
  addGrid(mesh, segments(s.phiMax), 1, [&](Vec2f uv) {
    const Vec2f c = onCircle(uv.x, s.phiMax);
    return Vertex{{s.radius * c.x, s.radius * c.y, s.zMin + (s.zMax - s.zMin) * uv.y},
                  {c.x, c.y, 0}};
  });
  return mesh;
}

Mesh tessellatePatches(const std::vector<Vec3f>& positions, const std::vector<uint32_t>& indices,
                       const std::vector<Vec3f>& normals, const std::vector<Vec2f>& uvs) {
  Mesh mesh;
  mesh.name = "bilinearmesh";
  for (size_t k = 0; k + 3 < indices.size(); k += 4) {
    const uint32_t v[4] = {indices[k], indices[k + 1], indices[k + 2], indices[k + 3]};
    const Vec3f p00 = positions[v[0]], p10 = positions[v[1]], p01 = positions[v[2]],
                p11 = positions[v[3]];
    const float size = length(p11 - p00) + length(p10 - p01);
    const bool isFlat = length(p00 - p10 - p01 + p11) <= 1e-6f * size;
    const size_t first = mesh.positions.size();
    const int cells = isFlat ? 1 : kPatchCells;
    const auto blend = [](const auto& a, const auto& b, const auto& c, const auto& d, Vec2f uv) {
      return a * ((1 - uv.x) * (1 - uv.y)) + b * (uv.x * (1 - uv.y)) + c * ((1 - uv.x) * uv.y) +
             d * (uv.x * uv.y);
    };
    addGrid(mesh, cells, cells, [&](Vec2f uv) {
      const Vec3f du = lerp(p10 - p00, p11 - p01, uv.y), dv = lerp(p01 - p00, p11 - p10, uv.x);
      Vec3f n = cross(du, dv);
      if (!normals.empty()) {
        n = blend(normals[v[0]], normals[v[1]], normals[v[2]], normals[v[3]], uv);
      }
      const float len = length(n);
      return Vertex{blend(p00, p10, p01, p11, uv), len > 0 ? n / len : Vec3f{0, 0, 1}};
    });
    if (!uvs.empty())
      for (size_t i = first; i < mesh.uvs.size(); ++i)
        mesh.uvs[i] = blend(uvs[v[0]], uvs[v[1]], uvs[v[2]], uvs[v[3]], mesh.uvs[i]);
  }
  return mesh;
}

}  // namespace lobelia::io::pbrt
