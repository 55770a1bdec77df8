// Scripts of `lobelia view --headless --script FILE`: camera moves, edits and frames, one a line.
//
//   design FILE                          materials, emitters and cameras of a design (io/design.h)
//   environment FILE                     another environment
//   rotate DEGREES, turn DEGREES         light from infinity, from where the scene has it; further
//   camera OX,OY,OZ TX,TY,TZ [UX,UY,UZ]  the camera at an origin, towards a target
//   frame [N]                            so many frames (1)
//
//   material NAME FIELD VALUE            a colour r,g,b, a number, a word, on or off
//   material NAME type TYPE
//   texture NAME FIELD FILE
//   bump NAME FILE [SCALE], normal-map NAME FILE
//   emitter NAME FIELD VALUE
//   light add TYPE X,Y,Z R,G,B [NAME]    point, spot, directional (X,Y,Z: where to), constant
//   light remove NAME                    one that was added
//   undo, redo
//   save FILE                            the design
//   method NAME [PASSES]                 cuts, transfer, or how many passes a frame has
//   bounce N                             of transfer, light of so many reflections alone; all
//   truth N                              so many samples by path tracing, for errors and splits
//   false-colour KIND [LEAST MOST]       of screenshots: luminance...; off
//   split SHARE                          of screenshots: the truth right of it; off
//   screenshot FILE                      the last frame
//
// Empty lines and what follows a # (at the beginning or after a blank) mean nothing. Files are
// sought from the script's folder; their names may have blanks where they end the line, and any
// word may stand in double quotes. Names: those of designs ("material[7]").
#pragma once

#include <string>
#include <vector>

#include "lobelia/base/error.h"
#include "lobelia/base/transform.h"

namespace lobelia::app {

struct ScriptStep {
  enum class Kind : uint8_t {
    design,
    environment,
    rotate,
    turn,
    camera,
    frame,
    material,
    texture,
    bump,
    normalMap,
    emitter,
    light,
    undo,
    redo,
    save,
    method,
    bounce,
    truth,
    falseColour,
    split,
    screenshot
  };
  Kind kind = Kind::frame;
  Location where;
  std::string file;                // of those with one
  double degrees = 0;              // rotate, turn
  Transform toWorld;               // camera
  int count = 1;                   // frame, truth; passes of method; bounce (-1: all)
  std::vector<std::string> words;  // of the others, as they stand but for the command and the file
};

// Throws InputError with the line: a file that cannot be read, unknown words, missing, wrong or
// surplus values; a script without a frame.
std::vector<ScriptStep> readScript(const std::string& file);
int frameCount(const std::vector<ScriptStep>& script);

// Values of scripts. Throw InputError.
double scriptNumber(const std::string& text, const Location& where);
Vec3d scriptVector(const std::string& text, const Location& where);

}  // namespace lobelia::app
