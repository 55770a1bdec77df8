// From a hit to position, normals, uv, tangents and the error bound of the position.
//
// Conventions are Mitsuba 3's (Mesh::compute_surface_interaction, initialize_sh_frame): uv are the
// barycentrics (b1, b2) when a mesh has none; dp/du, dp/dv are then, and where uvs are degenerate,
// the branch-free frame around the geometric normal; the shading frame's s is dp/du orthogonalised
// to the interpolated normal. Deviations, in the spirit of Mitsuba 0.6:
//  - a mirroring transform keeps inside and outside (there the winding would turn them over);
//  - where a mesh has vertex normals, the geometric normal is put on their side (of the triangle's
//    mean, so that it does not change within a triangle): the winding of such files is often
//    random.
#include <cmath>

#include "lobelia/scene/shading.h"

namespace lobelia {
namespace {

constexpr float kUnitRoundoff = 0x1p-24f;

struct Triangle {
  Vec3f p[3];
  Vec3f e1, e2;  // p1 - p0, p2 - p0
  Vec3f cross;   // e1 x e2
  float area2;   // its length
};

Vec3f abs(Vec3f v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

// Transform::normal() without its temporary matrix: this runs three times a hit.
Vec3f transformNormal(const Transform& t, Vec3f n) {
  const auto& m = t.from.m;
  const Vec3d d(n.x, n.y, n.z);
  return {static_cast<float>(m[0][0] * d.x + m[1][0] * d.y + m[2][0] * d.z),
          static_cast<float>(m[0][1] * d.x + m[1][1] * d.y + m[2][1] * d.z),
          static_cast<float>(m[0][2] * d.x + m[1][2] * d.y + m[2][2] * d.z)};
}

// Rounding of a ray's way into an instance's space and back, per world axis: |M| |M^-1| (|p| +
// |t|).
Vec3f instanceRounding(const Transform& transform, Vec3f p) {
  double local[3];
  for (size_t i = 0; i < 3; ++i) {
    const auto& row = transform.from.m[i];
    local[i] = std::abs(row[3]);
    for (size_t j = 0; j < 3; ++j) {
      local[i] += std::abs(row[j]) * std::abs(double{p[static_cast<int>(j)]});
    }
  }
  Vec3f world;
  for (size_t i = 0; i < 3; ++i) {
    const auto& row = transform.to.m[i];
    double sum = std::abs(row[3]);
    for (size_t j = 0; j < 3; ++j) sum += std::abs(row[j]) * local[j];
    world[static_cast<int>(i)] = static_cast<float>(sum);
  }
  return world;
}

// How far, along the normal, the point and what the intersector takes for the triangle's plane may
// be apart: a running error analysis (Higham 2002, ch. 3) of the Moller-Trumbore test
// N.(p0 - o) > 0 with N = e1 x e2 for a ray that starts at the rounded point o.
//  - positions: rounding of o, of p0 - o and of the offset itself, each relative to a coordinate;
//  - plane: rounding of N, times the extent of the triangle. Both vanish for planes along an axis.
// The factors are about twice the worst that the tests in tests/trace/offset_test.cpp have seen.
float positionError(const Triangle& tri, Vec3f ng, Vec3f p, const Transform* transform) {
  constexpr float kPosition = 4, kPlane = 4, kInstance = 1, kSize = 1, kLargest = 1e-3f;
  const Vec3f n = abs(ng);
  const Vec3f reach = max(abs(tri.p[0]), max(abs(tri.p[1]), abs(tri.p[2])));
  const Vec3f a = abs(tri.e1), b = abs(tri.e2);
  const Vec3f extent = max(a, b);
  const Vec3f cross{a.y * b.z + a.z * b.y, a.z * b.x + a.x * b.z, a.x * b.y + a.y * b.x};
  const float size = maxComponent(extent);
  // Of slivers the plane is not known at all; nobody should leave them by more than kLargest.
  const float plane = tri.area2 > 0 ? std::min(kPlane * dot(cross, extent) / tri.area2,
                                               kLargest * size / kUnitRoundoff)
                                    : 0.f;
  float sum = kPosition * dot(n, reach) + plane + kSize * size;
  if (transform) sum += kInstance * dot(n, instanceRounding(*transform, p));
  return sum * kUnitRoundoff;
}

// In double, so that the point is the exact one rounded once.
Vec3f interpolate(const Triangle& tri, float b1, float b2) {
  Vec3f p;
  for (int i = 0; i < 3; ++i) {
    const double p0 = tri.p[0][i];
    p[i] = static_cast<float>(p0 + b1 * (tri.p[1][i] - p0) + b2 * (tri.p[2][i] - p0));
  }
  return p;
}

Vec3f geometricNormal(const Triangle& tri) {
  if (tri.area2 > 1e-15f && tri.area2 < 1e15f) return tri.cross / tri.area2;
  // Scaled first: squares of tiny triangles underflow.
  const float largest = maxComponent(abs(tri.cross));
  return largest > 0 ? normalize(tri.cross / largest) : Vec3f{0, 0, 1};
}

// A hit's triangle in the world and its normals, before flipNormals.
struct HitTriangle {
  const Instance& instance;
  const Mesh& mesh;
  const Transform* transform;  // none where it is the identity
  Vec3u v;
  Triangle tri;
  SurfaceNormals normals;
};

// In place: copying a triangle takes as long as making it.
HitTriangle hitTriangle(const Scene& scene, const Hit& hit) {
  const Instance& instance = scene.instances[hit.instance];
  const Mesh& mesh = scene[instance.mesh];
  HitTriangle out{instance,
                  mesh,
                  instance.toWorld.to.isIdentity() ? nullptr : &instance.toWorld,
                  mesh.triangles[hit.triangle],
                  {},
                  {}};
  const Transform* const transform = out.transform;
  const Vec3u v = out.v;
  Triangle& tri = out.tri;
  for (int i = 0; i < 3; ++i) {
    tri.p[i] = mesh.positions[v[i]];
    if (transform) tri.p[i] = transform->point(tri.p[i]);
  }
  tri.e1 = tri.p[1] - tri.p[0], tri.e2 = tri.p[2] - tri.p[0];
  tri.cross = cross(tri.e1, tri.e2);
  tri.area2 = length(tri.cross);

  Vec3f& ng = out.normals.ng;
  ng = geometricNormal(tri);
  if (transform && transform->to.determinant3() < 0) ng = -ng;
  out.normals.n = ng;
  if (mesh.normals.empty()) return out;
  Vec3f n[3];
  for (int i = 0; i < 3; ++i) {
    n[i] = mesh.normals[v[i]];
    if (transform) n[i] = normalize(transformNormal(*transform, n[i]));
  }
  if (dot(ng, n[0] + n[1] + n[2]) < 0) ng = -ng;
  out.normals.n = ng;
  const Vec3f sum = n[0] * (1 - hit.b1 - hit.b2) + n[1] * hit.b1 + n[2] * hit.b2;
  const float len = length(sum);
  if (len > 1e-6f && std::isfinite(len)) out.normals.n = sum / len;
  return out;
}

}  // namespace

SurfaceNormals surfaceNormals(const Scene& scene, const Hit& hit) {
  const HitTriangle at = hitTriangle(scene, hit);
  if (at.instance.flipNormals) return {-at.normals.ng, -at.normals.n};
  return at.normals;
}

SurfacePoint surfacePoint(const Scene& scene, const Hit& hit) {
  const HitTriangle at = hitTriangle(scene, hit);
  const Instance& instance = at.instance;
  const Mesh& mesh = at.mesh;
  const Vec3u v = at.v;
  const Triangle& tri = at.tri;
  const Transform* const transform = at.transform;
  const float b1 = hit.b1, b2 = hit.b2, b0 = 1 - b1 - b2;
  const bool smooth = !mesh.normals.empty();
  auto [ng, ns] = at.normals;

  Vec2f uv{b1, b2};
  const Frame around = frameFromNormal(ng);
  Vec3f dpdu = around.s, dpdv = around.t;
  bool ownTangents = false;
  if (!mesh.uvs.empty()) {
    const Vec2f uv0 = mesh.uvs[v.x], uv1 = mesh.uvs[v.y], uv2 = mesh.uvs[v.z];
    uv = uv0 * b0 + uv1 * b1 + uv2 * b2;
    const Vec2f duv1 = uv1 - uv0, duv2 = uv2 - uv0;
    const float det = duv1.x * duv2.y - duv1.y * duv2.x;
    const float inverseDet = det != 0 ? 1 / det : 0.f;
    if (inverseDet != 0 && std::isfinite(inverseDet)) {
      ownTangents = true;
      dpdu = (tri.e1 * duv2.y - tri.e2 * duv1.y) * inverseDet;
      dpdv = (tri.e2 * duv1.x - tri.e1 * duv2.x) * inverseDet;
    }
  }
  if (instance.flipNormals) ng = -ng, ns = -ns;
  const bool plain = !smooth && !ownTangents && !instance.flipNormals;  // the frame is there
  const Vec3f p = interpolate(tri, b1, b2);
  // All at once: filling a zeroed record would write most of it twice.
  return {.p = p,
          .ng = ng,
          .frame = plain ? around : frameFromNormalTangent(ns, dpdu),
          .dpdu = dpdu,
          .dpdv = dpdv,
          .uv = uv,
          .t = hit.t,
          .instance = hit.instance,
          .material = instance.material,
          .emitter = instance.emitter,
          .texture = {uv, &mesh, hit.triangle, {b1, b2}},
          .error = positionError(tri, ng, p, transform)};
}

}  // namespace lobelia
