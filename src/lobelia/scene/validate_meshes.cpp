// Validation of meshes: sizes of arrays, indices, finite values, degenerate triangles.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/scene/validate.h"

namespace lobelia::validation {
namespace {

template <class T, class F>
size_t countIf(const std::vector<T>& items, const F& f) {
  size_t n = 0;
  for (const T& item : items) n += f(item) ? 1 : 0;
  return n;
}

// Without area, or so thin that floats cannot tell its normal.
bool isDegenerate(const Mesh& mesh, Vec3u t) {
  const Vec3f p = mesh.positions[t.x];
  const Vec3f a = mesh.positions[t.y] - p, b = mesh.positions[t.z] - p;
  const Vec3d ad(a.x, a.y, a.z), bd(b.x, b.y, b.z);
  const double area = length(cross(ad, bd));
  return !(area > 1e-12 * std::max(dot(ad, ad), dot(bd, bd)));
}

// Positions and indices; returns whether triangles may be looked up.
bool checkGeometry(const Mesh& mesh, const std::string& who, Findings& findings) {
  if (mesh.triangles.empty()) findings.warning(who + ": has no triangles");
  const size_t vertices = mesh.positions.size();
  const size_t infinite = countIf(mesh.positions, [](Vec3f p) { return !isFinite(p); });
  if (infinite > 0) {
    findings.error(fmt::format("{}: {} of {} vertices are not finite", who, infinite, vertices));
  }
  const size_t outside = countIf(mesh.triangles, [&](Vec3u t) {
    return t.x >= vertices || t.y >= vertices || t.z >= vertices;
  });
  if (outside > 0) {
    findings.error(fmt::format("{}: {} of {} triangles name vertices that do not exist (it has {})",
                               who, outside, mesh.triangles.size(), vertices));
  }
  return infinite == 0 && outside == 0;
}

void checkPerVertex(const Mesh& mesh, const std::string& who, Findings& findings) {
  const size_t vertices = mesh.positions.size();
  if (!mesh.normals.empty() && mesh.normals.size() != vertices) {
    findings.error(
        fmt::format("{}: {} normals for {} vertices", who, mesh.normals.size(), vertices));
  }
  if (!mesh.uvs.empty() && mesh.uvs.size() != vertices) {
    findings.error(fmt::format("{}: {} uvs for {} vertices", who, mesh.uvs.size(), vertices));
  }
  const size_t normals =
      countIf(mesh.normals, [](Vec3f n) { return !isFinite(n) || !(length(n) > 0); });
  if (normals > 0) {
    findings.warning(
        fmt::format("{}: {} vertex normals are zero or not finite; the geometric "
                    "normal is used there",
                    who, normals));
  }
  const size_t uvs =
      countIf(mesh.uvs, [](Vec2f v) { return !std::isfinite(v.x) || !std::isfinite(v.y); });
  if (uvs > 0) {
    findings.warning(fmt::format("{}: {} texture coordinates are not finite", who, uvs));
  }
}

void checkAttributes(const Mesh& mesh, const std::string& who, Findings& findings) {
  for (const MeshAttribute& a : mesh.attributes) {
    const size_t items = a.perFace ? mesh.triangles.size() : mesh.positions.size();
    if (a.size < 1 || a.values.size() != items * static_cast<size_t>(std::max(a.size, 0))) {
      findings.error(fmt::format("{}: attribute '{}' has {} values; {} times {} are needed", who,
                                 a.name, a.values.size(), items, a.size));
    }
    const size_t infinite = countIf(a.values, [](float v) { return !std::isfinite(v); });
    if (infinite > 0) {
      findings.error(
          fmt::format("{}: {} values of attribute '{}' are not finite", who, infinite, a.name));
    }
  }
}

}  // namespace

void checkMeshes(const Scene& scene, Findings& findings) {
  if (scene.instances.empty()) findings.warning("the scene has no surfaces");
  for (size_t i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    const std::string who = label("mesh", mesh.name, i);
    const bool usable = checkGeometry(mesh, who, findings);
    checkPerVertex(mesh, who, findings);
    checkAttributes(mesh, who, findings);
    if (!usable) continue;
    const size_t flat = countIf(mesh.triangles, [&](Vec3u t) { return isDegenerate(mesh, t); });
    if (flat > 0) {
      findings.warning(fmt::format("{}: {} of {} triangles are degenerate (no area)", who, flat,
                                   mesh.triangles.size()));
    }
  }
}

}  // namespace lobelia::validation
