// Virtual lights on disk (--save-lights, --load-lights), as chunks of a store file. What is read is
// checked before anything uses it: a checksum proves that the file is what was written, not that
// what was written makes sense.
#include <fmt/format.h>

#include <string>

#include "lobelia/base/error.h"
#include "lobelia/lights/light_pass.h"
#include "lobelia/scene/light_groups.h"
#include "lobelia/store/store.h"

namespace lobelia {
namespace {

constexpr const char* kKind = "virtual-lights";
constexpr uint32_t kVersion = 6;

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

// Empty: none of the lights has a group of its own.
void checkGroups(const std::string& file, const char* name, const std::vector<uint16_t>& groups,
                 size_t count) {
  if (!groups.empty() && groups.size() != count)
    damaged(file,
            fmt::format("the table of groups of the {} lights does not fit their number", name));
}

void checkGroups(const std::string& file, const VirtualLights& lights) {
  checkGroups(file, "omni", lights.omniGroups, lights.omni.size());
  checkGroups(file, "directional", lights.directionalGroups, lights.directional.size());
  checkGroups(file, "glossy", lights.glossyGroups, lights.glossy.size());
  size_t last = 0;
  for (const auto* groups : {&lights.omniGroups, &lights.directionalGroups, &lights.glossyGroups})
    for (const uint16_t g : *groups) last = std::max<size_t>(last, g);
  for (const DiffuseLight& l : lights.diffuse) last = std::max<size_t>(last, l.tag >> 8);
  for (const SphericalLight& l : lights.spherical) last = std::max<size_t>(last, l.group);
  for (const GaussianLight& l : lights.gaussian) last = std::max<size_t>(last, l.group);
  if (last >= std::max<size_t>(lights.groups.size(), 1))
    damaged(file, fmt::format("a light names light group {} of {}", last, lights.groups.size()));
}

bool isUnit(Vec3f v) { return std::abs(lengthSquared(v) - 1) < 1e-3f; }
bool isSharpness(float s) { return std::isfinite(s) && s >= 0; }

bool isGood(const GaussianLight& l) {
  bool good = isFinite(l.mean) && isFinite(l.diffuse) && isFinite(l.glossy) && isUnit(l.normal) &&
              isUnit(l.axis) && isSharpness(l.normalSharpness) && isSharpness(l.sharpness);
  for (int i = 0; i < 6; ++i) good &= std::isfinite(l.covariance[i]);
  for (int i = 0; i < 3; ++i) good &= l.covariance[i] >= 0;
  for (const GaussianLight::Place& place : l.places) good &= isFinite(place.p);
  return good;
}

void checkRecords(const std::string& file, const VirtualLights& lights) {
  bool good = true;
  for (const OmniLight& l : lights.omni) good &= isFinite(l.p) && isFinite(l.intensity);
  for (const DirectionalLight& l : lights.directional)
    good &= isUnit(l.direction) && isFinite(l.irradiance);
  for (const DiffuseLight& l : lights.diffuse) good &= isFinite(l.p) && isFinite(l.intensity);
  for (const GlossyLight& l : lights.glossy)
    good &= isFinite(l.p) && isUnit(l.n) && isUnit(l.axis) && isFinite(l.intensity) &&
            isSharpness(l.sharpness);
  for (const SphericalLight& l : lights.spherical)
    good &= isFinite(l.p) && isFinite(l.power) && std::isfinite(l.b1) && std::isfinite(l.b2) &&
            std::isfinite(l.radius) && l.radius > 0;
  for (const GaussianLight& l : lights.gaussian) good &= isGood(l);
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
  writer.add("spherical", spanOf(lights.spherical));
  writer.add("gaussian", spanOf(lights.gaussian));
  writer.add("diffuse-depths", spanOf(lights.diffuseDepthEnds));
  writer.add("glossy-depths", spanOf(lights.glossyDepthEnds));
  writer.add("spherical-depths", spanOf(lights.sphericalDepthEnds));
  writer.add("gaussian-depths", spanOf(lights.gaussianDepthEnds));
  std::vector<char> names;  // each ended by a zero
  for (const std::string& name : lights.groups)
    names.insert(names.end(), name.c_str(), name.c_str() + name.size() + 1);
  writer.add("group-names", spanOf(names));
  writer.add("omni-groups", spanOf(lights.omniGroups));
  writer.add("directional-groups", spanOf(lights.directionalGroups));
  writer.add("glossy-groups", spanOf(lights.glossyGroups));
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
  lights.spherical = reader.get<SphericalLight>("spherical");
  lights.gaussian = reader.get<GaussianLight>("gaussian");
  lights.diffuseDepthEnds = reader.get<uint32_t>("diffuse-depths");
  lights.glossyDepthEnds = reader.get<uint32_t>("glossy-depths");
  lights.sphericalDepthEnds = reader.get<uint32_t>("spherical-depths");
  lights.gaussianDepthEnds = reader.get<uint32_t>("gaussian-depths");
  checkDepthEnds(file, "spherical", lights.sphericalDepthEnds, lights.spherical.size());
  checkDepthEnds(file, "diffuse", lights.diffuseDepthEnds, lights.diffuse.size());
  checkDepthEnds(file, "glossy", lights.glossyDepthEnds, lights.glossy.size());
  checkDepthEnds(file, "Gaussian", lights.gaussianDepthEnds, lights.gaussian.size());
  const std::vector<char> names = reader.get<char>("group-names");
  if (!names.empty() && names.back() != '\0') damaged(file, "the names of light groups do not end");
  for (size_t i = 0; i < names.size(); i += lights.groups.back().size() + 1)
    lights.groups.emplace_back(&names[i]);
  lights.omniGroups = reader.get<uint16_t>("omni-groups");
  lights.directionalGroups = reader.get<uint16_t>("directional-groups");
  lights.glossyGroups = reader.get<uint16_t>("glossy-groups");
  checkGroups(file, lights);
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
  if (!lights.gaussian.empty() && lights.maxDepth < 0 && settings.maxDepth >= 0)
    refuse(
        fmt::format("holds clusters of light of all depths, which cannot be told apart; save it "
                    "with --max-depth {} or more",
                    settings.maxDepth));
  const LightGroups groups = lightGroups(scene);
  if (lights.groups.empty() ? groups.size() > 1 : lights.groups != groups.names)
    refuse("holds lights of other light groups than the scene has; save it again");
  const auto checkEmitter = [&](uint32_t emitter) {
    if (emitter != 0xffffffffu && emitter >= scene.emitters.size())
      damaged(file, fmt::format("a light names emitter {}; the scene has {}", emitter,
                                scene.emitters.size()));
  };
  for (const SphericalLight& l : lights.spherical) {
    if (l.instance >= scene.instances.size() ||
        l.triangle >= scene.meshes[scene.instances[l.instance].mesh.index].triangles.size())
      damaged(file, fmt::format("a light names triangle {} of instance {}, which the scene lacks",
                                l.triangle, l.instance));
  }
  for (const OmniLight& l : lights.omni) checkEmitter(l.emitter);
  for (const DirectionalLight& l : lights.directional) checkEmitter(l.emitter);
}

}  // namespace lobelia
