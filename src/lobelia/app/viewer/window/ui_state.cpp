#include "lobelia/app/viewer/window/ui_state.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "lobelia/app/studio/material_fields.h"

namespace lobelia::app {
namespace {

constexpr double kMovingSeconds = 0.25;

std::string lowerExtension(const std::string& file) {
  std::string out = std::filesystem::path(file).extension().string();
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

bool among(const std::string& name, std::initializer_list<const char*> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

UiState::UiState(Studio& engine, const Camera& first)
    : studio(engine),
      view(engine.view()),
      control(first, engine.bounds()),
      firstCamera(first),
      sceneDesign(engine.design()) {
  designFile = "design.xml";
  screenshotFile = "picture.exr";
}

void UiState::saveDesign() { studio.saveDesign(designFile, control.camera()); }

DisplaySettings UiState::shownDisplay() const {
  DisplaySettings out = display;
  out.split = split ? splitAt : -1;
  return out;
}

bool UiState::moving() const {
  return movedAt != 0 && static_cast<double>(nanosecondsNow() - movedAt) * 1e-9 < kMovingSeconds;
}

void UiState::moved() { movedAt = nanosecondsNow(); }

void UiState::edit(const std::string& name, Touch touch,
                   const std::function<void(Design&)>& change) {
  if (touch.changed) studio.edit(name, change);
  if (touch.done) studio.endEdit();
}

void UiState::clampChoices() {
  const Design& design = studio.design();
  if (material >= design.materials.size()) material = 0;
  if (emitter >= static_cast<int>(design.emitters.size())) emitter = -1;
}

void takeFile(UiState& ui, const std::string& file) {
  const std::string type = lowerExtension(file);
  if (type == ".xml") {
    ui.studio.loadDesign(file);
  } else if (among(type, {".hdr", ".exr", ".pfm"})) {
    ui.environmentFile = file;
    ui.studio.loadEnvironment(file);
  } else if (among(type, {".png", ".jpg", ".jpeg", ".tga", ".bmp", ".tif", ".tiff", ".ppm"})) {
    ui.textureFile = file;
    if (ui.textureField.empty()) {
      ui.notes.add(Severity::warning,
                   fmt::format("'{}' can be a texture, but of what? Press 'map' beside a value of "
                               "the material first",
                               file));
    } else {
      ui.studio.loadTexture(file, ui.material, ui.textureField);
    }
  } else {
    ui.notes.add(
        Severity::warning,
        fmt::format("'{}' is nothing that can be dropped here: environments are .hdr, .exr "
                    "or .pfm, textures .png, .jpg and the like, designs .xml",
                    file));
  }
}

}  // namespace lobelia::app
