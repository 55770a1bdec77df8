// A scene and a design on it, ready to be rendered: what the window's worker and headless frames
// share. For one thread.
//
// The scene's meshes stay; what designs have takes the place of the scene's own. Light, rays and
// masks are made anew where a design asks for it, and only there.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "lobelia/app/studio/design.h"
#include "lobelia/app/transfer_frames.h"
#include "lobelia/app/view_data.h"
#include "lobelia/film/film.h"

namespace lobelia::app {

class Stage {
 public:
  // data: files of `lobelia precompute`; none: methods without. Throws InputError, UsageError.
  // Seconds: "accel", "data".
  Stage(Scene scene, const std::vector<std::string>& data, Context& context);
  ~Stage();

  const Scene& scene() const { return scene_; }  // as it is shown now
  const Tracer& tracer() const { return *tracer_; }
  const EmitterSampler& emitters() const { return *emitters_; }
  const ViewData& data() const { return data_; }
  bool hasCuts() const { return data_.cuts.any() != nullptr; }
  bool hasTransfer() const { return data_.transfer.has_value(); }
  // Of the light that they show.
  int cutsDepth() const { return data_.cuts.surfaces ? 3 : 2; }
  int transferDepth() const { return 1 + transferPasses(); }
  int transferPasses() const {
    return hasTransfer() ? static_cast<int>(data_.transfer->passes.size()) : 0;
  }

  // What pictures are to be made of. Cuts and transfer turn the light themselves and keep emitters
  // as the design has them.
  enum class Use : uint8_t { cuts, transfer, paths, whiteCuts, whiteTransfer, whitePaths };
  // Shows a design. Transfer shows it with the materials of the scene as read, of which it was
  // made; where a design has others, that is said once, at `where`, and so are added lamps that
  // light nothing for want of data. Throws InputError, at `where`, when it is for cuts and changes
  // what visibility has to know, or for what there is no data of; whenever it throws, what was
  // shown before is shown still. Seconds: "prepare", "accel".
  void show(std::shared_ptr<const Design> design, Use use, const Location& where, Context& context);
  // Whether what is shown is usable; throws InputError, at `where`, with the first error.
  void requireValid(const Location& where) const;

  // Writes what differs from `first`, the scene as read, and the camera, which is the scene's of
  // its name, else its first; its film is left as the scene has it. Throws as io::writeDesign().
  void save(const std::string& file, const Design& first, const Camera& camera);

  // A frame by cuts into the film's layer "" (and "cost"). Needs data and a design shown for cuts.
  void renderCuts(const Camera& camera, const CutSettings& settings, Film& film, Context& context);
  // The same by transfer, without "cost". Needs a design shown for it.
  void renderTransfer(const Camera& camera, const TransferView& view, Film& film, Context& context);
  // A film of a pass by a progressive method, its picture composed. Throws Cancelled.
  Film renderPass(const Camera& camera, const RenderOptions& options, Context& context);

 private:
  void fill(const Design& design, Use use);
  void exchangeImages(const std::vector<std::shared_ptr<StoredImage>>& wanted);
  bool hasMasks() const;
  void requireCuts(uint64_t geometry, const Location& where) const;
  void requireTransfer(Use use, const Location& where) const;
  void sayOfMaterials(const Design& design, const Location& where, Context& context);
  void sayOfLamps(Use use, Context& context);
  void prepareRays(uint64_t geometry, bool masks);
  void prepareLight(Context& context);
  void prepareTransfer(Context& context);

  Scene scene_;
  const bool hideEmitters_;
  const size_t sceneImages_;
  const uint64_t geometry_;  // of the scene as read
  const ViewData data_;
  const std::vector<Material> materials_;  // of the scene as read, for transfer
  const std::vector<Texture> textures_;
  const uint64_t materialsHash_;
  bool saidOfMaterials_ = false;
  const size_t lampsAsRead_;
  bool saidOfLamps_[2] = {};  // for cuts, for transfer
  uint64_t tracedGeometry_;   // what tracer_ is made of
  bool masked_;               // is any of it?
  std::unique_ptr<Tracer> tracer_;
  std::unique_ptr<EmitterSampler> emitters_;
  bool lightStands_ = false;  // emitters_ and cuts_ are of the scene's emitters
  std::unique_ptr<CutFrames> cuts_;
  std::unique_ptr<TransferFrames> transfer_;
  bool transferLit_ = false;                         // by emitters_
  std::vector<std::shared_ptr<StoredImage>> taken_;  // whose pixels the scene has
  std::shared_ptr<const Design> shown_;
  Use use_ = Use::paths;
};

// white: of white surfaces.
Stage::Use useOf(ViewMethod method, bool white);

}  // namespace lobelia::app
