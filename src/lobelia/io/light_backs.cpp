#include "lobelia/io/light_backs.h"

#include "lobelia/io/mesh_io.h"

namespace lobelia::io {
namespace {

constexpr float kBackDistance = 1e-4f;

}  // namespace

void LightBacks::add(size_t instance) {
  Instance back = scene_.instances[instance];
  back.mesh = backOf(back.mesh, back.flipNormals);
  back.flipNormals = !back.flipNormals;
  back.name += "-back";
  scene_.instances.push_back(std::move(back));
}

MeshHandle LightBacks::backOf(MeshHandle front, bool flipped) {
  const auto [entry, isNew] = backs_.try_emplace({front.index, flipped});
  if (!isNew) return entry->second;
  Mesh mesh = scene_[front];
  mesh.name += "-back";
  mesh.isUnitSphere = false;
  std::vector<Vec3f> normals = mesh.normals;
  if (normals.empty()) {
    Mesh smooth = mesh;
    computeNormals(smooth, -1);
    normals = smooth.normals;
    normals.resize(mesh.positions.size());
  }
  Bounds3f box;
  for (const Vec3f& p : mesh.positions) box.add(p);
  const float distance = (flipped ? 1.f : -1.f) * kBackDistance * box.radius();
  for (size_t i = 0; i < mesh.positions.size(); ++i) mesh.positions[i] += normals[i] * distance;
  scene_.meshes.push_back(std::move(mesh));
  return entry->second = {static_cast<uint32_t>(scene_.meshes.size() - 1)};
}

}  // namespace lobelia::io
