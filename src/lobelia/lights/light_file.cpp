// Virtual lights on disk (--save-lights, --load-lights), as chunks of a store file. What is read is
// checked before anything uses it: a checksum proves that the file is what was written, not that
// what was written makes sense.
#include <fmt/format.h>

#include <string>

#include "lobelia/base/error.h"
#include "lobelia/lights/light_pass.h"
#include "lobelia/store/store.h"

namespace lobelia {
namespace {

constexpr const char* kKind = "virtual-lights";
constexpr uint32_t kVersion = 3;

// The chunk "settings".
struct StoredSettings {
  int32_t maxDepth;
  float specularLimit;
  uint32_t direct;
};

[[noreturn]] void damaged(const std::string& file, const std::string& what) {
  throw InputError({file, 0, 0},
                   what + "; the file should be written again with --save-lights by this version");
}

void checkDepthEnds(const std::string& file, const char* name, const std::vector<uint32_t>& ends,
                    size_t count) {
  const bool sorted = std::is_sorted(ends.begin(), ends.end());
  const size_t last = ends.empty() ? 0 : ends.back();
  if (!sorted || last != count)
    damaged(file, std::string("the table of depths of the ") + name +
                      " lights does not fit their number");
}

bool isUnit(Vec3f v) { return std::abs(lengthSquared(v) - 1) < 1e-3f; }

void checkRecords(const std::string& file, const VirtualLights& lights) {
  bool good = true;
  for (const OmniLight& l : lights.omni) good &= isFinite(l.p) && isFinite(l.intensity);
  for (const DirectionalLight& l : lights.directional)
    good &= isUnit(l.direction) && isFinite(l.irradiance);
  for (const DiffuseLight& l : lights.diffuse) good &= isFinite(l.p) && isFinite(l.intensity);
  for (const GlossyLight& l : lights.glossy)
    good &= isFinite(l.p) && isUnit(l.n) && isUnit(l.axis) && isFinite(l.intensity) &&
            std::isfinite(l.sharpness) && l.sharpness >= 0;
  if (!good) damaged(file, "a light record holds numbers that are not finite or not unit vectors");
}

template <class T>
std::span<const T> spanOf(const std::vector<T>& values) {
  return {values.data(), values.size()};
}

}  // namespace

void saveLights(const std::string& file, const VirtualLights& lights) {
  store::Writer writer(kKind, kVersion, lights.sceneHash);
  const std::vector<char> model(lights.model.begin(), lights.model.end());
  const std::vector<uint64_t> origin{lights.seed, lights.particles};
  writer.add("model", spanOf(model));
  writer.add("origin", spanOf(origin));
  const std::vector<StoredSettings> settings{
      {lights.maxDepth, lights.specularLimit, lights.direct ? 1u : 0u}};
  writer.add("settings", spanOf(settings));
  writer.add("omni", spanOf(lights.omni));
  writer.add("directional", spanOf(lights.directional));
  writer.add("diffuse", spanOf(lights.diffuse));
  writer.add("glossy", spanOf(lights.glossy));
  writer.add("diffuse-depths", spanOf(lights.diffuseDepthEnds));
  writer.add("glossy-depths", spanOf(lights.glossyDepthEnds));
  writer.save(file);
}

VirtualLights loadLights(const std::string& file, uint64_t sceneHash) {
  const store::Reader reader(file, kKind, kVersion);
  if (reader.sceneHash() != sceneHash)
    throw InputError({file, 0, 0},
                     "these lights were made for another scene (or the scene was changed since); "
                     "save them again for this one");
  VirtualLights lights;
  const std::vector<char> model = reader.get<char>("model");
  lights.model.assign(model.begin(), model.end());
  const std::vector<uint64_t> origin = reader.get<uint64_t>("origin");
  if (origin.size() != 2) damaged(file, "the chunk 'origin' should hold seed and particle count");
  lights.seed = origin[0];
  lights.particles = origin[1];
  const std::vector<StoredSettings> settings = reader.get<StoredSettings>("settings");
  if (settings.size() != 1) damaged(file, "the chunk 'settings' should hold one record");
  lights.maxDepth = settings[0].maxDepth;
  lights.specularLimit = settings[0].specularLimit;
  lights.direct = settings[0].direct != 0;
  lights.sceneHash = sceneHash;
  lights.omni = reader.get<OmniLight>("omni");
  lights.directional = reader.get<DirectionalLight>("directional");
  lights.diffuse = reader.get<DiffuseLight>("diffuse");
  lights.glossy = reader.get<GlossyLight>("glossy");
  lights.diffuseDepthEnds = reader.get<uint32_t>("diffuse-depths");
  lights.glossyDepthEnds = reader.get<uint32_t>("glossy-depths");
  checkDepthEnds(file, "diffuse", lights.diffuseDepthEnds, lights.diffuse.size());
  checkDepthEnds(file, "glossy", lights.glossyDepthEnds, lights.glossy.size());
  checkRecords(file, lights);
  return lights;
}

void requireFit(const std::string& file, const VirtualLights& lights, const LightSettings& settings,
                const Scene& scene) {
  const auto refuse = [&](const std::string& what) { throw InputError({file, 0, 0}, what); };
  if (lights.specularLimit != settings.specularLimit)
    refuse(
        fmt::format("was made with a specular limit of {:g}, not {:g}; use --specular-limit {:g}",
                    lights.specularLimit, settings.specularLimit, lights.specularLimit));
  if (settings.directAsLights && !lights.direct)
    refuse("holds no lights of the emitters themselves; save it with --direct lights");
  const bool deepEnough =
      lights.maxDepth < 0 || (settings.maxDepth >= 0 && settings.maxDepth <= lights.maxDepth);
  if (!deepEnough)
    refuse(fmt::format("was made for paths of at most {} edges; use --max-depth {} or less",
                       lights.maxDepth, lights.maxDepth));
  const auto checkEmitter = [&](uint32_t emitter) {
    if (emitter != 0xffffffffu && emitter >= scene.emitters.size())
      damaged(file, fmt::format("a light names emitter {}; the scene has {}", emitter,
                                scene.emitters.size()));
  };
  for (const OmniLight& l : lights.omni) checkEmitter(l.emitter);
  for (const DirectionalLight& l : lights.directional) checkEmitter(l.emitter);
}

}  // namespace lobelia
