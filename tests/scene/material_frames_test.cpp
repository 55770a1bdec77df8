// Normals of clearcoats and of the branches of blends: lobes in frames of their own.
#include <gtest/gtest.h>

#include "lobelia/base/sampling.h"
#include "scene/material_fixture.h"

namespace lobelia::test {
namespace {

struct Maps : Fixture {
  Maps() { at.frame = frameFromNormalTangent(at.ng, at.dpdu); }
  TextureHandle normals(Vec3f n) {
    Texture t;
    t.value = (normalize(n) + Vec3f(1.f)) * 0.5f;
    scene.textures.push_back(t);
    return {static_cast<uint32_t>(scene.textures.size() - 1)};
  }
  MaterialHandle mapped(MaterialHandle inner, Vec3f n) {
    Material m = wrap(MaterialType::normalMap, inner);
    m.map = normals(n);
    return add(m);
  }
  MaterialHandle blended(MaterialHandle a, MaterialHandle b, float weight) {
    Material m = wrap(MaterialType::blend, a, b);
    m.weight = weight;
    return add(m);
  }
};

Material coated() {
  Material m;
  m.type = MaterialType::metallicRoughness;
  m.diffuse = Rgb(0.6f, 0.3f, 0.1f);
  m.roughness = 0.6f;
  m.metallic = 0.f;
  m.ior = 1.5f;
  m.clearcoat = 1.f;
  m.clearcoatRoughness = 0.2f;
  return m;
}

const Vec3f kLeft = normalize(Vec3f(-0.3f, 0.1f, 1)), kRight = normalize(Vec3f(0.4f, 0.1f, 1));

// The coat is the material's first lobe.
TEST(MaterialFrames, CoatHasTheSurfacesNormalsWhereTheBaseIsMapped) {
  Maps f;
  const Vec3f wo = directionAt(0.8f, 1);
  const Bsdf bsdf = f.make(f.mapped(f.add(coated()), kLeft), wo);
  ASSERT_EQ(bsdf.lobeCount, 3);
  ASSERT_EQ(bsdf.frameCount, 2);
  EXPECT_EQ(bsdf.frameOf(bsdf.lobes[0]).n, f.at.frame.n);
  EXPECT_FALSE(bsdf.frameOf(bsdf.lobes[0]).perturbed);
  for (int i = 1; i < 3; ++i) EXPECT_NEAR(dot(bsdf.frameOf(bsdf.lobes[i]).n, kLeft), 1, 1e-5f);
  EXPECT_NEAR(dot(bsdf.frames[0].n, kLeft), 1, 1e-5f);
  // The coat's share of the choice is for its own cosine.
  const Bsdf flat = f.make(f.add(coated()), wo);
  EXPECT_EQ(flat.frameCount, 1);
  EXPECT_EQ(flat.lobes[0].selection, bsdf.lobes[0].selection);
}

TEST(MaterialFrames, CoatHasNormalsOfItsOwn) {
  Maps f;
  Material m = coated();
  m.clearcoatNormal = f.normals(kRight);
  const Vec3f wo = directionAt(0.8f, 1);
  const MaterialHandle handle = f.add(m);
  const Bsdf bare = f.make(handle, wo), mapped = f.make(f.mapped(handle, kLeft), wo);
  for (const Bsdf& bsdf : {bare, mapped}) {
    ASSERT_EQ(bsdf.lobeCount, 3);
    ASSERT_EQ(bsdf.frameCount, 2);
    EXPECT_NEAR(dot(bsdf.frameOf(bsdf.lobes[0]).n, kRight), 1, 1e-5f);
    EXPECT_TRUE(bsdf.frameOf(bsdf.lobes[0]).perturbed);
  }
  EXPECT_EQ(bare.frames[0].n, f.at.frame.n);
  EXPECT_NEAR(dot(mapped.frames[0].n, kLeft), 1, 1e-5f);
  // One map for both, as most models have it: one frame.
  EXPECT_EQ(f.make(f.mapped(handle, kRight), wo).frameCount, 1);
}

TEST(MaterialFrames, CoatFromBehindIsTheMirrorImage) {
  Maps f;
  Material m = coated();
  m.clearcoatNormal = f.normals(kRight);
  const MaterialHandle handle = f.add(wrap(MaterialType::twoSided, f.mapped(f.add(m), kLeft)));
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Vec3f wo = sampleSphereUniform(rng.next2D()), wi = sampleSphereUniform(rng.next2D());
    const auto mirrored = [](Vec3f w) { return Vec3f(w.x, w.y, -w.z); };
    const Rgb a = evaluate(f.make(handle, wo), wo, wi);
    const Rgb b = evaluate(f.make(handle, mirrored(wo)), mirrored(wo), mirrored(wi));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], 1e-6f + 1e-4f * a[c]);
  }
}

