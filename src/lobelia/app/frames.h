// The pictures of a run: one, or the frames of a camera path or a turntable.
#pragma once

#include <string>
#include <vector>

#include "lobelia/app/render_options.h"
#include "lobelia/scene/scene.h"

namespace lobelia::app {

struct Frame {
  int number = 0;  // from 0
  Camera camera;
  RenderOptions options;  // of this frame: its own names of files
};

// A frame's name of a file: its number in place of "%d", "%04d"..., or ".0012" before the
// extension.
std::string frameFile(const std::string& file, int number);
// Wrong use that shows without the scene, outputs that cannot be written among it. Throws
// UsageError.
void requireFrames(const RenderOptions& options);
// Throws UsageError when the scene has no such cameras or, unless the camera may stand still, no
// path.
std::vector<Frame> planFrames(const Scene& scene, const RenderOptions& options,
                              bool mayStandStill = false);

}  // namespace lobelia::app
