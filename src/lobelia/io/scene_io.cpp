// Which reader reads a scene file (decided by its extension), and what applies to all of them.

#include "lobelia/io/scene_io.h"

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "lobelia/io/image_io.h"
#include "lobelia/io/sky.h"

namespace lobelia::io {

Scene readScene(const std::string& file, const ReadSettings& settings, Context& context) {
  std::string extension = std::filesystem::path(file).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".gltf" || extension == ".glb") return readGltf(file, settings, context);
  if (!settings.variant.empty())
    throw UsageError("--variant " + settings.variant + ": only glTF files have material variants");
  if (extension == ".xml") return readMitsuba(file, settings, context);
  if (settings.time != 0)
    throw UsageError("--time: only glTF files and cameras of Mitsuba files have animations");
  if (extension == ".obj" || extension == ".ply") return readBareMesh(file, settings, context);
  const bool isPackedPbrt = extension == ".gz" && file.find(".pbrt.") != std::string::npos;
  if (extension == ".pbrt" || isPackedPbrt) return readPbrt(file, settings, context);
  throw InputError({file, 0, 0}, "no reader knows the extension '" + extension +
                                     "'; scenes that can be read: .xml (Mitsuba 0.5 to 3), "
                                     ".pbrt and .pbrt.gz (PBRT-v4), .gltf and .glb (glTF 2.0), "
                                     ".obj and .ply (meshes); a file of `lobelia precompute` "
                                     "goes to --data, and if `lobelia info` says this of one, it "
                                     "is damaged");
}

// Handles of the other emitters stay valid: an environment there is replaced in its place.
void applyEnvironment(Scene& scene, const ReadSettings& settings) {
  if (!settings.sky.empty()) {
    if (!settings.environment.empty())
      throw UsageError("--environment and --sky: a scene can have one of them");
    return applySky(scene, settings.sky);
  }
  if (settings.environment.empty()) return;
  Emitter emitter;
  emitter.type = EmitterType::environment;
  emitter.name = "environment";
  scene.images.push_back(readImage(settings.environment, {}));
  emitter.image = {static_cast<uint32_t>(scene.images.size() - 1)};
  for (Emitter& other : scene.emitters) {
    if (other.type == EmitterType::constant || other.type == EmitterType::environment) {
      other = emitter;
      return;
    }
  }
  scene.emitters.push_back(emitter);
}

}  // namespace lobelia::io
