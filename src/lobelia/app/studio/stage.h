// A scene and a design on it, ready to be rendered: what the window's worker and headless frames
// share. For one thread.
//
// The scene's meshes stay; what designs have takes the place of the scene's own. Light, rays and
// masks are made anew where a design asks for it, and only there.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "lobelia/app/cut_frames.h"
#include "lobelia/app/studio/design.h"
#include "lobelia/app/studio/view_state.h"
#include "lobelia/film/film.h"

namespace lobelia::app {

class Stage {
 public:
  // data: files of `lobelia precompute`; none: no cuts. Throws InputError, UsageError. Seconds:
  // "accel", "data".
  Stage(Scene scene, const std::vector<std::string>& data, Context& context);
  ~Stage();

  const Scene& scene() const { return scene_; }  // as it is shown now
  const Tracer& tracer() const { return *tracer_; }
  const EmitterSampler& emitters() const { return *emitters_; }
  const CutData& data() const { return data_; }
  bool hasCuts() const { return data_.any() != nullptr; }
  int cutsDepth() const { return data_.surfaces ? 3 : 2; }  // of the light that cuts show

  // What pictures are to be made of. Cuts turn the light themselves and keep emitters as the design
  // has them.
  enum class Use : uint8_t { cuts, paths, whiteCuts, whitePaths };
  // Shows a design. Throws InputError, at `where`, when it is for cuts and changes what visibility
  // has to know; whenever it
  // throws, what was shown before is shown still. Seconds: "prepare", "accel".
  void show(std::shared_ptr<const Design> design, Use use, const Location& where, Context& context);
  // Whether what is shown is usable; throws InputError, at `where`, with the first error.
  void requireValid(const Location& where) const;

  // Writes what differs from `first`, the scene as read, and the camera, which is the scene's of
  // its name, else its first; its film is left as the scene has it. Throws as io::writeDesign().
  void save(const std::string& file, const Design& first, const Camera& camera);

  // A frame by cuts into the film's layer "" (and "cost"). Needs data and a design shown for cuts.
  void renderCuts(const Camera& camera, const CutSettings& settings, Film& film, Context& context);
  // A film of a pass by a progressive method, its picture composed. Throws Cancelled.
  Film renderPass(const Camera& camera, const RenderOptions& options, Context& context);

 private:
  void fill(const Design& design, Use use);
  void exchangeImages(const std::vector<std::shared_ptr<StoredImage>>& wanted);
  bool hasMasks() const;
  void requireCuts(uint64_t geometry, const Location& where) const;
  void prepareRays(uint64_t geometry, bool masks);
  void prepareLight(Context& context);

  Scene scene_;
  const bool hideEmitters_;
  const size_t sceneImages_;
  const uint64_t geometry_;  // of the scene as read
  const CutData data_;
  uint64_t tracedGeometry_;  // what tracer_ is made of
  bool masked_;              // is any of it?
  std::unique_ptr<Tracer> tracer_;
  std::unique_ptr<EmitterSampler> emitters_;
  bool lightStands_ = false;  // emitters_ and cuts_ are of the scene's emitters
  std::unique_ptr<CutFrames> cuts_;
  std::vector<std::shared_ptr<StoredImage>> taken_;  // whose pixels the scene has
  std::shared_ptr<const Design> shown_;
  Use use_ = Use::paths;
};

}  // namespace lobelia::app
