// makeBsdf(): walks the tree of wrapping materials (two-sided, mask, blend, bump and normal maps)
// and collects the lobes of what they wrap.
//
// Bump maps follow Blinn 1978 as Mitsuba has them: the tangents are displaced by the gradient of
// the height along the shading normal; derivatives of the normal are neglected. A two-sided
// material that wraps a perturbed one shows its mirror image from behind.
// Normals that face away from the viewer are turned as in Schuessler et al. 2017 [Schuessler17],
// the terminator is softened [Estevez19], both as in Mitsuba since 3.7. Every branch of a blend has
// its own frame, and so has a clearcoat: its own normals or those before any map
// (KHR_materials_clearcoat). The frame of the heaviest branch is the BSDF's first. Deviation: of
// maps within maps only the outermost counts.
#include <cmath>

#include "lobelia/bsdf/bsdf.h"
#include "lobelia/scene/lobe_builder.h"
#include "lobelia/scene/shading.h"

namespace lobelia {
namespace {

struct Walk {
  const Scene& scene;
  const SurfacePoint& at;
  Vec3f wo;
  Bsdf& bsdf;

  // Where in the tree: what the wrappers so far have made of a material.
  struct Place {
    const ShadingFrame* frame;
    float weight = 1;
    bool twoSided = false;
    int depth = 0;
    Place inside() const {
      Place next = *this;
      ++next.depth;
      return next;
    }
  };

  void add(MaterialHandle handle, const Place& place);
  void addBlend(const Material& material, const Place& place);
  void addLeaf(const Material& material, const Place& place);
  bool perturb(Vec3f n, bool twoSided, ShadingFrame* frame) const;
};

// A normal map's normal in the surface's shading frame.
Vec3f mappedNormal(const Scene& scene, TextureHandle map, const SurfacePoint& at) {
  return evaluate(scene, map, at.texture) * 2.f - Rgb(1.f);
}

// The normal of a bump or normal map in the surface's shading frame.
Vec3f perturbedNormal(const Scene& scene, const Material& material, const SurfacePoint& at) {
  if (material.type == MaterialType::normalMap) return mappedNormal(scene, material.map, at);
  const Frame& frame = at.frame;
  const Vec2f slope = gradient(scene, material.map, at.texture) * material.scale;
  const Vec3f u = at.dpdu + frame.n * (slope.x - dot(frame.n, at.dpdu));
  const Vec3f v = at.dpdv + frame.n * (slope.y - dot(frame.n, at.dpdv));
  const Vec3f n = cross(u, v);
  return frame.toLocal(dot(at.ng, n) < 0 ? -n : n);
}

// The surface's frame tilted to the normal n (in it); false where nothing can be seen of the
// surface from wo any more.
bool Walk::perturb(Vec3f n, bool twoSided, ShadingFrame* frame) const {
  const Frame& base = at.frame;
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
  *frame = Frame{base.toWorld(local.s), base.toWorld(local.t), base.toWorld(local.n)};
  frame->perturbed = true;
  const float cos2 = n.z * n.z;
  frame->bumpAlpha2 = std::min(0.125f * (1 - cos2), cos2) / std::max(cos2, 1e-20f);
  return !twoSided || side * dot(wo, frame->n) > 0;
}

void Walk::addBlend(const Material& material, const Place& place) {
  const float second = std::clamp(evaluate(scene, material.weight, at.texture), 0.f, 1.f);
  Place a = place.inside(), b = a;
  a.weight *= 1 - second;
  b.weight *= second;
  const bool firstIsHeavier = 1 - second >= second;
  if (firstIsHeavier && second < 1) add(material.a, a);
  if (second > 0) add(material.b, b);
  if (!firstIsHeavier && second < 1) add(material.a, a);
}

void Walk::addLeaf(const Material& material, const Place& place) {
  const uint8_t frame = bsdf.addFrame(*place.frame);
  const float cosThetaO = dot(wo, bsdf.frames[frame].n);
  Builder b{scene, material, at.texture, frame, cosThetaO, place.weight, place.twoSided, bsdf};
  const bool coated = material.clearcoat.texture.valid() || material.clearcoat.value > 0;
  const bool ownNormal = material.clearcoatNormal.valid();
  ShadingFrame coat;
  if (material.type == MaterialType::metallicRoughness && coated &&
      (ownNormal || place.frame->perturbed)) {
    coat = at.frame;
    // Normals that show nothing of the surface are not meant.
    if (ownNormal &&
        !perturb(mappedNormal(scene, material.clearcoatNormal, at), place.twoSided, &coat))
      coat = at.frame;
    b.coatFrame = &coat;
    b.coatCosThetaO = dot(wo, coat.n);
  }
  addLobes(b);
}

void Walk::add(MaterialHandle handle, const Place& place) {
  if (!handle.valid() || place.depth > kMaxNesting) return;
  const Material& material = scene[handle];
  Place next = place.inside();
  switch (material.type) {
    case MaterialType::twoSided: {
      const bool behind = dot(wo, place.frame->n) < 0 && material.b.valid();
      next.twoSided = true;
      return add(behind ? material.b : material.a, next);
    }
    case MaterialType::mask:
      return add(material.a, next);
    case MaterialType::blend:
      return addBlend(material, place);
    case MaterialType::bump:
    case MaterialType::normalMap: {
      ShadingFrame turned = *place.frame;
      if (material.map.valid() && !turned.perturbed &&
          !perturb(perturbedNormal(scene, material, at), place.twoSided, &turned))
        return;
      next.frame = &turned;
      return add(material.a, next);
    }
    default:
      return addLeaf(material, place);
  }
}

}  // namespace

Bsdf makeBsdf(const Scene& scene, const SurfacePoint& at, Vec3f wo, float specularLimit) {
  Bsdf bsdf;
  bsdf.frames[0] = at.frame;
  bsdf.frameCount = 0;
  bsdf.ng = at.ng;
  bsdf.baseNormal = at.frame.n;
  const ShadingFrame surface = at.frame;
  Walk{scene, at, wo, bsdf}.add(at.material, {&surface});
  bsdf.frameCount = std::max(bsdf.frameCount, 1);
  classify(bsdf, specularLimit);
  return bsdf;
}

}  // namespace lobelia
