// Frames by precomputed transfer (transfer/frame.h), beside those by cuts (cut_frames.h): light
// from infinity with all its reflections, on the materials of which the data was made.
#pragma once

#include <string>
#include <utility>

#include "lobelia/transfer/frame.h"

namespace lobelia::app {

struct TransferView {
  int spp = 1;
  double rotation = 0;            // of the light from infinity, degrees
  std::string component = "all";  // or "direct", "indirect"
  int bounce = -1;                // light of so many reflections at other surfaces alone; -1: all
};

// What transfer will not show of the scene: of its light, and of surfaces that transmit.
void warnOfMissing(const Scene& scene, Context& context);
// Why data of so many passes (0: there is none) has not this bounce (-1 is all), or "".
std::string whyNoBounce(int bounce, int passes);
// Throws UsageError for a bounce that data of so many passes (0: there is none) has not; -1 is all.
void requireBounce(int bounce, int passes);
// [first, end) of the passes that a view shows.
std::pair<int, int> passesOf(const TransferView& view);

class TransferFrames {
 public:
  // Keeps references. The scene has the materials of which the data was made.
  TransferFrames(const Tracer& tracer, const transfer::TransferData& data);
  // Before the first frame, and when the emitters of the tracer's scene have changed, of which
  // `emitters` is made.
  void relight(const EmitterSampler& emitters);
  // Emission that is seen is direct light. Throws Cancelled.
  void render(const TransferView& view, const Camera& camera, Film& film, Context& context);

 private:
  const Tracer& tracer_;
  transfer::TransferRenderer renderer_;
};

}  // namespace lobelia::app
