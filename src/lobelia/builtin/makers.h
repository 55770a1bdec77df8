// The makers of the built-in scenes (internal to this room).
#pragma once

#include "lobelia/scene/scene.h"

namespace lobelia::builtin {

Scene makeCornell(float detail);
Scene makeStudyDiffuse(float detail);
Scene makeStudyPhong(float detail);
Scene makeStudyGgx(float detail);
Scene makeStudyPane(float detail);
Scene makeStudyMirror(float detail);
Scene makeStudyRoom(float detail);

Scene makeBox(float detail);
enum class TableauFloor : uint8_t { constant, stripes, ward };
Scene makeTableau(float detail, TableauFloor floor);

}  // namespace lobelia::builtin
