// Hash of what visibility depends on. Names, texture coordinates and materials do not count, but
// for masks: rays pass where a material is not opaque. Of these the opacity at some places of each
// triangle counts, which tells one picture from another without knowing how materials are made.
#include "lobelia/relight/visibility_data.h"
#include "lobelia/scene/shading.h"
#include "lobelia/store/store.h"

namespace lobelia::relight {
namespace {

constexpr int kPlaces = 4;  // along each of two edges of a triangle

class GeometryHash {
 public:
  template <class T>
  void add(std::span<const T> values) {
    const uint64_t count = values.size();
    value = store::hashBytes(std::as_bytes(std::span(&count, 1)), value);
    value = store::hashBytes(std::as_bytes(values), value);
  }
  template <class T>
  void add(const T& one) {
    add(std::span<const T>(&one, 1));
  }
  uint64_t value = 0;
};

std::vector<float> opacities(const Scene& scene, uint32_t index) {
  const Instance& instance = scene.instances[index];
  std::vector<float> out;
  for (uint32_t t = 0; t < scene[instance.mesh].triangles.size(); ++t)
    for (int i = 0; i < kPlaces; ++i)
      for (int j = 0; i + j < kPlaces; ++j) {
        const auto at = [](int k) { return (static_cast<float>(k) + 1.f / 3) / kPlaces; };
        const SurfacePoint point = surfacePoint(scene, {0, at(i), at(j), index, t});
        out.push_back(opacity(scene, instance.material, point.texture));
      }
  return out;
}

}  // namespace

uint64_t geometryHash(const Scene& scene) {
  GeometryHash hash;
  for (const Mesh& mesh : scene.meshes) {
    hash.add(std::span<const Vec3f>(mesh.positions));
    hash.add(std::span<const Vec3f>(mesh.normals));  // they say which side is the front
    hash.add(std::span<const Vec3u>(mesh.triangles));
  }
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    hash.add(instance.mesh.index);
    hash.add(instance.toWorld.to.m);
    hash.add(instance.flipNormals ? uint8_t{1} : uint8_t{0});
    if (hasOpacity(scene, instance.material)) hash.add(std::span<const float>(opacities(scene, i)));
  }
  return hash.value;
}

}  // namespace lobelia::relight
