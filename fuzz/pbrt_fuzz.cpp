// PBRT-v4 scenes.
#include "fuzz/fuzz_file.h"
#include "lobelia/io/scene_io.h"

using namespace lobelia;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("scene.pbrt");
  return fuzz::checkScene(file, data, size, [](const std::string& path, Context& context) {
    return io::readPbrt(path, {}, context);
  });
}
