// The panels of the viewer's window, drawn and used without a window.
#include <cmath>
#include <set>

#include "app/panel_window.h"
#include "lobelia/app/studio/material_edits.h"
#include "lobelia/app/studio/material_fields.h"
#include "lobelia/base/random.h"

namespace lobelia::test {
namespace {

class WindowPanels : public PanelWindow {};

TEST_F(WindowPanels, ASliderMakesAMetalRougherInOneStepOfUndo) {
  play("click metal\nslide \"roughness\" 0.9\n");
  const uint32_t metal = materialNamed("metal");
  EXPECT_GT(material(metal).alphaU.value, 0.3f);
  EXPECT_EQ(material(metal).alphaU.value, material(metal).alphaV.value);
  EXPECT_TRUE(studio->history().canUndo());
  play("key ctrl+z\n");
  EXPECT_EQ(material(metal).alphaU.value, 0.2f) << "all of the drag is one step";
  EXPECT_FALSE(studio->history().canUndo());
  play("key ctrl+shift+z\n");
  EXPECT_GT(material(metal).alphaU.value, 0.3f);
  play("click undo\nclick redo\nclick undo\n");
  EXPECT_EQ(material(metal).alphaU.value, 0.2f);
}

TEST_F(WindowPanels, TypedValuesCountAndNonsenseDoesNot) {
  play("click metal\ntype roughness 0.5\n");
  EXPECT_FLOAT_EQ(material(materialNamed("metal")).alphaU.value, 0.5f);
  play("type roughness nan\n");
  EXPECT_TRUE(std::isfinite(material(materialNamed("metal")).alphaU.value));
  play("type roughness 1e30\n");
  EXPECT_LE(material(materialNamed("metal")).alphaU.value, 1);
}

// Every widget of every type is drawn and dragged.
TEST_F(WindowPanels, EveryMaterialTypeShowsAllOfItsFields) {
  const uint32_t metal = materialNamed("metal");
  ui->state().material = metal;
  for (const MaterialType type : app::simpleTypes()) {
    studio->edit("type", [&](app::Design& d) { app::changeType(d, metal, type); });
    frames(3);
    const std::vector<std::string> labels = ui->state().marks.labels();
    const std::set<std::string> drawn(labels.begin(), labels.end());
    for (const app::FieldPlace& place : app::fieldPlaces(studio->design(), metal)) {
      const std::string label = place.prefix + place.field->label;
      if (place.field->kind != app::FieldKind::map) {
        EXPECT_TRUE(drawn.contains("Material/" + label)) << app::typeWord(type) << ": " << label;
      }
      if (place.field->kind == app::FieldKind::scalar ||
          place.field->kind == app::FieldKind::number) {
        play("slide \"Material/" + label + "\" 0.7\n");
        const float value = app::fieldValue(material(place.material), *place.field).x;
        EXPECT_GE(value, place.field->least);
        EXPECT_LE(value, place.field->most);
      }
    }
  }
}

TEST_F(WindowPanels, TheFilterFindsMaterialsByAnyPartOfTheirNames) {
  play("type filter ETA\n");
  EXPECT_TRUE(ui->state().marks.find("metal"));
  EXPECT_FALSE(ui->state().marks.find("Material/paint"));
}

TEST_F(WindowPanels, LightsAreAddedMovedAndRemoved) {
  const size_t before = studio->design().emitters.size();
  play("click \"add point\"\n");
  ASSERT_EQ(studio->design().emitters.size(), before + 1);
  EXPECT_EQ(studio->design().emitters.back().type, EmitterType::point);
  const Vec3f at = studio->design().emitters.back().toWorld.point({0, 0, 0});
  EXPECT_TRUE(isFinite(at));
  play("click remove\n");
  EXPECT_EQ(studio->design().emitters.size(), before);
  play("key ctrl+z\n");
  EXPECT_EQ(studio->design().emitters.size(), before + 1);
}

TEST_F(WindowPanels, ADraggedLightFollowsTheHand) {
  frames(3);
  const Camera camera = app::viewCamera(ui->state().view);
  const size_t lamp = 1;
  ASSERT_EQ(studio->design().emitters[lamp].name, "lamp");
  const Vec3f from = studio->design().emitters[lamp].toWorld.point({0, 0, 0});
  const Vec2f film = *app::project(camera, from);
  const float x = film.x / static_cast<float>(camera.width),
              y = film.y / static_cast<float>(camera.height);
  play("drag-picture left " + std::to_string(x) + "," + std::to_string(y) + " " +
       std::to_string(x + 0.1f) + "," + std::to_string(y) + "\n");
  const Vec3f to = studio->design().emitters[lamp].toWorld.point({0, 0, 0});
  EXPECT_GT(length(to - from), 0.05f);
  const Vec2f moved = *app::project(camera, to);
  EXPECT_NEAR(moved.x - film.x, 0.1f * static_cast<float>(camera.width), 0.05f);
  EXPECT_NEAR(moved.y, film.y, 0.05f);
  EXPECT_EQ(studio->view().camera.toWorld.to, studio->design().cameras[0].toWorld.to)
      << "the camera stays";
  play("key ctrl+z\n");
  EXPECT_EQ(studio->design().emitters[lamp].toWorld.point({0, 0, 0}), from);
}

TEST_F(WindowPanels, TheMouseMovesTheCameraAndRBringsItBack) {
  frames(3);
  const Mat4 first = studio->view().camera.toWorld.to;
  Mat4 last = first;
  for (const char* move :
       {"drag-picture left 0.8,0.8 0.6,0.7\n", "drag-picture right 0.8,0.8 0.8,0.6\n",
        "drag-picture shift+left 0.8,0.8 0.7,0.7\n", "wheel 0.8,0.8 3\n", "key w\n"}) {
    play(move);
    EXPECT_NE(studio->view().camera.toWorld.to, last) << move;
    last = studio->view().camera.toWorld.to;
    EXPECT_TRUE(last.isFinite());
  }
  play("key r\n");
  EXPECT_EQ(studio->view().camera.toWorld.to, first);
  EXPECT_FALSE(studio->history().canUndo()) << "camera moves are no edits";
}

TEST_F(WindowPanels, AltDragTurnsTheLight) {
  play("drag-picture alt+left 0.2,0.9 0.6,0.9\n");
  EXPECT_GT(std::abs(studio->design().rotation), 20);
}

TEST_F(WindowPanels, TabHidesThePanels) {
  frames(2);
  const float before = ui->pictureBox().hi.x - ui->pictureBox().lo.x;
  play("key Tab\n");
  EXPECT_GT(ui->pictureBox().hi.x - ui->pictureBox().lo.x, before * 1.5f);
  EXPECT_FALSE(ui->state().marks.find("Material/filter"));
}

TEST_F(WindowPanels, DroppedFilesThatAreNothingSaySo) {
  writeText(file("poem.txt"), "roses");
  writeText(file("broken.hdr"), "no picture");
  writeText(file("loose.png"), "no picture either");
  play(
      "drop poem.txt\nexpect poem.txt\ndrop loose.png\nexpect \"of what?\"\n"
      "drop broken.hdr\nwait\nexpect broken.hdr\n");
  EXPECT_FALSE(studio->history().canUndo());
}

TEST_F(WindowPanels, MethodsWithoutTheirDataSayWhatTheyWant) {
  play("click method\nclick cuts\nexpect precompute\n");
  EXPECT_NE(ui->state().view.method, app::ViewMethod::cuts);
  play("click method\nclick transfer\nexpect \"method vmf\"\n");
  EXPECT_NE(ui->state().view.method, app::ViewMethod::transfer);
}

TEST_F(WindowPanels, ADesignIsSavedAndComesBack) {
  play("click metal\ntype roughness 0.4\nclick \"save design\"\nwait\n");
  EXPECT_TRUE(std::filesystem::exists(file("design.xml")));
  play("key ctrl+z\nclick \"load design\"\nwait\nframes 3\n");
  EXPECT_FLOAT_EQ(material(materialNamed("metal")).alphaU.value, 0.4f);
}

TEST_F(WindowPanels, APictureHasThePixelsOfTheFramebufferAndHalfOfThemWhileMoving) {
  ui->state().panels = false;
  ImGui::GetIO().DisplaySize = ImVec2(40, 30);
  frame(2, 4096);
  EXPECT_EQ(studio->view().width, 80);
  EXPECT_EQ(studio->view().height, 60);
  ui->state().moved();
  frame(2, 4096);
  EXPECT_EQ(studio->view().width, 40);
  EXPECT_EQ(studio->view().height, 30);
  ui->state().smallWhileMoving = false;
  frame(2, 64);
  EXPECT_EQ(studio->view().width, 64) << "no larger than a texture can be";
}

TEST_F(WindowPanels, EmptyAndTinyWindowsAreDrawn) {
  for (const ImVec2 size : {ImVec2(1, 1), ImVec2(40, 3000), ImVec2(3000, 2), ImVec2(300, 200)}) {
    ImGui::GetIO().DisplaySize = size;
    frames(3);
    EXPECT_GE(studio->view().width, 1);
    EXPECT_LE(studio->view().width, 8);
  }
}

// A monkey at mouse and keys. Dear ImGui's asserts and the engine's are on.
TEST_F(WindowPanels, ThousandsOfRandomClicksAndKeysBreakNothing) {
  const std::filesystem::path home = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());  // files of names that it types land here
  Rng rng(11);
  constexpr int kKeys[]{GLFW_KEY_TAB, GLFW_KEY_ENTER, GLFW_KEY_ESCAPE,   GLFW_KEY_Z,
                        GLFW_KEY_A,   GLFW_KEY_F,     GLFW_KEY_R,        GLFW_KEY_C,
                        GLFW_KEY_W,   GLFW_KEY_H,     GLFW_KEY_BACKSPACE};
  Vec2f mouse{600, 400};
  for (int i = 0; i < 4000; ++i) {
    ImGuiIO& io = ImGui::GetIO();
    if (i % 3 == 0) mouse = Vec2f(rng.next1D() * 1280, rng.next1D() * 800);
    io.MousePos = ImVec2(mouse.x + rng.next1D() * 20, mouse.y);
    for (int button = 0; button < 3; ++button)
      io.MouseDown[button] = rng.next1D() < (button == 0 ? 0.5f : 0.05f);
    for (const int key : kKeys) io.KeysDown[key] = rng.next1D() < 0.02f;
    io.KeyCtrl = rng.next1D() < 0.1f, io.KeyShift = rng.next1D() < 0.1f,
    io.KeyAlt = rng.next1D() < 0.1f;
    if (rng.next1D() < 0.2f) io.AddInputCharacter("0123456789.-eabx/"[rng.nextUint() % 17]);
    if (rng.next1D() < 0.1f) io.MouseWheel = rng.next1D() * 8 - 4;
    if (i % 500 == 499)
      io.DisplaySize = ImVec2(200 + rng.next1D() * 1400, 100 + rng.next1D() * 900);
    // It may not choose what is written over.
    ui->state().designFile = file("design.xml");
    ui->state().screenshotFile = file("picture.exr");
    frame();
    ASSERT_TRUE(studio->view().camera.toWorld.to.isFinite());
    ASSERT_LT(studio->design().emitters.size(), 1000u);
  }
  for (const Material& m : studio->design().materials) ASSERT_TRUE(std::isfinite(m.alphaU.value));
  std::filesystem::current_path(home);
}

}  // namespace
}  // namespace lobelia::test
