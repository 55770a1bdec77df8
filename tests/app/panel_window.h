// The viewer's panels without a window: Dear ImGui with a backend that draws nothing, and a small
// scene behind it.
#pragma once

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <filesystem>
#include <memory>

#include "lobelia/app/viewer/light_handle.h"
#include "lobelia/app/viewer/window/panels.h"
#include "lobelia/app/viewer/window/ui.h"
#include "lobelia/app/viewer/window/ui_player.h"
#include "support/run_program.h"

namespace lobelia::test {

inline constexpr const char* kPanelScene = R"(<scene version="3.0.0">
  <sensor type="perspective"><float name="fov" value="40"/>
    <transform name="to_world"><lookat origin="3, 4, 6" target="0, 0.4, 0" up="0, 1, 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="12"/>
      <rfilter type="box"/></film></sensor>
  <emitter type="constant"><rgb name="radiance" value="0.5, 0.7, 1"/></emitter>
  <emitter type="point" id="lamp"><point name="position" x="0.4" y="1.5" z="0.3"/>
    <rgb name="intensity" value="2, 2, 2"/></emitter>
  <bsdf type="roughconductor" id="metal"><float name="alpha" value="0.2"/></bsdf>
  <bsdf type="twosided" id="paint"><bsdf type="diffuse"/></bsdf>
  <shape type="rectangle"><transform name="to_world"><scale value="2"/><rotate x="1" angle="-90"/>
    </transform><ref id="paint"/></shape>
  <shape type="cube"><transform name="to_world"><scale value="0.5"/><translate y="0.55"/></transform>
    <ref id="metal"/></shape>
</scene>)";

class PanelWindow : public testing::Test {
 protected:
  PanelWindow() {
    writeText(file("scene.xml"), kPanelScene);
    app::StudioSettings settings;
    settings.scene.scene = file("scene.xml");
    studio = std::make_unique<app::Studio>(settings, context);
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.DisplaySize = ImVec2(1280, 800);
    unsigned char* letters = nullptr;
    int width = 0, height = 0;
    io.Fonts->GetTexDataAsRGBA32(&letters, &width, &height);
    for (const auto& [key, code] : {std::pair<int, int>(ImGuiKey_Tab, GLFW_KEY_TAB),
                                    {ImGuiKey_Enter, GLFW_KEY_ENTER},
                                    {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                    {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                    {ImGuiKey_Delete, GLFW_KEY_DELETE},
                                    {ImGuiKey_A, GLFW_KEY_A},
                                    {ImGuiKey_Z, GLFW_KEY_Z}})
      io.KeyMap[key] = code;
    ui = std::make_unique<app::Ui>(*studio, studio->view().camera);
    ui->state().designFile = file("design.xml");
    ui->state().screenshotFile = file("picture.exr");
    ui->state().view.method = app::ViewMethod::path;
    ui->state().view.spp = 1;
  }
  ~PanelWindow() override {
    ui.reset();
    ImGui::DestroyContext();
  }
  std::string file(const std::string& name) const { return folder / name; }

  // A frame; pictures stay tiny, whatever the panels leave.
  void frame(float pixelScale = 1, int largest = 8) {
    ImGuiIO& io = ImGui::GetIO();
    io.DeltaTime = 1 / 60.f;
    ImGui::NewFrame();
    ui->draw({}, pixelScale, largest);
    ImGui::Render();
    studio->update();
    ui->state().picture = studio->newestPicture();
  }
  void frames(int count) {
    for (int i = 0; i < count; ++i) frame();
  }
  // Plays lines of a UI script.
  void play(const std::string& text) {
    writeText(file("hand.script"), text);
    app::UiPlayer player(app::readUiScript(file("hand.script")),
                         {ui->state().marks, [this] { return ui->pictureBox(); },
                          [this] { return !studio->isBusy(); },
                          [this](const std::string& words) {
                            return ui->state().notes.says(words) ||
                                   app::statusText(ui->state()).find(words) != std::string::npos;
                          },
                          [this](const std::string& label) { ui->state().marks.seek(label); },
                          [this](const app::UiStep& step) {
                            if (step.kind == app::UiStep::Kind::drop)
                              app::takeFile(ui->state(), step.text);
                          }});
    while (!player.finished()) {
      player.play(ImGui::GetIO());
      frame();
    }
    frames(2);
  }
  const Material& material(size_t i) const { return studio->design().materials[i]; }
  uint32_t materialNamed(const std::string& name) const {
    const auto& all = studio->design().materials;
    for (uint32_t i = 0; i < all.size(); ++i)
      if (all[i].name == name) return i;
    ADD_FAILURE() << "no material " << name;
    return 0;
  }

  TemporaryFolder folder;
  Context context;
  std::unique_ptr<app::Studio> studio;
  std::unique_ptr<app::Ui> ui;
};

}  // namespace lobelia::test
