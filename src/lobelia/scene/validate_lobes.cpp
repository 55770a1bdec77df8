// What a material may ask of one point and a Bsdf cannot hold: too many lobes or frames, wrappers
// too deep.
// makeBsdf() leaves out what does not fit; here it is said.
#include <fmt/format.h>

#include <optional>

#include "lobelia/scene/material_lobes.h"
#include "lobelia/scene/validate.h"

namespace lobelia::validation {
namespace {

bool mayExceed(const FloatParam& p, float limit) { return p.texture.valid() || p.value > limit; }
bool mayBeBelow(const FloatParam& p, float limit) { return p.texture.valid() || p.value < limit; }

int metallicRoughnessLobes(const Material& m) {
  const bool sheen = m.sheenColor.texture.valid() || maxComponent(m.sheenColor.value) > 0;
  return 2 + (mayExceed(m.clearcoat, 0) ? 1 : 0) + (sheen ? 1 : 0) +
         (mayExceed(m.specTrans, 0) ? 1 : 0);
}

int principledLobes(const Material& m) {
  const bool transmits = mayBeBelow(m.metallic, 1) && mayExceed(m.specTrans, 0);
  const bool diffuse = mayBeBelow(m.metallic, 1) && mayBeBelow(m.specTrans, 1);
  return 1 + (diffuse ? 1 : 0) + (transmits ? 1 : 0) + (mayExceed(m.clearcoat, 0) ? 1 : 0);
}

// Frames that glTF's material adds to those around it: a turned and a coat's.
int metallicRoughnessFrames(const Material& m) {
  return (mayExceed(m.anisotropic, 0) ? 1 : 0) +
         (mayExceed(m.clearcoat, 0) && m.clearcoatNormal.valid() ? 1 : 0);
}

// The most that a material may need at any point: lobes, wrappers inside each other, and frames
// beside the surface's own.
struct Need {
  int lobes = 0, depth = 0, frames = 0;
};

// Counts each material once: blends may share what they wrap. The tree has no cycles, but may be so
// deep that it must not be followed to its end.
class Needs {
 public:
  explicit Needs(const Scene& scene) : scene_(scene), known_(scene.materials.size()) {}

  Need of(MaterialHandle handle, int level = 0) {
    if (!handle.valid()) return {};
    if (level > 2 * kMaxNesting) return {0, 1};
    std::optional<Need>& known = known_[handle.index];
    if (!known) known = count(scene_[handle], level + 1);
    return *known;
  }

 private:
  Need count(const Material& m, int level) {
    switch (m.type) {
      case MaterialType::diffuse:
      case MaterialType::conductor:
      case MaterialType::roughConductor:
      case MaterialType::null:
        return {1, 0};
      case MaterialType::dielectric:
      case MaterialType::thinDielectric:
      case MaterialType::roughDielectric:
      case MaterialType::plastic:
      case MaterialType::roughPlastic:
      case MaterialType::phong:
      case MaterialType::ward:
      case MaterialType::diffuseTransmitter:
      case MaterialType::coatedConductor:
        return {2, 0};
      case MaterialType::metallicRoughness:
        return {metallicRoughnessLobes(m), 0, metallicRoughnessFrames(m)};
      case MaterialType::principled:
        return {principledLobes(m), 0};
      case MaterialType::sphericalGaussians:
        return {1 + static_cast<int>(std::min<size_t>(m.capturedLobes.size(), 1000)), 0};
      case MaterialType::twoSided: {
        const Need a = of(m.a, level), b = of(m.b, level);
        return {std::max(a.lobes, b.lobes), 1 + std::max(a.depth, b.depth),
                std::max(a.frames, b.frames)};
      }
      case MaterialType::blend: {
        const Need a = mayBeBelow(m.weight, 1) ? of(m.a, level) : Need{};
        const Need b = mayExceed(m.weight, 0) ? of(m.b, level) : Need{};
        // No more than matters, so that shared branches do not overflow.
        return {std::min(a.lobes + b.lobes, 1000), 1 + std::max(a.depth, b.depth),
                std::min(a.frames + b.frames, 1000)};
      }
      case MaterialType::mask:
      case MaterialType::bump:
      case MaterialType::normalMap: {
        const Need a = of(m.a, level);
        return {a.lobes, 1 + a.depth, a.frames + (m.type == MaterialType::mask ? 0 : 1)};
      }
    }
    return {};
  }

  const Scene& scene_;
  std::vector<std::optional<Need>> known_;
};

}  // namespace

void checkLobes(const Scene& scene, Findings& findings) {
  Needs needs(scene);
  std::vector<bool> seen(scene.materials.size(), false);
  for (const Instance& instance : scene.instances) {
    const size_t i = instance.material.index;
    if (i >= seen.size() || seen[i]) continue;
    seen[i] = true;
    const Need need = needs.of(instance.material);
    const std::string who = label("material", scene.materials[i].name, i);
    if (need.lobes > kMaxLobes) {
      findings.warning(
          fmt::format("{}: blends up to {} lobes at a point; {} are kept, the rest is lost", who,
                      need.lobes, kMaxLobes));
    }
    if (need.frames >= kMaxFrames) {
      findings.warning(fmt::format(
          "{}: may need {} different normals and tangents at a point; of more than {} the last "
          "take the first's",
          who, need.frames + 1, kMaxFrames));
    }
    if (need.depth > kMaxNesting) {
      findings.warning(fmt::format("{}: {} materials are nested; what is deeper than {} is lost",
                                   who, need.depth, kMaxNesting));
    }
  }
}

}  // namespace lobelia::validation
