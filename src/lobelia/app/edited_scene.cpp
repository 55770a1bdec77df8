#include "lobelia/app/edited_scene.h"

#include <algorithm>

#include "lobelia/app/load_scene.h"

namespace lobelia::app {

EditedScene::EditedScene(Scene scene, bool strict)
    : scene_(std::move(scene)),
      materials_(scene_.materials),
      emitters_(scene_.emitters),
      cameras_(scene_.cameras),
      imageCount_(scene_.images.size()),
      textureCount_(scene_.textures.size()),
      findingCount_(scene_.findings.size()),
      strict_(strict) {}

io::DesignParts EditedScene::change(const ScriptStep& step, Context& context) {
  std::erase_if(edits_, [&](const ScriptStep& other) {
    return other.kind == step.kind && other.file == step.file;
  });
  edits_.push_back(step);
  scene_.materials = materials_;
  scene_.emitters = emitters_;
  scene_.cameras = cameras_;
  scene_.images.resize(imageCount_);
  scene_.textures.resize(textureCount_);
  io::DesignParts parts;
  size_t known = 0;
  for (const ScriptStep& edit : edits_) {
    known = scene_.findings.size();
    try {
      parts = apply(edit, context);
    } catch (const InputError& e) {
      throw InputError(step.where, e.what());
    }
  }
  // What earlier edits had to say has been said.
  reportFindings(std::span(scene_.findings).subspan(known), context);
  scene_.findings.resize(findingCount_);
  for (const Finding& finding : validate(scene_))
    if (finding.severity == Severity::error) throw InputError(step.where, finding.message);
  return parts;
}

io::DesignParts EditedScene::apply(const ScriptStep& step, Context& context) {
  io::ReadSettings settings;
  settings.strict = strict_;
  if (step.kind == ScriptStep::Kind::design)
    return io::applyDesign(step.file, settings, scene_, context);
  settings.environment = step.file;
  io::applyEnvironment(scene_, settings);
  return {.emitters = true};
}

}  // namespace lobelia::app
