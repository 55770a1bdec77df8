#include "lobelia/app/studio/studio.h"

#include <fmt/format.h>

#include <cmath>
#include <exception>
#include <filesystem>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/studio/design_files.h"
#include "lobelia/app/studio/material_edits.h"
#include "lobelia/app/studio/material_fields.h"
#include "lobelia/app/studio/picture_maker.h"
#include "lobelia/app/studio/screenshot.h"
#include "lobelia/app/studio/stage_of_files.h"

namespace lobelia::app {
namespace {

std::string fileName(const std::string& file) {
  return std::filesystem::path(file).filename().string();
}

std::vector<std::string> inputsOf(const StudioSettings& settings) {
  std::vector<std::string> files = settings.data;
  files.insert(files.end(),
               {settings.scene.scene, settings.scene.design, settings.scene.environment});
  return files;
}

Design firstDesign(const Scene& scene, double rotation) {
  Design design = designOf(scene);
  design.rotation = std::fmod(rotation, 360);
  return design;
}

Bounds3f boundsOf(const Scene& scene, const Instance& instance) {
  Bounds3f box;
  const Mesh& mesh = scene[instance.mesh];
  for (const Vec3u& t : mesh.triangles)
    for (int i = 0; i < 3; ++i)
      if (const Vec3f p = instance.toWorld.point(mesh.positions[t[i]]); isFinite(p)) box.add(p);
  return box;
}

// Of one that an edit added and another has taken away.
void requireMaterial(const Design& design, uint32_t material) {
  if (material >= design.materials.size())
    throw InputError({}, "the material that the file was for is not there any more");
}

}  // namespace

Studio::Studio(const StudioSettings& settings, Context& context)
    : stage_(new Stage(stageOf(settings.scene, settings.data, context))),
      seed_(settings.seed),
      strict_(settings.scene.strict),
      inputs_(inputsOf(settings)),
      hasCuts_(stage_->hasCuts()),
      transferPasses_(stage_->transferPasses()),
      name_(stage_->scene().name),
      bounds_(stage_->tracer().bounds()),
      history_(firstDesign(stage_->scene(), settings.rotation)),
      first_(history_.share()),
      desk_(settings.wake) {
  view_.camera = history_.now().cameras.front();
  view_.cutsDepth = stage_->cutsDepth();
  view_.transferDepth = stage_->transferDepth();
  view_.method = hasCuts_ || transferPasses_ > 0 ? stage_->data().method : ViewMethod::path;
  warnOfMissing(stage_->data(), stage_->scene(), context);
  if (context.cancelled()) throw Cancelled{};
  thread_ = std::thread([this] { work(); });
}

Studio::~Studio() {
  desk_.stop();
  thread_.join();
}

const ViewData& Studio::data() const { return stage_->data(); }

void Studio::send() { desk_.want({history_.share(), view_}); }

void Studio::edit(const std::string& name, const std::function<void(Design&)>& change) {
  history_.edit(name, change);
  send();
}
void Studio::undo() {
  if (history_.undo()) send();
}
void Studio::redo() {
  if (history_.redo()) send();
}
void Studio::setView(const ViewState& view) {
  view_ = view;
  send();
}

void Studio::loadEnvironment(const std::string& file) {
  desk_.give([this, file](Stage&, Context&) {
    const auto image = readImageFile(file, false);
    desk_.arrive({"environment " + fileName(file),
                  nullptr,
                  [image](Design& d) { setEnvironment(d, image); },
                  {}});
  });
}

void Studio::loadTexture(const std::string& file, uint32_t material, const std::string& word) {
  FieldKind kind;
  try {
    requireMaterial(design(), material);
    kind = findTexturable(design(), material, word, {}).field->kind;
  } catch (const InputError& e) {
    return desk_.message(Severity::error, e.what());
  }
  desk_.give([=, this](Stage&, Context&) {
    const auto image = readImageFile(file, kind != FieldKind::color);
    desk_.arrive({word + " by " + fileName(file),
                  nullptr,
                  [=](Design& d) {
                    requireMaterial(d, material);
                    const FieldPlace place = findTexturable(d, material, word, {});
                    const TextureHandle texture = addBitmap(d, image);
                    setFieldTexture(d.materials[place.material], *place.field, texture);
                  },
                  {}});
  });
}

void Studio::loadBump(const std::string& file, uint32_t material, float scale) {
  desk_.give([=, this](Stage&, Context&) {
    const auto image = readImageFile(file, true);
    desk_.arrive({"bump map " + fileName(file),
                  nullptr,
                  [=](Design& d) {
                    requireMaterial(d, material);
                    setBump(d, material, addBitmap(d, image), scale);
                  },
                  {}});
  });
}

void Studio::loadNormalMap(const std::string& file, uint32_t material) {
  desk_.give([=, this](Stage&, Context&) {
    const auto image = readImageFile(file, true);
    desk_.arrive({"normal map " + fileName(file),
                  nullptr,
                  [=](Design& d) {
                    requireMaterial(d, material);
                    setNormalMap(d, material, addBitmap(d, image));
                  },
                  {}});
  });
}

void Studio::loadDesign(const std::string& file) {
  const std::shared_ptr<const Design> base = history_.share();
  desk_.give([this, file, base](Stage& stage, Context& context) {
    ReadDesign read = readDesign(*base, file, strict_, context);
    stage.show(read.design, Stage::Use::paths, {file, 0, 0}, context);
    stage.requireValid({file, 0, 0});
    desk_.arrive({"design " + fileName(file), base,
                  [this, read](Design& d) {
                    d = *read.design;
                    if (read.parts.emitters) d.rotation = 0;
                    if (read.parts.cameras) view_.camera = d.cameras.at(read.camera);
                  },
                  [this, file] { loadDesign(file); }});
  });
}

void Studio::saveDesign(const std::string& file, const Camera& camera) {
  desk_.give([this, file, now = history_.share(), camera](Stage& stage, Context& context) {
    requireNoInput({file}, inputs_);
    stage.show(now, Stage::Use::paths, {}, context);
    stage.save(file, *first_, camera);
    context.info("wrote " + file);
  });
}

void Studio::screenshot(const std::string& file, const DisplaySettings& display) {
  const std::shared_ptr<const Picture> picture = newestPicture();
  // As it is shown: the truth of an earlier split is none.
  const auto truth = display.split >= 0 ? newestTruth() : nullptr;
  desk_.give([this, file, display, picture, truth](Stage&, Context& context) {
    if (!picture) throw UsageError("there is no picture yet");
    requireNoInput({file}, inputs_);
    writeScreenshot(file, *picture, truth.get(), display);
    context.info("wrote " + file);
  });
}

void Studio::pick(Vec2f place) {
  const Camera camera = viewCamera(view_);
  desk_.give([this, camera, place](Stage& stage, Context&) {
    const Vec2f film{place.x * static_cast<float>(camera.width),
                     place.y * static_cast<float>(camera.height)};
    const std::optional<Hit> hit =
        stage.tracer().intersect(generateRay(camera, film, {0.5f, 0.5f}));
    auto picked = std::make_shared<Picked>();
    picked->place = place;
    if (hit) {
      const SurfacePoint at = surfacePoint(stage.scene(), *hit);
      const Instance& instance = stage.scene().instances[hit->instance];
      picked->hit = true;
      picked->point = at.p;
      picked->normal = at.ng;
      picked->bounds = boundsOf(stage.scene(), instance);
      picked->material = instance.material;
      picked->emitter = instance.emitter;
    }
    {
      const std::scoped_lock lock(pickedMutex_);
      picked_ = std::move(picked);
    }
    desk_.ring();
  });
}

std::shared_ptr<const Picked> Studio::takePicked() {
  const std::scoped_lock lock(pickedMutex_);
  return std::exchange(picked_, nullptr);
}

bool Studio::update() {
  bool changed = false;
  for (Arrival& arrival : desk_.takeArrivals()) {
    if (arrival.base && arrival.base != history_.share()) {
      arrival.again();
      continue;
    }
    try {
      history_.endEdit();
      history_.edit(arrival.name, arrival.change);
      history_.endEdit();
      changed = true;
    } catch (const std::exception& e) {
      desk_.message(Severity::error, e.what());
    }
  }
  if (changed) send();
  return changed;
}

void Studio::work() {
  PictureMaker maker(*stage_, first_, seed_);
  Job job;
  Wanted wanted;
  for (;;) {
    switch (desk_.next(maker.next() != PictureMaker::Step::none, !maker.isDone(), &job, &wanted)) {
      case Desk::Task::stop:
        return;
      case Desk::Task::job:
        workJob(std::exchange(job, {}));
        break;
      case Desk::Task::wanted:
        // A truth of something else would pass for this one's.
        if (!maker.truthStands(wanted.design, wanted.view) && desk_.truth())
          desk_.publish(nullptr, true);
        maker.want(std::move(wanted.design), wanted.view);
        break;
      case Desk::Task::go:
        workOn(maker);
        break;
    }
  }
}

void Studio::workOn(PictureMaker& maker) {
  using Step = PictureMaker::Step;
  const Step step = maker.next();
  Context context(&desk_);
  if (!desk_.begin(context, maker.isFirst(step))) return;
  try {
    const std::shared_ptr<const Picture> picture = maker.run(step, context);
    desk_.end();
    desk_.publish(picture, step == Step::truth);
    return;
  } catch (const Cancelled&) {  // something else is wanted
  } catch (const std::exception& e) {
    desk_.message(Severity::error, e.what());
    maker.giveUp(step);
  }
  desk_.end();
}

void Studio::workJob(const Job& job) {
  Context context(&desk_);
  desk_.beginJob(context);
  try {
    job(*stage_, context);
  } catch (const Cancelled&) {
  } catch (const std::exception& e) {
    desk_.message(Severity::error, e.what());
  }
  desk_.endJob();
}

}  // namespace lobelia::app
