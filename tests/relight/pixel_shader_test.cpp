#include "lobelia/relight/pixel_shader.h"

#include <gtest/gtest.h>

#include "lobelia/bsdf/bsdf.h"
#include "relight/light_data.h"
#include "relight/random_cuts.h"
#include "support/test_scenes.h"

namespace lobelia::relight {
namespace {

// Three vertices with cuts of their own under spotted light.
struct Pixel {
  test::LitTree lit;
  CutSet cuts;
  Scene scene = test::stageScene();
  EmitterSampler emitters{scene, bounds(scene)};
  VertexCache vertices;
  PixelShader shader;
  PixelPlace place{{0, 0, 0}, {0.2f, 0.5f, 0.3f}};

  Pixel(int levels, size_t nodes, const DistantLight& light, bool refined)
      : lit(test::litTree(levels, light, nodes)) {
    std::vector<CutNode> all;
    std::vector<uint64_t> begin{0};
    for (uint64_t v = 0; v < 3; ++v) {
      const std::vector<float> leaves = test::randomLeaves(levels, v + 20);
      for (const test::ValueNode& node : test::randomCut(leaves, levels, 0.95f, v))
        all.push_back({node.level, static_cast<uint8_t>(node.value * 255)});
      begin.push_back(all.size());
    }
    cuts = CutSet(std::move(all), std::move(begin));
    vertices.begin(lit.light, cuts);
    for (uint32_t v = 0; v < 3; ++v) place.slot[v] = vertices.slotOf(v);
    vertices.mergeNew();
    shader.begin(lit.light, emitters, lit.lookup, refined, &vertices);
  }

