// On which sides of a surface light matters.
#include "lobelia/relight/visibility_data.h"

namespace lobelia::relight {
namespace {

// Deeper trees than any file has; a cycle (validate() reports it) ends here.
constexpr int kMaxDepth = 64;

bool isZero(const FloatParam& p) { return !p.texture.valid() && p.value == 0; }

// twoSided: does it count what a two-sided material has on its back?
bool reachesBehind(const Scene& scene, MaterialHandle handle, bool twoSided, int depth) {
  if (!handle.valid() || depth > kMaxDepth) return false;
  const Material& m = scene[handle];
  const auto anyInside = [&] {
    return reachesBehind(scene, m.a, twoSided, depth + 1) ||
           reachesBehind(scene, m.b, twoSided, depth + 1);
  };
  switch (m.type) {
    case MaterialType::twoSided:
      return twoSided || anyInside();
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
    case MaterialType::blend:
      return anyInside();
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
  return reachesBehind(scene, material, true, 0);
}
std::vector<uint8_t> bothSidesOf(const Scene& scene) {
  std::vector<uint8_t> out;
  for (const Instance& instance : scene.instances)
    out.push_back(scattersBehind(scene, instance.material) ? 1 : 0);
  return out;
}
bool transmits(const Scene& scene, MaterialHandle material) {
  return reachesBehind(scene, material, false, 0);
}

}  // namespace lobelia::relight
