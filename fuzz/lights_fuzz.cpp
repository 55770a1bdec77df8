// Saved virtual lights, taken for those of the right scene.
#include <cstring>

#include "fuzz/fuzz_file.h"
#include "fuzz/sealed_input.h"
#include "lobelia/lights/light_pass.h"

using namespace lobelia;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("lights.lights");
  constexpr size_t kSceneHash = 32;  // where it stands (store/container.cpp)
  uint64_t sceneHash = 0;
  if (size >= kSceneHash + sizeof(sceneHash))
    std::memcpy(&sceneHash, data + kSceneHash, sizeof(sceneHash));
  return fuzz::check(file, data, size,
                     [&](const std::string& path) { loadLights(path, sceneHash); });
}
