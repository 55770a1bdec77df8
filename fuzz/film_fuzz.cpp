// EXR pictures with all their layers, as `compare` reads them.
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
  static const fuzz::FuzzFile file("film.exr");
  return fuzz::check(file, data, size, [](const std::string& path) { io::readFilm(path); });
}
