// Scripts of `lobelia view`, and their edits of a scene of a few materials and lights: whatever
// they say, the scene stays one that can be rendered, and all of it can be undone.
#include <algorithm>

#include "fuzz/fuzz_file.h"
#include "fuzz/single_threaded_images.h"
#include "lobelia/app/studio/history.h"
#include "lobelia/app/studio/script_edits.h"
#include "lobelia/io/image_io.h"

using namespace lobelia;
using namespace lobelia::app;

namespace {

Scene smallScene() {
  Scene scene;
  for (const MaterialType type :
       {MaterialType::diffuse, MaterialType::principled, MaterialType::roughConductor}) {
    scene.materials.emplace_back().type = type;
    scene.materials.back().name = "m" + std::to_string(scene.materials.size());
  }
  scene.materials[0].name.clear();
  Material twoSided;
  twoSided.type = MaterialType::twoSided;
  twoSided.name = "sheet", twoSided.a = {0}, twoSided.b = {2};
  scene.materials.push_back(twoSided);
  scene.emitters.emplace_back().name = "lamp";
  scene.emitters.emplace_back().type = EmitterType::constant;
  scene.cameras.resize(1);
  return scene;
}

void requireSound(const Design& design) {
  Scene scene = sceneOf(design);
  for (size_t i = 0; i < design.images.size(); ++i)
    scene.images[design.sceneImages + i] = design.images[i]->pixels;
  const std::vector<Finding> findings = validate(scene);
  if (std::any_of(findings.begin(), findings.end(),
                  [](const Finding& f) { return f.severity == Severity::error; }))
    std::abort();
}

void play(const std::string& file, const Scene& scene) {
  History history(designOf(scene));
  const std::shared_ptr<const Design> first = history.share();
  size_t edits = 0;
  for (const ScriptStep& step : readScript(file)) {
    if (step.kind == ScriptStep::Kind::undo) history.undo();
    if (step.kind == ScriptStep::Kind::redo) history.redo();
    if (!isEdit(step.kind)) continue;
    try {
      history.edit(editName(step), [&](Design& d) { applyEdit(step, d); });
      ++edits;
    } catch (const InputError&) {
      // was said; later lines are tried as well
    }
    requireSound(history.now());
  }
  while (history.undo()) {
  }
  if (edits <= History::kMostSteps && history.share() != first) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static const fuzz::FuzzFile file("script.txt");
  static const Scene scene = smallScene();
  static const bool image = [] {
    const std::string path = file.write(reinterpret_cast<const uint8_t*>("frame"), 5);
    const std::string folder = std::filesystem::path(path).parent_path().string();
    io::writePng(folder + "/a.png", std::vector<uint8_t>{1, 2, 3}, 1, 1);
    return true;
  }();
  return image ? fuzz::check(file, data, size, [](const std::string& path) { play(path, scene); })
               : 0;
}
