// PLY meshes, text and binary.
#include "fuzz/fuzz_file.h"
#include "lobelia/io/mesh_io.h"

using namespace lobelia;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("mesh.ply");
  return fuzz::check(file, data, size, [](const std::string& path) {
    std::vector<Finding> findings;
    io::readPly(path, {}, {}, findings);
  });
}
