// Saved virtual lights.
#include "fuzz/fuzz_file.h"
#include "fuzz/sealed_input.h"
#include "lobelia/lights/light_pass.h"

using namespace lobelia;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("lights.lights");
  return fuzz::check(file, data, size, [](const std::string& path) { loadLights(path, 0); });
}
