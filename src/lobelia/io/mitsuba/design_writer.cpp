// Designs out (io/design.h): the writer of scenes, for what has changed.
//
// Each of the scene's materials that is another now is written, by its name or place. What it wraps
// is a reference where that is a material of the scene, changed or not, and stands inside it where
// it is a new one.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "lobelia/io/design.h"
#include "lobelia/io/file_bytes.h"
#include "lobelia/io/image_io.h"
#include "lobelia/io/mitsuba/design_changes.h"
#include "lobelia/io/mitsuba/design_names.h"
#include "lobelia/io/mitsuba/writer.h"

namespace lobelia::io {
namespace mitsuba {
namespace {

namespace fs = std::filesystem;

bool samePixels(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height && a.channels == b.channels &&
         a.pixels == b.pixels;
}

// Is the image what is read from the file, and raw? Empty: it is not.
std::optional<bool> readsAs(const std::string& file, const Image& image) {
  std::error_code none;
  if (!fs::is_regular_file(file, none)) return {};
  for (const bool raw : {false, true}) {
    try {
      if (samePixels(readImage(file, {.raw = raw}), image)) return raw;
    } catch (const InputError&) {  // not an image, or not any more
      return {};
    }
  }
  return {};
}

bool isSurrounding(EmitterType type) {
  return type == EmitterType::constant || type == EmitterType::environment;
}

// Another may have a name that looks like this one's place.
template <class T>
void requireMeant(const std::vector<T>& items, const std::string& id, size_t index,
                  const std::string& file) {
  if (namedInDesign(items, id) != std::vector<size_t>{index})
    throw RuntimeError(fmt::format(
        "cannot write {}: '{}' is the name of something else in the scene; rename that", file, id));
}

// By its role an environment or sun needs no name; of several, the first.
bool isFirstOfItsRole(const std::vector<Emitter>& emitters, size_t index) {
  const EmitterType type = emitters[index].type;
  const auto role = [&](const Emitter& e) {
    return isSurrounding(type) ? isSurrounding(e.type) : e.type == type;
  };
  return std::find_if(emitters.begin(), emitters.end(), role) - emitters.begin() ==
         static_cast<ptrdiff_t>(index);
}

}  // namespace

// Where an image is named from: the file it came from, or one beside the design.
std::string Writer::designImage(ImageHandle handle) {
  const Image& image = scene_[handle];
  const fs::path folder = fs::absolute(folder_);
  // A $ would be taken for a parameter.
  if (image.name.find('$') == std::string::npos)
    if (const std::optional<bool> raw = readsAs(image.name, image)) {
      if (*raw) rawImages_.insert(handle.index);
      return fs::absolute(image.name).lexically_proximate(folder).generic_string();
    }
  const std::string stem = fs::path(image.name).stem().string();
  for (;;) {
    const std::string base = designImages_ + "/" + imageNames_.make(stem, "image");
    bool taken = false;
    for (const char* suffix : {".png", ".exr"}) {
      const std::string file = folder_ + "/" + base + suffix;
      std::error_code none;
      if (!fs::exists(file, none)) continue;
      taken = true;
      const std::optional<bool> raw = readsAs(file, image);
      if (!raw) continue;
      if (*raw) rawImages_.insert(handle.index);
      return base + suffix;
    }
    const bool mayBeRaw = std::none_of(scene_.emitters.begin(), scene_.emitters.end(),
                                       [&](const Emitter& e) { return e.image == handle; });
    if (!taken) return writeImage(handle, base, mayBeRaw);
  }
}

void Writer::writeDesign(const std::string& file, const Scene& before) {
  isDesign_ = true;
  designFile_ = file;
  designImages_ = cleanName(fs::path(file).stem().string()) + "_textures";
  imageFiles_.resize(scene_.images.size());
  root_ = document_.append_child("scene");
  root_.append_attribute("version") = "3.0.0";
  writeChangedMaterials(before);
  writeChangedEmitters(before);
  writeChangedCameras(before);
  std::ostringstream xml;
  document_.save(xml, "  ");
  writeFileAtomically(file, std::move(xml).str());
}

void Writer::writeChangedMaterials(const Scene& before) {
  materialIds_ = designNames(before.materials);
  for (size_t i = 0; i < before.materials.size(); ++i) {
    const Material& now = scene_.materials[i];
    if (sameMaterial(before.materials[i], now)) continue;
    for (const size_t named : {i, size_t{now.a.index}, size_t{now.b.index}})
      if (named < materialIds_.size())
        requireMeant(before.materials, materialIds_[named], named, designFile_);
    ids_.make(materialIds_[i], "");  // which no light may have
    writeMaterial(root_, now, materialIds_[i]);
  }
}

void Writer::writeChangedEmitters(const Scene& before) {
  const std::vector<std::string> names = designNames(before.emitters);
  for (size_t i = 0; i < scene_.emitters.size(); ++i) {
    const Emitter& emitter = scene_.emitters[i];
    if (i >= before.emitters.size()) {  // a new one
      std::string id;
      do {
        id = ids_.make(emitter.name, "light");
      } while (!namedInDesign(before.emitters, id).empty());
      writeEmitter(emitter, id);
      continue;
    }
    if (sameEmitter(before.emitters[i], emitter)) continue;
    const bool role = isSurrounding(emitter.type) || emitter.type == EmitterType::sun;
    std::string id = role ? emitter.name : names[i];
    const bool plain = cleanName(id) == id && !id.empty();
    if (role && !isFirstOfItsRole(before.emitters, i)) id = placeName("emitter", i);
    if ((role && !plain) || (plain && ids_.make(id, "") != id)) id = placeName("emitter", i);
    if (!role || id == placeName("emitter", i)) requireMeant(before.emitters, id, i, designFile_);
    writeEmitter(emitter, id);
  }
}

void Writer::writeChangedCameras(const Scene& before) {
  for (size_t i = 0; i < scene_.cameras.size(); ++i) {
    if (i >= before.cameras.size() || sameCamera(before.cameras[i], scene_.cameras[i])) continue;
    const std::string& name = before.cameras[i].name;
    const bool known = !name.empty() && cleanName(name) == name &&
                       namedInDesign(before.cameras, name).size() == 1 &&
                       ids_.make(name, "") == name;
    writeCamera(scene_.cameras[i], known ? name : placeName("camera", i));
  }
}

}  // namespace mitsuba

std::vector<std::string> changedMaterials(const std::vector<Material>& before,
                                          const std::vector<Material>& now) {
  const std::vector<std::string> names = designNames(before);
  std::vector<std::string> changed;
  for (size_t i = 0; i < std::min(before.size(), now.size()); ++i)
    if (!mitsuba::sameMaterial(before[i], now[i])) changed.push_back(names[i]);
  return changed;
}

void writeDesign(const std::string& file, const Scene& before, const Scene& now) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  mitsuba::Writer(now, folder.empty() ? "." : folder.string()).writeDesign(file, before);
}

}  // namespace lobelia::io
