// EXR pictures with all their layers, as `compare` reads them.
#include "fuzz/fuzz_file.h"
#include "fuzz/single_threaded_images.h"
#include "lobelia/io/image_io.h"

using namespace lobelia;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("film.exr");
  return fuzz::check(file, data, size, [](const std::string& path) { io::readFilm(path); });
}
