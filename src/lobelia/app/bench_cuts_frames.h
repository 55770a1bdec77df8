// Frames by visibility cuts beside path-traced pictures: figures 6 and 10.
#pragma once

#include "lobelia/app/bench_cuts.h"

namespace lobelia::app {

// 1 where the middle of a pixel and those of its neighbours see a surface: edges against the
// background are no error of the method.
Film objectsOf(const Tracer& tracer, const Camera& camera);

struct FrameOptions {
  size_t nodes = 512;  // of the light cut
  bool refined = true;
  int spp = 16;
};
Film cutsFrame(relight::FrameRenderer& renderer, const BenchScene& scene,
               const FrameOptions& options, Context& context);

}  // namespace lobelia::app
