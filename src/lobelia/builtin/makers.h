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
Scene makeStudyCorners(float detail);
Scene makeStudyWard(float detail);
Scene makeStudyRoom(float detail);
Scene makeKitchen(float detail);
Scene makeKitchenStove(float detail);
Scene makeKitchenView2(float detail);

Scene makeBox(float detail);
enum class TableauFloor : uint8_t { constant, stripes, card, satin, ward };
Scene makeTableau(float detail, TableauFloor floor);
Scene makeTreasure(float detail);
Scene makeHall(float detail);
Scene makeTeapot(float detail, float exponent);
Scene makeGlasses(float detail);
Scene makeBird(float detail);
Scene makeDragon(float detail);
Scene makeRoom(float detail);

// Of the size of the scenes in [P004 figure 9].
Scene makeStatue(float detail);
Scene makeMachine(float detail);
Scene makePlants(float detail);
Scene makeTeapotLamp(float detail);
Scene makeDining(float detail);
Scene makeBedroom(float detail);

}  // namespace lobelia::builtin
