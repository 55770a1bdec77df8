// MERL tables; inputs are too short to be whole ones.
#include "fuzz/fuzz_file.h"
#include "lobelia/io/merl_reader.h"

using namespace lobelia;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("table.binary");
  return fuzz::check(file, data, size, [](const std::string& path) { io::readMerl(path); });
}
