// makeBsdf(): walks the tree of wrapping materials (two-sided, mask, blend, bump and normal maps)
// and collects the lobes of what they wrap.
//
// Bump maps follow Blinn 1978 as Mitsuba has them: the tangents are displaced by the gradient of
// the height along the shading normal; derivatives of the normal are neglected. A two-sided
// material that wraps a perturbed one shows its mirror image from behind.
// Normals that face away from the viewer are turned as in Schuessler et al. 2017 [Schuessler17],
// the terminator is softened [Estevez19], both as in Mitsuba since 3.7. Deviations: a BSDF has one
// frame. Where the branches of a blend are perturbed differently, all lobes take the frame of the
// heavier branch; of maps within maps only the outermost counts.
#include <cmath>

#include "lobelia/bsdf/bsdf.h"
#include "lobelia/scene/material_lobes.h"
#include "lobelia/scene/shading.h"

namespace lobelia {
namespace {

struct Walk {
  const Scene& scene;
  const SurfacePoint& at;
  Vec3f wo;
  Bsdf& bsdf;

  void add(MaterialHandle handle, float weight, bool twoSided, int depth);
  void addBlend(const Material& material, float weight, bool twoSided, int depth);
  bool perturb(const Material& material, bool twoSided);
};

// Perturbed normal in the current shading frame.
Vec3f perturbedNormal(const Scene& scene, const Material& material, const SurfacePoint& at,
                      const Frame& frame) {
  if (material.type == MaterialType::normalMap)
    return evaluate(scene, material.map, at.texture) * 2.f - Rgb(1.f);
  const Vec2f slope = gradient(scene, material.map, at.texture) * material.scale;
  const Vec3f u = at.dpdu + frame.n * (slope.x - dot(frame.n, at.dpdu));
  const Vec3f v = at.dpdv + frame.n * (slope.y - dot(frame.n, at.dpdv));
  const Vec3f n = cross(u, v);
  return frame.toLocal(dot(at.ng, n) < 0 ? -n : n);
}

// Tilts the frame; false where nothing can be seen of the surface from wo any more.
bool Walk::perturb(const Material& material, bool twoSided) {
  if (!material.map.valid() || bsdf.perturbed) return true;
  const Frame base = at.frame;  // bsdf.frame may have been turned by an anisotropic material
  Vec3f n = perturbedNormal(scene, material, at, base);
  const float length2 = lengthSquared(n);
  if (!(length2 > 1e-20f) || !std::isfinite(length2)) return true;
  n = n / std::sqrt(length2);
  // A normal that turns away from wo is turned about the old one [Schuessler17].
  Vec3f seen = base.toLocal(wo);
  if (twoSided && seen.z < 0) seen.z = -seen.z;
  if (seen.z * dot(seen, n) <= 0) n = {-n.x, -n.y, n.z};
  // Tangent: the old one, made orthogonal.
  Frame local = frameFromNormalTangent(n, Vec3f(1, 0, 0));
  const float side = dot(wo, base.n);
  if (twoSided && side < 0) {
    local.n = {-local.n.x, -local.n.y, local.n.z};
    local.s.z = -local.s.z;
    local.t.z = -local.t.z;
  }
  bsdf.frame = {base.toWorld(local.s), base.toWorld(local.t), base.toWorld(local.n)};
  bsdf.perturbed = true;
  const float cos2 = n.z * n.z;
  bsdf.bumpAlpha2 = std::min(0.125f * (1 - cos2), cos2) / std::max(cos2, 1e-20f);
  return !twoSided || side * dot(wo, bsdf.frame.n) > 0;
}

void Walk::addBlend(const Material& material, float weight, bool twoSided, int depth) {
  const float second = std::clamp(evaluate(scene, material.weight, at.texture), 0.f, 1.f);
  const float first = 1 - second;
  const bool firstIsHeavier = first >= second;
  if (firstIsHeavier && first > 0) add(material.a, weight * first, twoSided, depth);
  if (second > 0) add(material.b, weight * second, twoSided, depth);
  if (!firstIsHeavier && first > 0) add(material.a, weight * first, twoSided, depth);
}

void Walk::add(MaterialHandle handle, float weight, bool twoSided, int depth) {
  if (!handle.valid() || depth > kMaxNesting) return;
  const Material& material = scene[handle];
  const float cosThetaO = dot(wo, bsdf.frame.n);
  switch (material.type) {
    case MaterialType::twoSided: {
      const bool behind = cosThetaO < 0 && material.b.valid();
      return add(behind ? material.b : material.a, weight, true, depth + 1);
    }
    case MaterialType::mask:
      return add(material.a, weight, twoSided, depth + 1);
    case MaterialType::blend:
      return addBlend(material, weight, twoSided, depth + 1);
    case MaterialType::bump:
    case MaterialType::normalMap:
      if (perturb(material, twoSided)) add(material.a, weight, twoSided, depth + 1);
      return;
    default:
      return addLobes(scene, material, at.texture, cosThetaO, weight, twoSided, bsdf);
  }
}

}  // namespace

Bsdf makeBsdf(const Scene& scene, const SurfacePoint& at, Vec3f wo, float specularLimit) {
  Bsdf bsdf;
  bsdf.frame = at.frame;
  bsdf.ng = at.ng;
  bsdf.baseNormal = at.frame.n;
  Walk{scene, at, wo, bsdf}.add(at.material, 1, false, 0);
  classify(bsdf, specularLimit);
  return bsdf;
}

}  // namespace lobelia
