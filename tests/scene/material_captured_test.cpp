// Captured reflectance as a material: textured lobes, energy, validation, hash.
#include <gtest/gtest.h>

#include "lobelia/bsdf/bsdf.h"
#include "lobelia/bsdf/captured.h"
#include "lobelia/scene/shading.h"
#include "lobelia/scene/validate.h"

namespace lobelia {
namespace {

struct Fixture {
  Scene scene;
  SurfacePoint at;
  Fixture() { at.frame = frameFromNormal(at.ng = Vec3f(0, 0, 1)); }
  Material& add() {
    Material m;
    m.type = MaterialType::sphericalGaussians;
    m.ior = 1;
    scene.materials.push_back(m);
    at.material = {static_cast<uint32_t>(scene.materials.size() - 1)};
    return scene.materials.back();
  }
  TextureHandle texture(Rgb value) {
    Texture t;
    t.value = value;
    scene.textures.push_back(t);
    return {static_cast<uint32_t>(scene.textures.size() - 1)};
  }
  size_t count(Severity severity) const {
    size_t n = 0;
    for (const Finding& f : validate(scene)) {
      // An empty scene has warnings of its own.
      if (f.severity == severity && f.message.starts_with("material")) ++n;
    }
    return n;
  }
};

TEST(CapturedMaterial, IsEquationFiveOfThePaper) {
  Fixture f;
  const TextureHandle amplitude = f.texture({3, 2, 1}), sharpness = f.texture(Rgb(60.f));
  Material& m = f.add();
  m.diffuse = Rgb(0.25f);
  m.capturedLobes = {{amplitude, sharpness}, {ColorParam(Rgb(0.5f)), 10.f}};
  const Vec3f wo = normalize(Vec3f(0.2f, 0.1f, 1)), wi = normalize(Vec3f(-0.35f, 0.1f, 1));
  const Vec3f h = normalize(wo + wi);
  const Bsdf bsdf = makeBsdf(f.scene, f.at, wo, 0.08f);
  EXPECT_EQ(bsdf.lobeCount, 3);
  // Near the normal nothing of these lobes is masked.
  const float d = 2 * std::exp(60 * (h.z - 1)) + 0.5f * std::exp(10 * (h.z - 1));
  const float expected = 0.25f * kInvPi * wi.z + d / (4 * wo.z);
  EXPECT_NEAR(evaluate(bsdf, wo, wi).y / expected, 1, 0.01f);
  EXPECT_EQ(evaluate(bsdf, -wo, -wi), Rgb(0.f));  // one-sided
  EXPECT_NEAR(evaluate(bsdf, wo, wi).y / wi.z,
              evaluate(makeBsdf(f.scene, f.at, wi, 0.08f), wi, wo).y / wo.z, 1e-4f);
}

TEST(CapturedMaterial, ReflectsNoMoreThanItReceives) {
  Fixture f;
  Material& m = f.add();
  m.diffuse = Rgb(0.8f);
  m.capturedLobes = {{ColorParam(Rgb(1.2f / projectedIntegral(100))), 100.f}};
  const Vec3f wo(0, 0, 1);
  const Bsdf bsdf = makeBsdf(f.scene, f.at, wo, 0.08f);
  EXPECT_NEAR(albedo(bsdf, wo).x, 1, 0.01f);
  EXPECT_EQ(f.count(Severity::warning), 1u);  // and it is said
}

TEST(CapturedMaterial, IsValidated) {
  Fixture f;
  f.add().capturedLobes.resize(7);
  EXPECT_EQ(f.count(Severity::error) + f.count(Severity::warning), 0u);
  f.add().ior = 0.9f;
  EXPECT_EQ(f.count(Severity::error), 1u);
  f.add().capturedLobes = {{ColorParam(Rgb(-1.f)), 5.f}};
  EXPECT_EQ(f.count(Severity::error), 2u);
  f.add().capturedLobes = {{ColorParam(Rgb(0.f)), FloatParam(std::nanf(""))}};
  EXPECT_EQ(f.count(Severity::error), 3u);
  f.add().capturedLobes = {{TextureHandle{99}, 5.f}};
  EXPECT_EQ(f.count(Severity::error), 4u);
}

TEST(CapturedMaterial, LobesCountInTheHash) {
  Fixture f;
  f.add().capturedLobes = {{ColorParam(Rgb(0.1f)), 5.f}};
  const uint64_t before = hash(f.scene);
  f.scene.materials[0].capturedLobes[0].sharpness = 6.f;
  EXPECT_NE(hash(f.scene), before);
}

}  // namespace
}  // namespace lobelia
