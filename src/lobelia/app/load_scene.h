// A scene from a file or a built-in name, validated, with its findings reported.
#pragma once

#include <span>

#include "lobelia/app/render_options.h"
#include "lobelia/scene/scene.h"

namespace lobelia::app {

// Throws InputError for anything that makes the scene unusable (in strict mode: any warning).
// Findings of reading and of validation stay in Scene::findings; up to ten are reported to the
// context, the rest counted. Throws Cancelled when the context is.
Scene loadScene(const SceneOptions& options, Context& context);

// Up to ten warnings, the rest counted.
void reportFindings(std::span<const Finding> findings, Context& context);

}  // namespace lobelia::app
