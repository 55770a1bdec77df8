// `--replay X,Y`: one pixel, all its samples, same bits as in the whole picture, and on standard
// output what they did.
#pragma once

#include "lobelia/app/render_frame.h"

namespace lobelia::app {

// Wrong use that shows without the scene. Throws UsageError.
void requireReplay(const RenderOptions& options);
// all: prints every sample, not the first ones only.
void replay(const Frame& frame, FrameRun& run, bool all, Context& context);

}  // namespace lobelia::app
