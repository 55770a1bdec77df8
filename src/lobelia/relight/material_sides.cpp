// On which sides of a surface light matters.
#include "lobelia/relight/visibility_data.h"

namespace lobelia::relight {
namespace {

// Deeper trees than any file has; a cycle (validate() reports it) ends here.
constexpr int kMaxDepth = 64;

bool isZero(const FloatParam& p) { return !p.texture.valid() && p.value == 0; }

bool scattersBehind(const Scene& scene, MaterialHandle handle, int depth) {
  if (!handle.valid() || depth > kMaxDepth) return false;
  const Material& m = scene[handle];
  switch (m.type) {
    case MaterialType::twoSided:
    case MaterialType::dielectric:
    case MaterialType::thinDielectric:
    case MaterialType::roughDielectric:
    case MaterialType::diffuseTransmitter:
      return true;
    case MaterialType::principled:
    case MaterialType::metallicRoughness:
      return !isZero(m.specTrans);
    case MaterialType::mask:
    case MaterialType::bump:
    case MaterialType::normalMap:
      return scattersBehind(scene, m.a, depth + 1);
    case MaterialType::blend:
      return scattersBehind(scene, m.a, depth + 1) || scattersBehind(scene, m.b, depth + 1);
    case MaterialType::diffuse:
    case MaterialType::conductor:
    case MaterialType::roughConductor:
    case MaterialType::plastic:
    case MaterialType::roughPlastic:
    case MaterialType::phong:
    case MaterialType::ward:
    case MaterialType::coatedConductor:
    case MaterialType::sphericalGaussians:
    case MaterialType::null:
      return false;
  }
  return false;
}

}  // namespace

bool scattersBehind(const Scene& scene, MaterialHandle material) {
  return scattersBehind(scene, material, 0);
}

}  // namespace lobelia::relight
