// The probability that a ray stops at a surface, from the tree of materials.
#include <algorithm>

#include "lobelia/scene/shading.h"

namespace lobelia {
namespace {

// Deeper trees than any file has; a cycle (validate() reports it) ends here.
constexpr int kMaxDepth = 64;

float opacity(const Scene& scene, MaterialHandle handle, const TextureContext& at, int depth) {
  if (!handle.valid() || depth > kMaxDepth) return 1;
  const Material& m = scene[handle];
  switch (m.type) {
    case MaterialType::null:
      return 0;
    case MaterialType::mask: {
      const float own = std::clamp(evaluate(scene, m.opacity, at), 0.f, 1.f);
      return own > 0 ? own * opacity(scene, m.a, at, depth + 1) : 0.f;
    }
    case MaterialType::blend: {
      const float w = std::clamp(evaluate(scene, m.weight, at), 0.f, 1.f);
      return (1 - w) * opacity(scene, m.a, at, depth + 1) + w * opacity(scene, m.b, at, depth + 1);
    }
    case MaterialType::twoSided:
    case MaterialType::bump:
    case MaterialType::normalMap:
      return opacity(scene, m.a, at, depth + 1);
    default:
      return 1;
  }
}

bool hasOpacity(const Scene& scene, MaterialHandle handle, int depth) {
  if (!handle.valid() || depth > kMaxDepth) return false;
  const Material& m = scene[handle];
  switch (m.type) {
    case MaterialType::null:
      return true;
    case MaterialType::mask:
      return m.opacity.texture.valid() || m.opacity.value < 1 || hasOpacity(scene, m.a, depth + 1);
    case MaterialType::blend:
      return hasOpacity(scene, m.a, depth + 1) || hasOpacity(scene, m.b, depth + 1);
    case MaterialType::twoSided:
    case MaterialType::bump:
    case MaterialType::normalMap:
      return hasOpacity(scene, m.a, depth + 1);
    default:
      return false;
  }
}

}  // namespace

float opacity(const Scene& scene, MaterialHandle material, const TextureContext& at) {
  return opacity(scene, material, at, 0);
}

bool hasOpacity(const Scene& scene, MaterialHandle material) {
  return hasOpacity(scene, material, 0);
}

}  // namespace lobelia
