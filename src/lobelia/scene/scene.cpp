// Extent and size of a scene.
#include "lobelia/scene/scene.h"

namespace lobelia {

namespace {

// Above this many triangles in all, instances count as their transformed boxes.
constexpr uint64_t kMaxExactTriangles = 10'000'000;

}  // namespace

// Of the transformed vertices that triangles use; vertices that are not finite are left out.
Bounds3f bounds(const Scene& scene) {
  std::vector<Bounds3f> local(scene.meshes.size());
  for (size_t m = 0; m < scene.meshes.size(); ++m) {
    const Mesh& mesh = scene.meshes[m];
    for (const Vec3u& t : mesh.triangles) {
      for (int i = 0; i < 3; ++i) {
        if (t[i] < mesh.positions.size() && isFinite(mesh.positions[t[i]])) {
          local[m].add(mesh.positions[t[i]]);
        }
      }
    }
  }
  const bool exact = triangleCount(scene) <= kMaxExactTriangles;
  Bounds3f all;
  for (const Instance& instance : scene.instances) {
    if (instance.mesh.index >= scene.meshes.size()) continue;
    const Bounds3f& box = local[instance.mesh.index];
    if (box.empty()) continue;
    if (instance.toWorld.to.isIdentity()) {
      all.add(box);
      continue;
    }
    if (!exact) {
      for (int i = 0; i < 8; ++i) {
        all.add(instance.toWorld.point({i & 1 ? box.hi.x : box.lo.x, i & 2 ? box.hi.y : box.lo.y,
                                        i & 4 ? box.hi.z : box.lo.z}));
      }
      continue;
    }
    const Mesh& mesh = scene[instance.mesh];
    for (const Vec3u& t : mesh.triangles) {
      for (int i = 0; i < 3; ++i) {
        if (t[i] >= mesh.positions.size()) continue;
        const Vec3f p = instance.toWorld.point(mesh.positions[t[i]]);
        if (isFinite(p)) all.add(p);
      }
    }
  }
  return all;
}

uint64_t triangleCount(const Scene& scene) {
  uint64_t count = 0;
  for (const Instance& instance : scene.instances) {
    if (instance.mesh.index < scene.meshes.size()) count += scene[instance.mesh].triangles.size();
  }
  return count;
}

}  // namespace lobelia
