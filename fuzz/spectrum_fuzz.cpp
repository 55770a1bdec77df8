// Text files of wavelengths and values.
#include "fuzz/fuzz_file.h"
#include "lobelia/io/spectrum.h"

using namespace lobelia;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("spectrum.spd");
  return fuzz::check(file, data, size, [](const std::string& path) { io::readSpectrum(path, {}); });
}
