// A surface whose lobes lie in several frames leaves a receiver in each: together they scatter what
// the surface scatters, and the eye pass finds the same light.
#include <gtest/gtest.h>

#include "lobelia/base/sampling.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/path/receivers.h"
#include "lobelia/scene/shading.h"
#include "support/box_scene.h"
#include "support/split_oracle.h"

namespace lobelia {
namespace {

using test::addMaterial;
using test::boxScene;

TextureHandle addNormals(Scene& scene, Vec3f n) {
  Texture t;
  t.value = (normalize(n) + Vec3f(1.f)) * 0.5f;
  scene.textures.push_back(t);
  return {static_cast<uint32_t>(scene.textures.size() - 1)};
}

// Walls and floor of a coated material whose base and coat have normals of their own.
Scene twoFrameScene() {
  Scene scene = boxScene();
  Material coated;
  coated.type = MaterialType::metallicRoughness;
  coated.diffuse = Rgb(0.5f, 0.6f, 0.3f);
  coated.roughness = 0.5f;
  coated.metallic = 0.4f;
  coated.clearcoat = 1.f;
  coated.clearcoatRoughness = 0.4f;
  coated.clearcoatNormal = addNormals(scene, {0.2f, 0.1f, 1});
  Material map;
  map.type = MaterialType::normalMap;
  map.a = addMaterial(scene, coated);
  map.map = addNormals(scene, {-0.3f, 0.1f, 1});
  const MaterialHandle material = addMaterial(scene, map);
  for (const test::BoxWall wall : {test::floorWall, test::leftWall, test::backWall})
    scene.instances[wall].material = material;
  return scene;
}

struct Pass {
  Scene scene = twoFrameScene();
  Context context;
  Tracer tracer{scene, context};
  EmitterSampler emitters{scene, tracer.bounds()};
  Film film;
  Receivers run(EyeSettings settings) {
    const Camera& camera = scene.cameras[0];
    return traceReceivers(tracer, emitters, camera, settings, 0, camera.height, film, context);
  }
  Pass() {
    const Camera& camera = scene.cameras[0];
    film.fullWidth = film.width = camera.width;
    film.fullHeight = film.height = camera.height;
    for (const char* name : {"direct", "indirect", "albedo", "normal"}) film.addLayer(name);
    film.addLayer("depth", 1);
  }
};

TEST(ReceiverFrames, PointsOfASurfaceAddUpToIt) {
  Pass pass;
  const Receivers receivers = pass.run({});
  const Vec3f eye = pass.scene.cameras[0].toWorld.point(Vec3f(0.f));
  Rng rng(4);
  int pairs = 0;
  for (size_t i = 0; i + 1 < receivers.points.size(); ++i) {
    const ReceiverPoint& a = receivers.points[i];
    const ReceiverPoint& b = receivers.points[i + 1];
    if (a.pixel != b.pixel || a.p != b.p) continue;
    ++pairs;
    EXPECT_EQ(a.weight, b.weight);
    EXPECT_EQ(a.depth, b.depth);
    EXPECT_GT(length(a.frame.n - b.frame.n), 0.1f);
    EXPECT_EQ(a.lobeCount + b.lobeCount, 3);
    const auto hit = pass.tracer.intersect({eye, normalize(a.p - eye)});
    ASSERT_TRUE(hit);
    const SurfacePoint at = surfacePoint(pass.scene, *hit);
    const Bsdf whole = makeBsdf(pass.scene, at, a.wo, 0.08f);
    ASSERT_EQ(whole.frameCount, 2);
    const Vec3f wi = sampleSphereUniform(rng.next2D());
    Rgb sum{};
    for (const ReceiverPoint* r : {&a, &b}) {
      Bsdf part;
      part.frames[0] = r->frame;
      part.frames[0].perturbed = r->bumpAlpha2 > 0;
      part.frames[0].bumpAlpha2 = r->bumpAlpha2;
      part.ng = r->ng;
      part.baseNormal = r->baseNormal;
      for (uint32_t k = 0; k < r->lobeCount; ++k) part.add(receivers.lobes[r->firstLobe + k]);
      sum += evaluate(part, r->wo, wi);
    }
    const Rgb expected = evaluate(whole, a.wo, wi);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 1e-5f + 1e-3f * expected[c]);
  }
  EXPECT_GT(pairs, 100);
}

// Direct light by emitter samples and BSDF samples (MIS): the plain sum over paths finds as much.
TEST(ReceiverFrames, DirectLightIsThatOfTheOracle) {
  Pass pass;
  EyeSettings settings;
  settings.maxDepth = 2;
  settings.sampleCount = 64;
  for (settings.sample = 0; settings.sample < settings.sampleCount; ++settings.sample)
    pass.run(settings);
  Vec3d sum;
  for (size_t i = 0; i < pass.film.pixelCount(); ++i) {
    const Rgb c = pass.film.rgb(i, "direct");
    sum += Vec3d(c.x, c.y, c.z);
  }
  sum = sum / static_cast<double>(pass.film.pixelCount());
  const test::SplitMeans expected =
      test::SplitOracle{pass.tracer, pass.emitters, 0.08f, 2}.mean(pass.scene.cameras[0], 1500, 7);
  EXPECT_NEAR(sum.y / static_cast<double>(expected.direct.y), 1, 0.02);
}

}  // namespace
}  // namespace lobelia
