// The window's life: input, a frame of panels, what the engine has drawn since, and again; asleep
// while nothing happens.
#include "lobelia/app/viewer/window_run.h"

#include <fmt/format.h>
#include <imgui.h>

#include <chrono>
#include <future>
#include <memory>
#include <optional>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/option_checks.h"
#include "lobelia/app/signals.h"
#include "lobelia/app/viewer/ui_script.h"
#include "lobelia/app/viewer/window/panels.h"
#include "lobelia/app/viewer/window/studio_gaps.h"
#include "lobelia/app/viewer/window/surface.h"
#include "lobelia/app/viewer/window/ui.h"
#include "lobelia/app/viewer/window/ui_player.h"
#include "lobelia/base/parallel.h"
#include "lobelia/io/image_io.h"

namespace lobelia::app {
namespace {

constexpr Vec2i kUsualSize{1280, 800};
constexpr double kIdle = 0.03;         // seconds asleep at most, for what shows by itself
constexpr double kSettling = 1 / 60.;  // between frames while something moves
constexpr int kSettlingFrames = 3;     // Dear ImGui shows some things a frame late

struct PanelContext {
  PanelContext() {
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;               // no files that nobody asked for
    ImGui::GetIO().ConfigInputTextCursorBlink = false;  // an idle window sleeps
  }
  ~PanelContext() { ImGui::DestroyContext(); }
  PanelContext(const PanelContext&) = delete;
  PanelContext& operator=(const PanelContext&) = delete;
};

Vec2i windowSize(const RenderOptions& options) {
  if (options.size.empty()) return kUsualSize;
  requireSize(options.size);
  const size_t x = options.size.find('x');
  return {std::stoi(options.size.substr(0, x)), std::stoi(options.size.substr(x + 1))};
}

void requireWindow(const ViewOptions& options) {
  const RenderOptions& render = options.render;
  if (!render.outputs.empty() || !options.script.empty() || render.frames > 0 ||
      !render.frame.empty() || render.turntable || options.rotateStep != 0 || !render.stats.empty())
    throw UsageError(
        "-o, --script, --frames, --frame, --turntable, --rotate-step and --stats draw files: they "
        "want --headless; the window saves pictures itself, and --ui-script plays at it");
}

// Loads beside a window that says so and can be closed. Throws what Studio's
// constructor throws.
std::unique_ptr<Studio> load(const ViewOptions& options, Surface& surface, Context& context) {
  StudioSettings settings;
  settings.scene = options.render.scene;
  settings.data = options.data;
  settings.seed = options.render.seed;

  std::future<std::unique_ptr<Studio>> loading =
      std::async(std::launch::async, [&] { return std::make_unique<Studio>(settings, context); });
  while (loading.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    surface.wait(kSettling);
    if (surface.closing()) context.cancel();
    if (!surface.drawable()) continue;
    surface.beginFrame();
    ImGui::NewFrame();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    const std::string text = "loading " + options.render.scene.scene;
    const ImVec2 wide = ImGui::CalcTextSize(text.c_str());
    ImGui::GetForegroundDrawList()->AddText(ImVec2((size.x - wide.x) / 2, (size.y - wide.y) / 2),
                                            IM_COL32(200, 200, 200, 255), text.c_str());
    if (!surface.endFrame()) surface.recreate();
  }
  return loading.get();
}

class Viewer {
 public:
  Viewer(const ViewOptions& options, Studio& studio, Surface& surface, Context& context)
      : context_(context), surface_(surface), studio_(studio), ui_(studio, studio.view().camera) {
    if (!options.uiScript.empty()) player_.emplace(readUiScript(options.uiScript), stage());
    choose(options);
  }

  void run() {
    int settling = kSettlingFrames;
    while (!surface_.closing() && !context_.cancelled() && !(player_ && player_->finished())) {
      if (player_) settling = kSettlingFrames;
      surface_.wait(player_ ? 0 : settling > 0 ? kSettling : kIdle);
      for (const std::string& file : surface_.takeDropped()) takeFile(ui_.state(), file);
      if (studio_.update()) arrived();
      if (showNewest() || inputCame()) settling = kSettlingFrames;
      if (settling-- > 0 || ui_.state().notes.passing()) frame();
    }
  }

