// Scenes of version 0.x that never say `twosided` but come from renderers whose surfaces reflect on
// both sides: their walls face any way. Mitsuba 0.6 would show backs black, which nobody who wrote
// such a scene has seen. They are shaded from both sides, and the reader says so.
#include "lobelia/io/mitsuba/reader.h"

namespace lobelia::io::mitsuba {
namespace {

bool isWrapper(MaterialType type) {
  return type == MaterialType::blend || type == MaterialType::bump ||
         type == MaterialType::normalMap || type == MaterialType::mask;
}

// Opaque reflectors only: what transmits has two sides that differ.
bool isReflector(const Scene& scene, MaterialHandle handle) {
  if (!handle.valid()) return true;
  const Material& m = scene[handle];
  switch (m.type) {
    case MaterialType::dielectric:
    case MaterialType::thinDielectric:
    case MaterialType::roughDielectric:
    case MaterialType::diffuseTransmitter:
    case MaterialType::null:
    case MaterialType::twoSided:
      return false;
    case MaterialType::principled:
    case MaterialType::metallicRoughness:
      return m.specTrans.value == 0 && !m.specTrans.texture.valid();
    default:
      return !isWrapper(m.type) || (isReflector(scene, m.a) && isReflector(scene, m.b));
  }
}

}  // namespace

MaterialHandle Reader::twoSided(MaterialHandle handle) {
  if (!handle.valid() || !isReflector(scene_, handle)) return handle;
  const auto [entry, isNew] = twoSided_.try_emplace(handle.index);
  if (!isNew) return entry->second;
  Material material = scene_[handle];
  if (material.type == MaterialType::mask) {
    material.a = twoSided(material.a);
  } else {
    material = Material{};
    material.type = MaterialType::twoSided;
    material.a = handle;
  }
  const MaterialHandle wrapped = add(material);
  twoSided_[handle.index] = wrapped;
  return wrapped;
}

void Reader::assumeTwoSided() {
  if (!document_.scene.legacy) return;
  for (const Material& material : scene_.materials) {
    if (material.type == MaterialType::twoSided) return;
  }
  bool any = false;
  for (Instance& instance : scene_.instances) {
    const MaterialHandle wrapped = twoSided(instance.material);
    any = any || !(wrapped == instance.material);
    instance.material = wrapped;
  }
  if (!any) return;
  findings_.inform(document_.scene.where,
                   "no material of this scene is twosided; reflecting surfaces are shaded from "
                   "both sides (wrap materials in <bsdf type=\"twosided\"> to say so)");
}

}  // namespace lobelia::io::mitsuba
