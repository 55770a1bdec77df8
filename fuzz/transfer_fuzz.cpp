// Transfer of a scene of one square, taken for that of its surfaces; what is read is looked up.
#include <cstring>

#include "fuzz/fuzz_file.h"
#include "fuzz/sealed_input.h"
#include "lobelia/transfer/slice_lookup.h"

using namespace lobelia;

namespace {

// Its reflectance is driven by an image, so that records of reflection are looked up; it has two
// sides.
Scene square() {
  Scene scene;
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  mesh.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.meshes.push_back(mesh);
  scene.images.push_back({"grey", 1, 1, 3, {0.5f, 0.5f, 0.5f}});
  Texture grey;
  grey.type = TextureType::bitmap, grey.image = {0};
  scene.textures.push_back(grey);
  Material glossy;
  glossy.type = MaterialType::phong;
  glossy.specular = TextureHandle{0}, glossy.alphaU = 20.f;
  Material bothSides;
  bothSides.type = MaterialType::twoSided;
  bothSides.a = MaterialHandle{0};
  scene.materials = {glossy, bothSides};
  Instance instance;
  instance.mesh = MeshHandle{0}, instance.material = MaterialHandle{1};
  scene.instances.push_back(instance);
  return scene;
}

void lookUpAll(const Scene& scene, const transfer::TransferData& data,
               const transfer::ReflectionTables& tables) {
  const transfer::SliceLookup lookup(scene, data, tables);
  for (uint32_t v = 0; v < data.mesh.vertices.size(); ++v) {
    for (const transfer::Side side : {transfer::Side::front, transfer::Side::back}) {
      const transfer::VertexView view = lookup.view(v, normalize(Vec3f{0.3f, 0.2f, 0.5f}), side);
      lookup.visible(view);
      for (size_t pass = 1; pass < data.passes.size(); ++pass)
        for (size_t c = 0; c < data.passes[pass].glossy.size(); ++c) lookup.glossy(view, pass, c);
      for (size_t pass = 0; pass < data.passes.size(); ++pass)
        lookup.diffuse({{v, v, v}, {1, 0, 0}}, side, pass, Rgb(1.f));
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("square.vmf");
  static const Scene scene = square();
  static const transfer::ReflectionTables tables(scene);
  static const uint64_t surfaces = transfer::transferHash(scene);
  constexpr size_t kSceneHash = 32;  // where it stands (store/container.cpp)
  std::vector<uint8_t> input(data, data + size);
  if (size >= kSceneHash + sizeof(surfaces)) {
    std::memcpy(input.data() + kSceneHash, &surfaces, sizeof(surfaces));
    fuzz::seal(input.data(), size);
  }
  return fuzz::check(file, input.data(), size, [](const std::string& path) {
    lookUpAll(scene, transfer::load(path, scene), tables);
  });
}