 private:
  void choose(const ViewOptions& options) {
    UiState& ui = ui_.state();
    ui.view.lightCut = options.lightCut;
    ui.view.refined = !options.plainLobes;
    ui.display.exposure = options.render.exposure;
    if (options.render.spp > 0) ui.view.spp = options.render.spp;
  }

  // A frame of the window. Minimised it has none, and draws nothing.
  void frame() {
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
  void pause() {
    ViewState view = studio_.view();
    view.width = view.height = 0;
    studio_.setView(view);
  }
  void recover() {
    surface_.recreate();
    ui_.state().showDirty = true;
    ui_.state().notes.add(Severity::warning,
                          "the graphics driver was reset; the window was made anew, and nothing "
                          "of the design is lost");
  }

  // Or something moves by itself, after input that came before.
  bool inputCame() {
    return surface_.takeInput() || ImGui::IsAnyMouseDown() || ui_.state().moving();
  }

  // A design or a camera came from a file.
  void arrived() {
    UiState& ui = ui_.state();
    ui.clampChoices();
    if (!(studio_.view().camera.toWorld.to == ui.view.camera.toWorld.to)) {
      ui.firstCamera = studio_.view().camera;
      ui.control.take(ui.firstCamera);
    }
  }

  // True when something new is to be seen.
  bool showNewest() {
    UiState& ui = ui_.state();
    auto picture = studio_.newestPicture();
    auto truth = ui.split ? studio_.newestTruth() : nullptr;
    if (picture == ui.picture && truth == ui.truth && !ui.showDirty && !ui.measureCurve)
      return false;
    ui.picture = std::move(picture);
    ui.truth = std::move(truth);
    ui.showDirty = false;
    if (!ui.picture || !surface_.drawable()) return true;
    if (ui.measureCurve && !ui.picture->white) {
      ui.display.curve = measureToneCurve(ui.picture->film, {});
      ui.measureCurve = false;
    }
    DisplaySettings display = ui.display;
    display.split = ui.split ? ui.splitAt : -1;
    display.width = ui.picture->film.width;
    display.height = ui.picture->film.height;
    const Displayed shown = displayPicture(*ui.picture, ui.truth.get(), display);
    ui.legendLeast = shown.least, ui.legendMost = shown.most;
    if (!surface_.texture().fill(shown.width, shown.height, shown.pixels)) recover();
    return true;
  }

  UiStage stage() {
    UiState& ui = ui_.state();
    return {.marks = ui.marks,
            .picture = [this] { return ui_.pictureBox(); },
            .drawn = [this] { return !busyIn(studio_, ui_.state()) && studio_.openFiles() == 0; },
            .says =
                [this](const std::string& text) {
                  return ui_.state().notes.says(text) ||
                         statusText(ui_.state()).find(text) != std::string::npos;
                },
            .seek = [this](const std::string& label) { ui_.state().marks.seek(label); },
            .act = [this](const UiStep& step) { act(step); }};
  }
  void act(const UiStep& step) {
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

  Context& context_;
  Surface& surface_;
  Studio& studio_;
  Ui ui_;
  std::optional<UiPlayer> player_;
  std::string screenshot_;  // of the next frame, to this file
};

}  // namespace

ExitCode runWindow(const ViewOptions& options, const GlobalOptions& global, const std::string&) {
  requireWindow(options);
  const ThreadLimit threads(global.threads);
  Console console(global.verbosity());
  Context context(&console);
  context.seed = options.render.seed;
  const SignalGuard signals(context);
  const PanelContext panels;
  Surface surface(windowSize(options.render), "Lobelia: " + options.render.scene.scene);
  try {
    const std::unique_ptr<Studio> studio = load(options, surface, context);
    Viewer(options, *studio, surface, context).run();
  } catch (const Cancelled&) {
  }
  return signalExitCode();
}

}  // namespace lobelia::app
