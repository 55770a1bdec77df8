#include "lobelia/app/viewer/window/viewer.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <imgui.h>

#include <utility>

#include "lobelia/app/transfer_frames.h"
#include "lobelia/app/view_checks.h"
#include "lobelia/app/viewer/window/panels.h"
#include "lobelia/io/image_io.h"

namespace lobelia::app {
namespace {

// Seconds asleep at most: while something moves, and else, for what shows by itself. Input and the
// engine end either.
constexpr double kSettling = 1 / 60., kIdle = 0.5;
constexpr int kSettlingFrames = 3;  // Dear ImGui shows some things a frame late

// By name or, as `render` takes it, by index. Throws UsageError when there is none.
const Camera& cameraNamed(const std::vector<Camera>& cameras, const std::string& name) {
  std::vector<std::string> known;
  for (const Camera& camera : cameras) {
    if (camera.name == name || std::to_string(known.size()) == name) return camera;
    known.push_back(camera.name.empty() ? std::to_string(known.size()) : camera.name);
  }
  throw UsageError(fmt::format("--camera '{}': the scene has {}{}", name, fmt::join(known, ", "),
                               suggestion(name, known)));
}

}  // namespace

Viewer::Viewer(const ViewOptions& options, Studio& studio, Surface& surface, Context& context)
    : context_(context),
      surface_(surface),
      studio_(studio),
      ui_(studio, options.render.camera.empty()
                      ? studio.view().camera
                      : cameraNamed(studio.design().cameras, options.render.camera)) {
  requireBounce(options.bounce, studio.transferPasses());
  warnOfOptions(options, studio.data(), context);
  UiState& ui = ui_.state();
  ui.view.lightCut = options.lightCut;
  ui.view.refined = !options.plainLobes;
  ui.view.areaPlaces = options.areaPlaces;
  ui.view.component = options.render.component;
  ui.view.bounce = options.bounce;
  ui.display.exposure = options.render.exposure;
  if (options.render.spp > 0) ui.view.spp = options.render.spp;
  if (!options.uiScript.empty()) player_.emplace(readUiScript(options.uiScript), stage());
}

void Viewer::run() {
  int settling = kSettlingFrames;
  while (!surface_.closing() && !context_.cancelled() && !(player_ && player_->finished())) {
    if (player_) settling = kSettlingFrames;
    surface_.wait(settling > 0 ? kSettling : kIdle);
    if (studio_.takeNews()) settling = kSettlingFrames;
    for (const std::string& file : surface_.takeDropped()) takeFile(ui_.state(), file);
    if (studio_.update()) arrived();
    if (showNewest() || inputCame()) settling = kSettlingFrames;
    if (settling-- > 0 || ui_.state().notes.passing()) frame();
  }
}

// A frame of the window. Minimised it has none, and nothing is drawn for it.
void Viewer::frame() {
  if (!surface_.drawable()) {
    pause();
    if (player_) player_->play(ImGui::GetIO());
    return;
  }
  surface_.beginFrame();
  if (player_) player_->play(ImGui::GetIO());
  ImGui::NewFrame();
  PictureTexture& texture = surface_.texture();
  const bool filled = texture.width() > 0;
  ui_.draw({filled ? texture.id() : nullptr, texture.width(), texture.height()},
           surface_.pixelScale(), surface_.largestTexture());
  std::vector<uint8_t> drawn;
  const Vec2i size = surface_.pixels();
  const bool kept = surface_.endFrame(screenshot_.empty() ? nullptr : &drawn);
  if (!drawn.empty()) io::writePng(std::exchange(screenshot_, ""), drawn, size.x, size.y, 3);
  if (!kept) recover();
}

void Viewer::pause() {
  ViewState view = studio_.view();
  view.width = view.height = 0;
  studio_.setView(view);
}

void Viewer::recover() {
  surface_.recreate();
  ui_.state().showDirty = true;
  ui_.state().notes.add(Severity::warning,
                        "the graphics driver was reset; the window was made anew, and nothing "
                        "of the design is lost");
}

// Or something moves by itself, after input that came before.
bool Viewer::inputCame() {
  return surface_.takeInput() || ImGui::IsAnyMouseDown() || ui_.state().moving();
}

// A design or a camera came from a file.
void Viewer::arrived() {
  UiState& ui = ui_.state();
  ui.clampChoices();
  const Camera& camera = studio_.view().camera;
  if (camera.toWorld.to == ui.view.camera.toWorld.to && camera.fovX == ui.view.camera.fovX) return;
  ui.firstCamera = camera;
  ui.control.take(camera);
}

// True when something new is to be seen.
bool Viewer::showNewest() {
  UiState& ui = ui_.state();
  auto picture = studio_.newestPicture();
  auto truth = ui.split ? studio_.newestTruth() : nullptr;
  const bool measure = ui.measureCurve && picture && !picture->white;
  if (picture == ui.picture && truth == ui.truth && !ui.showDirty && !measure) return false;
  ui.picture = std::move(picture);
  ui.truth = std::move(truth);
  ui.showDirty = false;
  if (!ui.picture || !surface_.drawable()) return true;
  if (measure) {
    ui.display.curve = measureToneCurve(ui.picture->film, {});
    ui.measureCurve = false;
  }
  DisplaySettings display = ui.shownDisplay();
  display.width = ui.picture->film.width;
  display.height = ui.picture->film.height;
  const Displayed shown = displayPicture(*ui.picture, ui.truth.get(), display);
  ui.legendLeast = shown.least, ui.legendMost = shown.most;
  if (!surface_.texture().fill(shown.width, shown.height, shown.pixels)) recover();
  return true;
}

UiStage Viewer::stage() {
  UiState& ui = ui_.state();
  return {.marks = ui.marks,
          .picture = [this] { return ui_.pictureBox(); },
          .drawn = [this] { return !studio_.isBusy(); },
          .says =
              [this](const std::string& text) {
                return ui_.state().notes.says(text) ||
                       statusText(ui_.state()).find(text) != std::string::npos;
              },
          .seek = [this](const std::string& label) { ui_.state().marks.seek(label); },
          .act = [this](const UiStep& step) { act(step); }};
}

void Viewer::act(const UiStep& step) {
  switch (step.kind) {
    case UiStep::Kind::drop:
      takeFile(ui_.state(), step.text);
      break;
    case UiStep::Kind::screenshot:
      screenshot_ = step.text;
      break;
    case UiStep::Kind::resize:
      surface_.resize(step.size);
      break;
    case UiStep::Kind::minimise:
      glfwIconifyWindow(surface_.window());
      break;
    case UiStep::Kind::restore:
      glfwRestoreWindow(surface_.window());
      break;
    default:
      surface_.pretendLost();
  }
}

}  // namespace lobelia::app
