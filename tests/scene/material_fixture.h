// A point on a plane and the BSDFs that materials give there.
#pragma once

#include "lobelia/base/random.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/scene/shading.h"

namespace lobelia::test {

struct Fixture {
  Scene scene;
  SurfacePoint at;
  Fixture() {
    at.ng = {0, 0, 1};
    at.dpdu = {1, 0, 0}, at.dpdv = {0, 1, 0};
    at.uv = at.texture.uv = {0.5f, 0.5f};
  }
  MaterialHandle add(const Material& material) {
    scene.materials.push_back(material);
    return {static_cast<uint32_t>(scene.materials.size() - 1)};
  }
  Bsdf make(MaterialHandle material, Vec3f wo) {
    at.material = material;
    return makeBsdf(scene, at, wo, 0.08f);
  }
};

inline Material diffuse(Rgb albedo) {
  Material m;
  m.type = MaterialType::diffuse;
  m.diffuse = albedo;
  return m;
}

inline Material wrap(MaterialType type, MaterialHandle a, MaterialHandle b = {}) {
  Material m;
  m.type = type;
  m.a = a, m.b = b;
  return m;
}

inline Vec3f directionAt(float cosTheta, float phi) {
  const float s = std::sqrt(1 - cosTheta * cosTheta);
  return {s * std::cos(phi), s * std::sin(phi), cosTheta};
}

inline float meanWeight(const Bsdf& bsdf, Vec3f wo) {
  Rng rng(3);
  double sum = 0;
  constexpr int kCount = 40000;
  for (int i = 0; i < kCount; ++i) {
    const float u = (static_cast<float>(i) + rng.next1D()) / kCount;
    if (const auto s = sample(bsdf, wo, u, rng.next2D(), LobeSet::all, Transport::importance))
      sum += static_cast<double>(s->weight.y);
  }
  return static_cast<float>(sum / kCount);
}

}  // namespace lobelia::test
