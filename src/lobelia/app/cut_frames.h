// Frames by visibility cuts, from whatever data there are: of light from infinity
// (relight/frame.h), of local lights and one bounce of theirs (relight/local_frame.h), or of both,
// whose pictures add up.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lobelia/relight/frame.h"
#include "lobelia/relight/local_frame.h"

namespace lobelia::app {

struct CutData {
  std::optional<relight::VisibilityData> environment, surfaces;
  // Of the data whose number is that of a scene's vertices: either.
  const relight::VisibilityData& any() const { return environment ? *environment : *surfaces; }
};
// Seconds: "data". Throws InputError like relight::load(), and UsageError for two files of a kind.
CutData loadCutData(const std::vector<std::string>& files, const Scene& scene, Context& context);
// Throws InputError, at `where`, when materials scatter where the data do not know the visibility.
void requireKnownSides(const CutData& data, const Scene& scene, const Location& where);
// What the frames will not show.
void warnOfMissing(const CutData& data, const Scene& scene, Context& context);

struct CutSettings {
  int spp = 1;
  size_t lightCut = 512;          // nodes
  double rotation = 0;            // of the light from infinity, degrees
  bool plainLobes = false;        // as the paper has it
  int areaPlaces = 4;             // of each area emitter, for shadow rays
  std::string component = "all";  // or "direct", "indirect"; light from infinity is direct
};

class CutFrames {
 public:
  // Keeps references.
  CutFrames(const Tracer& tracer, const CutData& data);
  // Emitters of the tracer's scene have changed. Seconds: "prepare".
  void relight(Context& context);
  void render(const CutSettings& settings, const Camera& camera, Film& film, Context& context);

 private:
  const Tracer& tracer_;
  const CutData& data_;
  std::unique_ptr<EmitterSampler> emitters_;
  std::optional<relight::FrameRenderer> distant_;
  std::optional<relight::LocalRenderer> local_;
};

}  // namespace lobelia::app
