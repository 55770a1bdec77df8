// From options to an open window with its scene, and back.
#include "lobelia/app/viewer/window_run.h"

#include <imgui.h>

#include <chrono>
#include <future>
#include <memory>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/option_checks.h"
#include "lobelia/app/signals.h"
#include "lobelia/app/viewer/window/surface.h"
#include "lobelia/app/viewer/window/viewer.h"
#include "lobelia/base/parallel.h"

namespace lobelia::app {
namespace {

constexpr Vec2i kUsualSize{1280, 800};
constexpr double kBetweenFrames = 1 / 30.;  // while loading, seconds

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
      !render.frame.empty() || !render.crop.empty() || render.turntable ||
      options.rotateStep != 0 || !render.stats.empty())
    throw UsageError(
        "-o, --script, --frames, --frame, --crop, --turntable, --rotate-step and --stats draw "
        "files: they "
        "want --headless; the window saves pictures itself, and --ui-script plays at it");
}

// Whoever leaves early need not wait for the whole scene.
struct CancelUnlessDone {
  const std::future<std::unique_ptr<Studio>>& loading;
  Context& context;
  ~CancelUnlessDone() {
    if (loading.valid()) context.cancel();
  }
};

// Loads beside a window that says so and can be closed. Throws what Studio's
// constructor throws.
std::unique_ptr<Studio> load(const ViewOptions& options, Surface& surface, Context& context) {
  StudioSettings settings;
  settings.scene = options.render.scene;
  settings.data = options.data;
  settings.seed = options.render.seed;
  settings.rotation = options.rotate;
  settings.wake = Surface::wake;
  std::future<std::unique_ptr<Studio>> loading =
      std::async(std::launch::async, [&] { return std::make_unique<Studio>(settings, context); });
  const CancelUnlessDone guard{loading, context};
  while (loading.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
    surface.wait(kBetweenFrames);
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
