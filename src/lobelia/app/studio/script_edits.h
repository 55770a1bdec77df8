// Edits as scripts say them (view_script.h), for a design.
#pragma once

#include "lobelia/app/studio/design.h"
#include "lobelia/app/view_script.h"

namespace lobelia::app {

// Is the step one of material, texture, bump, normalMap, emitter, light?
bool isEdit(ScriptStep::Kind kind);
// What its edit is called in a history.
std::string editName(const ScriptStep& step);
// Does what the step says. Throws InputError at its place: unknown names (with near ones), fields,
// values out of their range, images that cannot be read.
void applyEdit(const ScriptStep& step, Design& design);

}  // namespace lobelia::app
