// Scripts of `lobelia view --headless --script FILE`: camera moves, edits and frames, one a line.
//
//   design FILE                          materials, emitters and cameras of a design (io/design.h)
//   environment FILE                     another environment
//   rotate DEGREES, turn DEGREES         light from infinity, from where the scene has it; further
//   camera OX,OY,OZ TX,TY,TZ [UX,UY,UZ]  the camera at an origin, towards a target
//   frame [N]                            so many frames (1)
//
// Empty lines and what follows a # (at the beginning or after a blank) mean nothing. Files are
// sought from the script's folder; their names may have blanks.
#pragma once

#include <string>
#include <vector>

#include "lobelia/base/error.h"
#include "lobelia/base/transform.h"

namespace lobelia::app {

struct ScriptStep {
  enum class Kind : uint8_t { design, environment, rotate, turn, camera, frame };
  Kind kind = Kind::frame;
  Location where;
  std::string file;    // design, environment
  double degrees = 0;  // rotate, turn
  Transform toWorld;   // camera
  int count = 1;       // frame
};

// Throws InputError with the line: a file that cannot be read, unknown words, missing, wrong or
// surplus values; a script without a frame.
std::vector<ScriptStep> readScript(const std::string& file);
int frameCount(const std::vector<ScriptStep>& script);

}  // namespace lobelia::app