TEST(MaterialFrames, LayersGiveBackNoMoreThanTheyGet) {
  Maps f;
  Material m = coated();
  m.diffuse = Rgb(1.f);
  m.clearcoatNormal = f.normals(kRight);
  const MaterialHandle handle = f.mapped(f.add(m), kLeft);
  for (const float cosine : {1.f, 0.7f, 0.3f}) {
    const Vec3f wo = directionAt(cosine, 2);
    Rng rng(3);
    double sum = 0;
    constexpr int kCount = 20000;
    for (int i = 0; i < kCount; ++i) {
      const float u = (static_cast<float>(i) + rng.next1D()) / kCount;
      if (const auto s = sample(f.make(handle, wo), wo, u, rng.next2D()))
        sum += static_cast<double>(s->weight.y);
    }
    // The coat's loss is looked up at the base's cosines: 36 degrees between the two normals show
    // at grazing angles.
    EXPECT_LT(sum / kCount, cosine > 0.5f ? 1.005 : 1.1) << cosine;
    EXPECT_GT(sum / kCount, 0.7) << cosine;
  }
}

// The value of a blend is the blend of the values, each with its own map.
void expectLinear(Maps& f, MaterialHandle a, MaterialHandle b) {
  Rng rng(3);
  for (const float weight : {0.f, 0.3f, 0.5f, 0.8f, 1.f}) {
    const MaterialHandle blend = f.blended(a, b, weight);
    for (int i = 0; i < 200; ++i) {
      const Vec3f wo = sampleHemisphereCosine(rng.next2D());
      const Vec3f wi = sampleHemisphereCosine(rng.next2D());
      const Rgb expected =
          evaluate(f.make(a, wo), wo, wi) * (1 - weight) + evaluate(f.make(b, wo), wo, wi) * weight;
      const Rgb value = evaluate(f.make(blend, wo), wo, wi);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(value[c], expected[c], 1e-6f + 1e-4f * expected[c]) << weight;
    }
  }
}

TEST(MaterialFrames, BranchesOfABlendKeepTheirMaps) {
  Maps f;
  const MaterialHandle paint = f.add(diffuse(Rgb(0.8f)));
  const MaterialHandle left = f.mapped(paint, kLeft), right = f.mapped(paint, kRight);
  expectLinear(f, left, right);
  expectLinear(f, paint, right);
  const Vec3f wo = directionAt(0.8f, 1);
  // The first frame is the heavier branch's.
  EXPECT_NEAR(dot(f.make(f.blended(left, right, 0.8f), wo).frames[0].n, kRight), 1, 1e-5f);
  EXPECT_NEAR(dot(f.make(f.blended(left, right, 0.2f), wo).frames[0].n, kLeft), 1, 1e-5f);
  EXPECT_EQ(f.make(f.blended(left, left, 0.5f), wo).frameCount, 1);
  EXPECT_EQ(f.make(f.blended(left, right, 1), wo).frameCount, 1);
}

TEST(MaterialFrames, BranchesOfABlendKeepTheirAnisotropy) {
  Maps f;
  Material m = coated();
  m.clearcoat = 0.f;
  m.metallic = 1.f;
  m.roughness = 0.4f;
  m.anisotropic = 0.9f;
  const MaterialHandle along = f.add(m);
  m.anisotropicRotation = 1.2f;
  const MaterialHandle across = f.add(m);
  expectLinear(f, along, across);
  EXPECT_EQ(f.make(along, directionAt(0.8f, 1)).frameCount, 1);
}

TEST(MaterialFrames, TooManyAreSaid) {
  Maps f;
  const MaterialHandle paint = f.add(diffuse(Rgb(0.8f)));
  MaterialHandle all = f.mapped(paint, kLeft);
  for (int i = 1; i < 4; ++i)
    all = f.blended(all, f.mapped(paint, {0.1f * static_cast<float>(i), 0, 1}), 0.5f);
  f.scene.instances.emplace_back().material = all;
  const auto said = [&] {
    for (const Finding& finding : validate(f.scene))
      if (finding.message.find("normals and tangents") != std::string::npos) return true;
    return false;
  };
  EXPECT_TRUE(said());
  f.scene.instances[0].material = f.scene[all].a;
  EXPECT_FALSE(said());
}

}  // namespace
}  // namespace lobelia::test
