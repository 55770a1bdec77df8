// IES photometric profiles (LM-63).
#include "fuzz/fuzz_file.h"
#include "lobelia/io/ies_reader.h"

using namespace lobelia;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("lamp.ies");
  return fuzz::check(file, data, size, [](const std::string& path) {
    std::vector<Finding> findings;
    io::iesImage(io::readIes(path, {}, findings), path);
  });
}
