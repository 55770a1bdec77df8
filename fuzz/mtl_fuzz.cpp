// MTL files of OBJ scenes. The images that they name may be the input itself.
#include <fstream>

#include "fuzz/fuzz_file.h"
#include "lobelia/io/scene_io.h"

using namespace lobelia;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("mesh.mtl");
  return fuzz::checkScene(file, data, size, [](const std::string& path, Context& context) {
    const auto mesh = std::filesystem::path(path).replace_extension(".obj");
    std::ofstream(mesh) << "mtllib mesh.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\n"
                           "usemtl a\nf 1/1 2/1 3/1\nusemtl b\nf 3/1 2/1 1/1\n";
    return io::readBareMesh(mesh.string(), {}, context);
  });
}
