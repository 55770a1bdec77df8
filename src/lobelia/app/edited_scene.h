// A scene and the edits of a script to it (view_script.h).
//
// An edit says what something is, not how it changes: one that comes again counts as of then. So
// the scene is always what was read and the different edits in the order in which each came last:
// however many there are, it holds no more than they do.
#pragma once

#include <vector>

#include "lobelia/app/view_script.h"
#include "lobelia/base/context.h"
#include "lobelia/io/design.h"

namespace lobelia::app {

class EditedScene {
 public:
  // strict: warnings of edits are errors.
  EditedScene(Scene scene, bool strict);
  const Scene& scene() const { return scene_; }
  // step: design or environment. Throws InputError with the step's place and the edit's own; of
  // edits that make the scene unusable, too. Warnings go to the context. Returns what it is of.
  io::DesignParts change(const ScriptStep& step, Context& context);

 private:
  io::DesignParts apply(const ScriptStep& step, Context& context);

  Scene scene_;
  // As read.
  const std::vector<Material> materials_;
  const std::vector<Emitter> emitters_;
  const std::vector<Camera> cameras_;
  const size_t imageCount_, textureCount_, findingCount_;
  const bool strict_;
  std::vector<ScriptStep> edits_;
};

}  // namespace lobelia::app
