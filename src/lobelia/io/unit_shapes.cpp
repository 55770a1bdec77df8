// Mitsuba's analytic shapes as meshes, with its parametrisation (uv) and exact normals.
//
// Tessellation of the round ones: a circle of N segments lies inside the true one by at most the
// sagitta 1 - cos(pi / N) of its radius. N = 256 gives 7.5e-5, twice that along the diagonals of
// the sphere's cells: a sphere 1000 pixels wide has a silhouette that is wrong by less than 0.08
// pixels, far below a pixel filter's width. Reflections follow the normals, which are exact at the
// vertices and, interpolated and normalised, wrong by less than 1e-5 rad within a triangle.
#include <cmath>

#include "lobelia/io/mesh_io.h"

namespace lobelia::io {
namespace {

constexpr int kSegments = 256;  // around
constexpr int kStacks = 128;    // of the sphere, pole to pole

// A point of the unit circle, i-th of n. Exact at the quarters, and the last equals the first.
Vec2f circle(int i, int n) {
  const int k = i % n;
  if (4 * k % n == 0) {
    constexpr int kCos[4] = {1, 0, -1, 0};
    const int quarter = 4 * k / n;
    return {static_cast<float>(kCos[quarter]), static_cast<float>(kCos[(quarter + 3) % 4])};
  }
  const double phi = 2 * M_PI * k / n;
  return {static_cast<float>(std::cos(phi)), static_cast<float>(std::sin(phi))};
}

float fraction(int i, int n) { return static_cast<float>(i) / static_cast<float>(n); }

void addVertex(Mesh& mesh, Vec3f p, Vec3f n, Vec2f uv) {
  mesh.positions.push_back(p);
  mesh.normals.push_back(n);
  mesh.uvs.push_back(uv);
}

}  // namespace

Mesh unitRectangle() {
  Mesh mesh;
  mesh.name = "rectangle";
  for (const Vec2f uv : {Vec2f(0, 0), Vec2f(1, 0), Vec2f(1, 1), Vec2f(0, 1)})
    addVertex(mesh, {2 * uv.x - 1, 2 * uv.y - 1, 0}, {0, 0, 1}, uv);
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// Every face covers [0,1]^2 of the uv plane. As in Mitsuba, its four vertices have in turn
// uv = (0,1), (1,1), (1,0), (0,0); `corner` is where (0,1) lies, u runs along `du`, v against `dv`.
Mesh unitCube() {
  struct Face {
    Vec3f corner, du, dv;
  };
  const Face faces[] = {
      {{1, -1, -1}, {0, 0, 1}, {-1, 0, 0}},  // -y
      {{1, 1, -1}, {-1, 0, 0}, {0, 0, 1}},   // +y
      {{1, -1, -1}, {0, 1, 0}, {0, 0, 1}},   // +x
      {{1, -1, 1}, {0, 1, 0}, {-1, 0, 0}},   // +z
      {{-1, -1, 1}, {0, 1, 0}, {0, 0, -1}},  // -x
      {{1, 1, -1}, {0, -1, 0}, {-1, 0, 0}},  // -z
  };
  Mesh mesh;
  mesh.name = "cube";
  for (const Face& f : faces) {
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    const Vec3f n = cross(f.du, f.dv);
    addVertex(mesh, f.corner, n, {0, 1});
    addVertex(mesh, f.corner + f.du * 2, n, {1, 1});
    addVertex(mesh, f.corner + f.du * 2 + f.dv * 2, n, {1, 0});
    addVertex(mesh, f.corner + f.dv * 2, n, {0, 0});
    mesh.triangles.push_back({base, base + 1, base + 2});
    mesh.triangles.push_back({base + 3, base, base + 2});
  }
  return mesh;
}

// uv = (radius, angle / 2 pi). The centre has one vertex per segment, with the segment's mean
// angle.
Mesh unitDisk() {
  Mesh mesh;
  mesh.name = "disk";
  for (int i = 0; i <= kSegments; ++i) {
    const Vec2f c = circle(i, kSegments);
    addVertex(mesh, {c.x, c.y, 0}, {0, 0, 1}, {1, fraction(i, kSegments)});
  }
  for (int i = 0; i < kSegments; ++i) {
    const auto centre = static_cast<uint32_t>(mesh.positions.size()),
               rim = static_cast<uint32_t>(i);
    addVertex(mesh, {0, 0, 0}, {0, 0, 1}, {0, fraction(2 * i + 1, 2 * kSegments)});
    mesh.triangles.push_back({centre, rim, rim + 1});
  }
  return mesh;
}

// uv = (phi / 2 pi, theta / pi), theta from +z. Rows of vertices from pole to pole; the seam is
// doubled, and each pole has one vertex per segment.
Mesh unitSphere() {
  Mesh mesh;
  mesh.name = "sphere";
  mesh.isUnitSphere = true;
  const auto row = [](int j) { return static_cast<uint32_t>(j * (kSegments + 1)); };
  for (int j = 0; j <= kStacks; ++j) {
    const Vec2f meridian = circle(j, 2 * kStacks);  // (cos, sin) of theta
    const bool pole = j == 0 || j == kStacks;
    for (int i = 0; i <= kSegments; ++i) {
      const Vec2f c = circle(i, kSegments);
      const Vec3f p{meridian.y * c.x, meridian.y * c.y, meridian.x};
      const float u = pole ? fraction(2 * i + 1, 2 * kSegments) : fraction(i, kSegments);
      addVertex(mesh, p, p, {u, fraction(j, kStacks)});
    }
  }
  for (int j = 0; j < kStacks; ++j)
    for (int i = 0; i < kSegments; ++i) {
      const uint32_t a = row(j) + static_cast<uint32_t>(i),
                     b = row(j + 1) + static_cast<uint32_t>(i);
      if (j < kStacks - 1) mesh.triangles.push_back({a, b, b + 1});
      if (j > 0) mesh.triangles.push_back({a, b + 1, a + 1});
    }
  return mesh;
}

// uv = (phi / 2 pi, z). Without caps.
Mesh unitCylinder() {
  Mesh mesh;
  mesh.name = "cylinder";
  for (int i = 0; i <= kSegments; ++i) {
    const Vec2f c = circle(i, kSegments);
    for (int z = 0; z < 2; ++z) {
      const auto h = static_cast<float>(z);
      addVertex(mesh, {c.x, c.y, h}, {c.x, c.y, 0}, {fraction(i, kSegments), h});
    }
  }
  for (uint32_t i = 0; i < kSegments; ++i) {
    const uint32_t a = 2 * i;
    mesh.triangles.push_back({a, a + 2, a + 3});
    mesh.triangles.push_back({a, a + 3, a + 1});
  }
  return mesh;
}

}  // namespace lobelia::io