  // Over all leaves, by the scalar evaluation.
  Vec3d bruteForce(const Bsdf& bsdf, Vec3f wo) const {
    std::vector<double> seen(lit.samples.count(), 0.0);
    for (size_t v = 0; v < 3; ++v) {
      size_t leaf = 0;
      for (const CutNode node : cuts.cut(v))
        for (uint32_t i = 0; i < 1u << node.level; ++i)
          seen[leaf++] += static_cast<double>(place.weight[v]) * node.value / 255.0;
    }
    Vec3d sum{};
    for (size_t leaf = 0; leaf < seen.size(); ++leaf) {
      const size_t heap = lit.samples.count() + leaf;
      const Vec3f d = lit.light.sums.direction(heap);
      if (dot(d, bsdf.ng) * dot(wo, bsdf.ng) <= 0) continue;
      const Rgb value = lit.light.sums.power(heap) * evaluate(bsdf, wo, d);
      sum += Vec3d(double{value.x}, double{value.y}, double{value.z}) * seen[leaf];
    }
    return sum;
  }
};

Bsdf bsdfOf(const Lobe& lobe, bool bumped) {
  Bsdf bsdf;
  const Vec3f n = normalize(Vec3f(0.2f, 0.9f, -0.3f));
  bsdf.ng = normalize(n + Vec3f(0.05f, 0, 0.02f));
  bsdf.baseNormal = n;
  bsdf.frames[0] = frameFromNormal(bumped ? normalize(n + Vec3f(0.2f, 0, 0.1f)) : n);
  bsdf.frames[0].perturbed = bumped;
  bsdf.frames[0].bumpAlpha2 = bumped ? 0.1f : 0.f;
  bsdf.add(lobe);
  return bsdf;
}

struct NamedLobe {
  const char* name;
  Lobe lobe;
};
std::vector<NamedLobe> lobes(float alphaX, float alphaY) {
  Lobe lambert;
  lambert.weight = {0.3f, 0.5f, 0.7f};
  Lobe ggx;
  ggx.type = LobeType::microfacetReflection;
  ggx.alphaX = alphaX, ggx.alphaY = alphaY;
  ggx.fresnel = Fresnel::schlick;
  ggx.eta = {0.9f, 0.6f, 0.2f};
  Lobe beckmann = ggx;
  beckmann.distribution = Distribution::beckmann;
  beckmann.fresnel = Fresnel::dielectric;
  beckmann.eta = Rgb(1.5f);
  Lobe ward = ggx;
  ward.type = LobeType::ward;
  ward.variant = 2;
  Lobe phong = ggx;
  phong.type = LobeType::phong;
  phong.alphaX = 0.5f / (alphaX * alphaX);
  Lobe burley;
  burley.type = LobeType::principledDiffuse;
  burley.k = {0.4f, 0.2f, 0.6f};
  burley.parameters = {0.7f, 0.2f, 0.3f};
  return {{"lambert", lambert}, {"ggx", ggx},     {"beckmann", beckmann},
          {"ward", ward},       {"phong", phong}, {"burley", burley}};
}

void expectNear(Rgb value, Vec3d exact, double tolerance, const char* name) {
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(static_cast<double>(value[c]), exact[c], tolerance * exact[c] + 1e-7) << name;
}

const Vec3f kWo = normalize(Vec3f(0.5f, 0.7f, 0.2f));

// With as many nodes as leaves nothing is approximate but the arithmetic.
TEST(PixelShader, WithTheFullLightCutIsBruteForceOverTheLeaves) {
  for (const bool refined : {false, true}) {
    Pixel pixel(9, 512, test::spottedLight(60, 3), refined);
    for (const bool bumped : {false, true})
      for (const NamedLobe& l : lobes(0.45f, 0.3f)) {
        const Bsdf bsdf = bsdfOf(l.lobe, bumped);
        // Left out beyond their reach: e^-8 of Gaussian lobes.
        const double tolerance = refined ? 2e-3 : 2e-5;
        expectNear(pixel.shader.reflected(bsdf, kWo, pixel.place), pixel.bruteForce(bsdf, kWo),
                   tolerance, l.name);
      }
  }
}

// Narrow lobes see light that nodes of a small cut would miss or smear.
TEST(PixelShader, RefinementFindsNarrowHighlights) {
  const DistantLight light = test::spottedLight(300, 4);
  Pixel plain(13, 48, light, false), refined(13, 48, light, true);
  for (const NamedLobe& l : lobes(0.06f, 0.06f)) {
    if (l.lobe.type == LobeType::lambert || l.lobe.type == LobeType::principledDiffuse) continue;
    double plainError = 0, refinedError = 0, sum = 0;
    for (int i = 0; i < 12; ++i) {
      const float a = 0.5f * static_cast<float>(i);
      const Bsdf bsdf = bsdfOf(l.lobe, false);
      const Vec3f wo =
          frameFromNormal(bsdf.ng).toWorld(normalize(Vec3f(std::cos(a), std::sin(a), 1.2f)));
      const double exact = refined.bruteForce(bsdf, wo).y;
      sum += exact * exact;
      plainError += std::pow(double{plain.shader.reflected(bsdf, wo, plain.place).y} - exact, 2);
      refinedError +=
          std::pow(double{refined.shader.reflected(bsdf, wo, refined.place).y} - exact, 2);
    }
    EXPECT_LT(std::sqrt(refinedError / sum), 0.06) << l.name;
    EXPECT_GT(std::sqrt(plainError / sum), 0.2) << l.name << ": the example shows nothing";
  }
  EXPECT_GT(refined.shader.counts.fineChunks, 0u);
}

// What is coarse is coarse in direction alone: a broad lobe hardly sees it.
TEST(PixelShader, BroadLobesNeedFewNodes) {
  const DistantLight light = test::spottedLight(100, 5);
  Pixel pixel(12, 256, light, true);
  const Bsdf bsdf = bsdfOf(lobes(0.1f, 0.1f)[0].lobe, false);
  expectNear(pixel.shader.reflected(bsdf, kWo, pixel.place), pixel.bruteForce(bsdf, kWo), 0.01,
             "lambert");
}

// Emitters' own radiance in the mirror direction, times what the vertices see there.
TEST(PixelShader, MirrorsShowTheEnvironment) {
  Scene scene = test::stageScene();
  Emitter sky;
  sky.type = EmitterType::constant;
  sky.radiance = Rgb(2, 3, 4);
  scene.emitters.push_back(sky);
  const EmitterSampler emitters(scene, bounds(scene));
  Pixel pixel(9, 64, distantLight(scene), true);
  pixel.shader.begin(pixel.lit.light, emitters, pixel.lit.lookup, true, &pixel.vertices);
  Lobe mirror;
  mirror.type = LobeType::deltaReflection;
  mirror.weight = {0.9f, 0.8f, 0.7f};
  const Bsdf bsdf = bsdfOf(mirror, false);
  const Vec3f n = bsdf.frames[0].n, d = n * (2 * dot(n, kWo)) - kWo;
  float seen = 0;
  for (uint32_t v = 0; v < 3; ++v)
    seen += pixel.place.weight[v] *
            pixel.vertices.visibility(pixel.place.slot[v], pixel.lit.lookup.nearest(d));
  EXPECT_GT(seen, 0.f);
  const Rgb value = pixel.shader.reflected(bsdf, kWo, pixel.place);
  EXPECT_NEAR(value.x, 2 * 0.9f * seen, 1e-4f);
  EXPECT_NEAR(value.z, 4 * 0.7f * seen, 1e-4f);
}

}  // namespace
}  // namespace lobelia::relight
