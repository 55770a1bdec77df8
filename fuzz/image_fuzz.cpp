// Images; the format is told by the contents, TGA by the name.
#include <OpenImageIO/imageio.h>

#include "fuzz/fuzz_file.h"
#include "lobelia/io/image_io.h"

using namespace lobelia;

// One thread: waiting for the library's own takes longer than small images do.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  OIIO::attribute("threads", 1);
  OIIO::attribute("exr_threads", -1);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("image.tga");
  return fuzz::check(file, data, size, [](const std::string& path) { io::readImage(path, {}); });
}
