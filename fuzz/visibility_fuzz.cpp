// Visibility cuts of a scene of one square, taken for those of its geometry.
#include <cstring>

#include "fuzz/fuzz_file.h"
#include "fuzz/sealed_input.h"
#include "lobelia/relight/visibility_data.h"

using namespace lobelia;

namespace {

Scene square() {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(mesh);
  scene.materials.emplace_back();
  Instance instance;
  instance.mesh = MeshHandle{0}, instance.material = MaterialHandle{0};
  scene.instances.push_back(instance);
  return scene;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("square.cuts");
  static const Scene scene = square();
  static const uint64_t geometry = relight::geometryHash(scene);
  constexpr size_t kSceneHash = 32;  // where it stands (store/container.cpp)
  std::vector<uint8_t> input(data, data + size);
  if (size >= kSceneHash + sizeof(geometry)) {
    std::memcpy(input.data() + kSceneHash, &geometry, sizeof(geometry));
    fuzz::seal(input.data(), size);
  }
  return fuzz::check(file, input.data(), size,
                     [](const std::string& path) { relight::load(path, scene); });
}
