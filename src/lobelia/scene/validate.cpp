// Validation of a scene as a list of findings. Errors are what rendering cannot survive (handles
// and indices out of range, cycles, singular transforms, values that are not finite); warnings what
// gives a doubtful image.
#include "lobelia/scene/validate.h"

#include <fmt/format.h>

#include <cmath>

#include "lobelia/scene/emitter_frame.h"

namespace lobelia {
namespace validation {

std::string label(const char* kind, const std::string& name, size_t index) {
  return name.empty() ? fmt::format("{} {}", kind, index) : fmt::format("{} '{}'", kind, name);
}

namespace {

bool isUsable(const Transform& t) { return t.to.isFinite() && inverse(t.to).has_value(); }

void checkTransform(const Transform& t, const std::string& who, Findings& findings) {
  if (!t.to.isFinite()) {
    findings.error(who + ": its transform has entries that are not finite");
  } else if (!isUsable(t)) {
    findings.error(who + ": its transform is singular; it must not flatten space (scale of 0?)");
  }
}

void checkRigid(const Emitter& e, const std::string& who, Findings& findings) {
  if (!isUsable(e.toWorld) || keepsAngles(e)) return;
  findings.warning(who +
                   ": its transform scales unevenly or shears; that is ignored, a light at a point "
                   "is only moved, turned and mirrored");
}

bool isNegative(Rgb c) { return minComponent(c) < 0; }

}  // namespace

void checkInstances(const Scene& scene, Findings& findings) {
  for (size_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const std::string who = label("instance", instance.name, i);
    if (instance.mesh.index >= scene.meshes.size()) {
      findings.error(fmt::format("{}: mesh {} does not exist; the scene has {}", who,
                                 instance.mesh.index, scene.meshes.size()));
    }
    if (instance.material.index >= scene.materials.size()) {
      findings.error(instance.material.valid()
                         ? fmt::format("{}: material {} does not exist; the scene has {}", who,
                                       instance.material.index, scene.materials.size())
                         : who + ": has no material");
    }
    if (instance.emitter.valid()) {
      if (instance.emitter.index >= scene.emitters.size()) {
        findings.error(fmt::format("{}: emitter {} does not exist; the scene has {}", who,
                                   instance.emitter.index, scene.emitters.size()));
      } else if (scene[instance.emitter].type != EmitterType::area) {
        findings.error(
            fmt::format("{}: {} is not an area emitter", who,
                        label("emitter", scene[instance.emitter].name, instance.emitter.index)));
      } else if (instance.material.index < scene.materials.size() &&
                 scene[instance.material].type == MaterialType::null) {
        findings.warning(who +
                         ": emits, but its material is `null`, so no ray stops there to see "
                         "the emission");
      }
    }
    checkTransform(instance.toWorld, who, findings);
  }
}

void checkEmitters(const Scene& scene, Findings& findings) {
  std::vector<bool> onSurface(scene.emitters.size(), false);
  for (const Instance& i : scene.instances) {
    if (i.emitter.index < onSurface.size()) onSurface[i.emitter.index] = true;
  }
  if (scene.emitters.empty()) findings.warning("the scene has no emitter: its image is black");
  for (size_t i = 0; i < scene.emitters.size(); ++i) {
    const Emitter& e = scene.emitters[i];
    const std::string who = label("emitter", e.name, i);
    if (e.radiance.texture.valid() && e.radiance.texture.index >= scene.textures.size()) {
      findings.error(fmt::format("{}: texture {} does not exist", who, e.radiance.texture.index));
    }
    if (e.pattern.valid() && e.pattern.index >= scene.textures.size()) {
      findings.error(fmt::format("{}: texture {} does not exist", who, e.pattern.index));
    }
    if (!isFinite(e.radiance.value) || !std::isfinite(e.scale)) {
      findings.error(who + ": its radiance is not finite");
    } else if (isNegative(e.radiance.value) || e.scale < 0) {
      findings.warning(who + ": its radiance is negative");
    }
    checkTransform(e.toWorld, who, findings);
    switch (e.type) {
      case EmitterType::area:
        if (!onSurface[i]) findings.warning(who + ": an area emitter that no surface has");
        break;
      case EmitterType::environment:
      case EmitterType::goniometric:
        if (e.image.index >= scene.images.size()) findings.error(who + ": has no image");
        if (e.type == EmitterType::goniometric) checkRigid(e, who, findings);
        break;
      case EmitterType::sun:
        if (!(e.angularRadius >= 0 && e.angularRadius <= kPi / 2)) {
          findings.error(who + ": its angular radius must lie between 0 and 90 degrees");
        }
        [[fallthrough]];
      case EmitterType::directional:
        if (!isFinite(e.direction) || !(length(e.direction) > 0)) {
          findings.error(who + ": its direction must be finite and not zero");
        }
        break;
      case EmitterType::spot:
        if (!(e.cutoff > 0) || !(e.beamWidth >= 0) || e.beamWidth > e.cutoff) {
          findings.error(who + ": needs 0 <= beam width <= cutoff angle, cutoff above 0");
        }
        checkRigid(e, who, findings);
        break;
      case EmitterType::projector:
        if (!(e.fov > 0 && e.fov < kPi)) {
          findings.error(who + ": its field of view must lie between 0 and 180 degrees");
        }
        checkRigid(e, who, findings);
        break;
      case EmitterType::point:
      case EmitterType::constant:
        break;
    }
  }
}

void checkCameras(const Scene& scene, Findings& findings) {
  if (scene.cameras.empty()) findings.warning("the scene has no camera");
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    const Camera& c = scene.cameras[i];
    const std::string who = label("camera", c.name, i);
    checkTransform(c.toWorld, who, findings);
    for (size_t k = 0; k < c.path.size(); ++k) {
      checkTransform(c.path[k].toWorld, who + ", key " + std::to_string(k), findings);
      if (!std::isfinite(c.path[k].time) || (k > 0 && !(c.path[k].time > c.path[k - 1].time))) {
        findings.error(fmt::format("{}: the times of its path must rise; key {} does not", who, k));
        break;
      }
    }
    if (c.width < 1 || c.height < 1) {
      findings.error(fmt::format("{}: a film of {}x{} pixels; both must be 1 or more", who, c.width,
                                 c.height));
    }
    if (c.type == CameraType::perspective && !(c.fovX > 0 && c.fovX < kPi)) {
      findings.error(who + ": its field of view must lie between 0 and 180 degrees");
    }
    if (!(c.nearClip >= 0 && c.farClip > c.nearClip)) {
      findings.error(who + ": needs 0 <= near clip < far clip");
    }
    if (!(c.apertureRadius >= 0) || (c.apertureRadius > 0 && !(c.focusDistance > 0))) {
      findings.error(who + ": a lens needs a radius and a focus distance above 0");
    }
    const bool crop = c.cropX1 != 0 || c.cropY1 != 0;
    if (crop && (c.cropX0 < 0 || c.cropY0 < 0 || c.cropX1 > c.width || c.cropY1 > c.height ||
                 c.cropX0 >= c.cropX1 || c.cropY0 >= c.cropY1)) {
      findings.error(fmt::format("{}: the crop {},{} to {},{} is not a window of its {}x{} film",
                                 who, c.cropX0, c.cropY0, c.cropX1, c.cropY1, c.width, c.height));
    }
  }
}

}  // namespace validation

std::vector<Finding> validate(const Scene& scene) {
  validation::Findings findings(scene.file);
  const bool textures = validation::checkTextures(scene, findings);
  if (validation::checkMaterials(scene, textures, findings)) {
    validation::checkLobes(scene, findings);
  }
  validation::checkMeshes(scene, findings);
  validation::checkInstances(scene, findings);
  validation::checkEmitters(scene, findings);
  validation::checkCameras(scene, findings);
  return findings.take();
}

}  // namespace lobelia
