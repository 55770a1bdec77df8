#include "lobelia/app/studio/stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/render_frame.h"
#include "lobelia/io/design.h"
#include "lobelia/relight/local_sources.h"

namespace lobelia::app {
namespace {

bool forCuts(Stage::Use use) { return use == Stage::Use::cuts || use == Stage::Use::whiteCuts; }
bool forTransfer(Stage::Use use) {
  return use == Stage::Use::transfer || use == Stage::Use::whiteTransfer;
}
bool isWhite(Stage::Use use) {
  return use == Stage::Use::whiteCuts || use == Stage::Use::whiteTransfer ||
         use == Stage::Use::whitePaths;
}

// Every surface white and diffuse on the sides on which it scattered; masks stay.
void whiten(std::vector<Material>& materials) {
  for (Material& m : materials) {
    switch (m.type) {
      case MaterialType::twoSided:
      case MaterialType::mask:
      case MaterialType::blend:
      case MaterialType::null:
        break;
      case MaterialType::bump:  // the place's normal counts, not the map's
      case MaterialType::normalMap:
        m.map = {};
        break;
      default:
        m = Material{};
        m.diffuse = Rgb(1.f);
    }
  }
}

// Emitters that are not at infinity.
size_t lampCount(const Scene& scene) {
  return static_cast<size_t>(
      std::count_if(scene.emitters.begin(), scene.emitters.end(),
                    [](const Emitter& e) { return relight::isLocal(e.type); }));
}

}  // namespace

Stage::Stage(Scene scene, const std::vector<std::string>& data, Context& context)
    : scene_(std::move(scene)),
      hideEmitters_(scene_.hideEmitters),
      sceneImages_(scene_.images.size()),
      geometry_(relight::geometryHash(scene_)),
      data_(loadViewData(data, scene_, context)),
      materials_(scene_.materials),
      textures_(scene_.textures),
      materialsHash_(materialsHash(designOf(scene_))),
      lampsAsRead_(lampCount(scene_)),
      tracedGeometry_(geometry_),
      masked_(hasMasks()),
      tracer_(std::make_unique<Tracer>(scene_, context)) {
  prepareLight(context);
}

Stage::~Stage() { exchangeImages({}); }

bool Stage::hasMasks() const {
  return std::any_of(scene_.instances.begin(), scene_.instances.end(),
                     [&](const Instance& i) { return hasOpacity(scene_, i.material); });
}

void Stage::exchangeImages(const std::vector<std::shared_ptr<StoredImage>>& wanted) {
  for (size_t i = 0; i < taken_.size(); ++i)
    taken_[i]->pixels = std::move(scene_.images[sceneImages_ + i]);
  scene_.images.resize(sceneImages_);
  taken_ = wanted;
  for (const auto& image : taken_) scene_.images.push_back(std::move(image->pixels));
}

void Stage::fill(const Design& design, Use use) {
  const bool sameImages = taken_ == design.images;
  if (!sameImages) exchangeImages(design.images);
  scene_.materials = design.materials;
  scene_.textures = design.textures;
  if (forTransfer(use)) {
    scene_.materials = materials_;
    std::copy(textures_.begin(), textures_.end(), scene_.textures.begin());  // others stand behind
  }
  scene_.cameras = design.cameras;
  scene_.hideEmitters = hideEmitters_ || isWhite(use);
  if (isWhite(use)) whiten(scene_.materials);
  std::vector<Emitter> emitters =
      forCuts(use) || forTransfer(use) ? design.emitters : turnedEmitters(design, design.rotation);
  const bool same = sameImages && sameLight(emitters, scene_.emitters);
  if (same) return;  // in the same memory
  scene_.emitters = std::move(emitters);
  lightStands_ = false;
}

void Stage::requireCuts(uint64_t geometry, const Location& where) const {
  if (!hasCuts())
    throw InputError(where,
                     "there is no data of visibility; name it with --data, or choose "
                     "another method");
  requireKnownSides(data_.cuts, scene_, where);
  if (geometry != geometry_)
    throw InputError(where,
                     "this changes which parts of surfaces are masked out, which the visibility "
                     "has to know; make a scene with it and precompute that");
}

void Stage::requireTransfer(Use use, const Location& where) const {
  if (!hasTransfer())
    throw InputError(where,
                     "there is no data of transfer (`lobelia precompute --method vmf`); name it "
                     "with --data, or choose another method");
  if (isWhite(use))
    throw InputError(where,
                     "transfer has the scene's own materials, not white ones, which illuminance is "
                     "measured on; choose another method");
}

void Stage::sayOfMaterials(const Design& design, const Location& where, Context& context) {
  if (saidOfMaterials_ || materialsHash(design) == materialsHash_) return;
  saidOfMaterials_ = true;
  const std::string place = where.file.empty() ? "" : toString(where) + ": ";
  const std::vector<std::string> changed = io::changedMaterials(materials_, design.materials);
  context.warning(
      fmt::format("{}transfer shows the materials as they were when it was precomputed; other "
                  "methods show what "
                  "was changed{}",
                  place, changed.empty() ? " of them" : fmt::format(": {}", someOf(changed))));
}

// Those of the scene as read are said to light nothing before frames (warnOfMissing).
void Stage::sayOfLamps(Use use, Context& context) {
  const bool without = forTransfer(use) || (forCuts(use) && !data_.cuts.surfaces);
  bool& said = saidOfLamps_[forTransfer(use) ? 1 : 0];
  if (!without || said || lampCount(scene_) <= lampsAsRead_) return;
  said = true;
  context.warning(
      forTransfer(use)
          ? "transfer has light from infinity alone: lamps that were added light nothing; other "
            "methods show their light"
          : "lamps that were added light nothing: the data are of light from infinity; add --data "
            "of `lobelia precompute --light surfaces`, or choose another method");
}

void Stage::show(std::shared_ptr<const Design> design, Use use, const Location& where,
                 Context& context) {
  if (shown_ == design && use_ == use) return;
  try {
    fill(*design, use);
    // Without masks, now and in what rays meet, nothing of it can have changed.
    const bool masks = hasMasks();
    const uint64_t geometry = masks || masked_ ? relight::geometryHash(scene_) : tracedGeometry_;
    if (forCuts(use)) requireCuts(geometry, where);
    if (forTransfer(use)) requireTransfer(use, where);
    if (geometry != tracedGeometry_) prepareRays(geometry, masks);
    if (!lightStands_) prepareLight(context);
    if (forTransfer(use)) {
      if (!transferLit_) prepareTransfer(context);
      sayOfMaterials(*design, where, context);
    }
    sayOfLamps(use, context);
  } catch (...) {
    // Should that fail as well, nothing is shown, and the next design is prepared as a whole.
    if (auto before = std::exchange(shown_, nullptr)) show(std::move(before), use_, where, context);
    throw;
  }
  shown_ = std::move(design);
  use_ = use;
}

// Whoever cancels a picture does not want its rays half made: they have a context of their own.
void Stage::prepareRays(uint64_t geometry, bool masks) {
  Context own;
  auto tracer = std::make_unique<Tracer>(scene_, own);
  cuts_.reset(), transfer_.reset(), emitters_.reset();
  lightStands_ = false;
  tracer_ = std::move(tracer);
  tracedGeometry_ = geometry, masked_ = masks;
}

void Stage::prepareLight(Context& context) {
  const StageTimer timer(context, "prepare");
  lightStands_ = transferLit_ = false;
  auto emitters = std::make_unique<EmitterSampler>(scene_, tracer_->bounds());
  if (hasCuts()) {
    if (!cuts_) cuts_ = std::make_unique<CutFrames>(*tracer_, data_.cuts);
    cuts_->relight(*emitters);
  }
  emitters_ = std::move(emitters);
  lightStands_ = true;
}

// When the scene has the materials of the data, and only for who looks at transfer: it takes longer
// than light for cuts.
void Stage::prepareTransfer(Context& context) {
  const StageTimer timer(context, "prepare");
  if (!transfer_) transfer_ = std::make_unique<TransferFrames>(*tracer_, *data_.transfer);
  transfer_->relight(*emitters_);
  transferLit_ = true;
}

void Stage::requireValid(const Location& where) const {
  for (const Finding& finding : validate(scene_))
    if (finding.severity == Severity::error) throw InputError(where, finding.message);
}

void Stage::save(const std::string& file, const Design& first, const Camera& camera) {
  Scene before = sceneOf(first);
  before.instances = scene_.instances;
  const std::vector<Camera> cameras = scene_.cameras;
  const auto named = std::find_if(cameras.begin(), cameras.end(),
                                  [&](const Camera& c) { return c.name == camera.name; });
  const size_t at = named != cameras.end() ? static_cast<size_t>(named - cameras.begin()) : 0;
  if (at < cameras.size()) {
    const Camera& old = cameras[at];
    Camera& now = scene_.cameras[at];
    now = camera;
    now.name = old.name, now.width = old.width, now.height = old.height;
    now.cropX0 = old.cropX0, now.cropX1 = old.cropX1;
    now.cropY0 = old.cropY0, now.cropY1 = old.cropY1;
    if (now.toWorld.to == old.toWorld.to) now.path = old.path;
  }
  try {
    io::writeDesign(file, before, scene_);
  } catch (...) {
    scene_.cameras = cameras;
    throw;
  }
  scene_.cameras = cameras;
}

void Stage::renderCuts(const Camera& camera, const CutSettings& settings, Film& film,
                       Context& context) {
  cuts_->render(settings, camera, film, context);
}

void Stage::renderTransfer(const Camera& camera, const TransferView& view, Film& film,
                           Context& context) {
  transfer_->render(view, camera, film, context);
}

Film Stage::renderPass(const Camera& camera, const RenderOptions& options, Context& context) {
  static const std::string kNoCommand;
  FrameRun run{scene_, *tracer_, *emitters_, kNoCommand, nullptr, {}, {}};
  RenderedFilm rendered = renderFilm({0, camera, options}, run, context);
  if (context.cancelled()) throw Cancelled{};
  return std::move(rendered.film);
}

Stage::Use useOf(ViewMethod method, bool white) {
  using Use = Stage::Use;
  switch (method) {
    case ViewMethod::cuts:
      return white ? Use::whiteCuts : Use::cuts;
    case ViewMethod::transfer:
      return white ? Use::whiteTransfer : Use::transfer;
    default:
      return white ? Use::whitePaths : Use::paths;
  }
}

}  // namespace lobelia::app
