#include "lobelia/app/studio/design_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "lobelia/app/load_scene.h"
#include "lobelia/app/studio/view_state.h"
#include "lobelia/io/image_io.h"

namespace lobelia::app {
namespace {

// Lights from `first` on that have no name are called after the file, and take the place of what is
// called so.
void nameNewLights(std::vector<Emitter>& emitters, size_t first, const std::string& file) {
  const std::string stem = std::filesystem::path(file).stem().string();
  int number = 0;
  for (size_t i = first; i < emitters.size();) {
    if (!emitters[i].name.empty()) {
      ++i;
      continue;
    }
    emitters[i].name = fmt::format("{}.light{}", stem, ++number);
    const auto old =
        std::find_if(emitters.begin(), emitters.begin() + static_cast<ptrdiff_t>(first),
                     [&](const Emitter& e) { return e.name == emitters[i].name; });
    if (old == emitters.begin() + static_cast<ptrdiff_t>(first)) {
      ++i;
      continue;
    }
    *old = emitters[i];
    emitters.erase(emitters.begin() + static_cast<ptrdiff_t>(i));
  }
}

// A new one stands in front.
size_t changedCamera(const std::vector<Camera>& before, const std::vector<Camera>& now) {
  if (before.size() != now.size()) return 0;
  const auto at = std::mismatch(before.begin(), before.end(), now.begin(), sameRays).first;
  return at != before.end() ? static_cast<size_t>(at - before.begin()) : 0;
}

}  // namespace

ReadDesign readDesign(const Design& base, const std::string& file, bool strict, Context& context) {
  Scene scene = sceneOf(base);
  const size_t imageCount = scene.images.size();
  io::ReadSettings settings;
  settings.strict = strict;
  ReadDesign out;
  out.parts = io::applyDesign(file, settings, scene, context);
  reportFindings(scene.findings, context);
  nameNewLights(scene.emitters, base.emitters.size(), file);
  auto design = std::make_shared<Design>(base);
  design->materials = std::move(scene.materials);
  design->textures = std::move(scene.textures);
  design->emitters = std::move(scene.emitters);
  design->cameras = std::move(scene.cameras);
  for (size_t i = imageCount; i < scene.images.size(); ++i)
    design->images.push_back(std::make_shared<StoredImage>(std::move(scene.images[i])));
  compact(*design);
  out.camera = changedCamera(base.cameras, design->cameras);
  out.design = std::move(design);
  return out;
}

std::shared_ptr<StoredImage> readImageFile(const std::string& file, bool raw) {
  io::ImageOptions options;
  options.raw = raw;
  return std::make_shared<StoredImage>(io::readImage(file, options));
}

void setEnvironment(Design& design, std::shared_ptr<StoredImage> image) {
  Emitter emitter;
  emitter.type = EmitterType::environment;
  emitter.name = "environment";
  emitter.image = {design.sceneImages + static_cast<uint32_t>(design.images.size())};
  design.images.push_back(std::move(image));
  const auto old =
      std::find_if(design.emitters.begin(), design.emitters.end(), [](const Emitter& e) {
        return e.type == EmitterType::constant || e.type == EmitterType::environment;
      });
  if (old != design.emitters.end()) {
    *old = emitter;
  } else {
    design.emitters.push_back(emitter);
  }
}

}  // namespace lobelia::app
