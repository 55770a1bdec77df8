// Checkpoints of renders, taken for those of the right scene.
#include <cstring>

#include "fuzz/fuzz_file.h"
#include "fuzz/sealed_input.h"
#include "lobelia/app/checkpoint_file.h"

using namespace lobelia;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("render.checkpoint");
  app::RenderIdentity identity;
  identity.settings = {{"--seed", "0"}, {"--lights", "path"}};  // those of the corpus
  constexpr size_t kSceneHash = 32;  // where it stands (store/container.cpp)
  if (size >= kSceneHash + sizeof(identity.sceneHash))
    std::memcpy(&identity.sceneHash, data + kSceneHash, sizeof(identity.sceneHash));
  return fuzz::check(file, data, size, [&](const std::string& path) {
    Context context;
    std::vector<float> values(4);
    uint64_t position = 0;
    StateFields state;
    state.add("values", values);
    state.addValue("position", position);
    app::CheckpointFile checkpoint(path, identity, 1e9, true, context);
    if (checkpoint.load("stage", state)) checkpoint.restoreCounts();
  });
}
