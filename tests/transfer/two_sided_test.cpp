// Surfaces that reflect on both sides, against such as reflect in front alone and against rays.
#include <gtest/gtest.h>

#include "lobelia/transfer/frame.h"
#include "transfer/small_transfer.h"

namespace lobelia::transfer {
namespace {

using test::place;

MaterialHandle twoSided(Scene& scene, MaterialHandle front, MaterialHandle back = {}) {
  Material both;
  both.type = MaterialType::twoSided;
  both.a = front, both.b = back;
  return test::addMaterial(scene, both);
}

Film frameOf(const Scene& scene, const TransferData& data, const Camera& camera, Context& context) {
  const Tracer tracer(scene, context);
  const EmitterSampler emitters(scene, bounds(scene));
  TransferRenderer renderer(tracer, data);
  renderer.relight(emitters, context);
  Film film;
  film.width = film.fullWidth = camera.width, film.height = film.fullHeight = camera.height;
  film.addLayer("");
  renderer.render({.hideEmitters = true}, camera, film, context);
  return film;
}

// A glossy ball under a constant sky, closed: within it nothing is seen of the sky. below: a ground
// that shows it.
Scene ball(bool bothSides, bool below) {
  Scene scene;
  const MaterialHandle glossy =
      test::addMaterial(scene, test::phongMaterial(Rgb(0.f), Rgb(0.5f, 0.4f, 0.3f), 30));
  place(scene, test::sphereMesh(10, 6, true), scaling({0.5, 0.5, 0.5}));
  // Both have the same materials: meshes are split by the numbers of theirs.
  const MaterialHandle both = twoSided(scene, glossy);
  scene.instances.back().material = bothSides ? both : glossy;
  if (below) {
    place(scene, test::groundMesh(4), translation({0, 0, -0.6}));
    scene.instances.back().material = glossy;
  }
  Emitter sky;
  sky.type = EmitterType::constant;
  sky.radiance = Rgb(1);
  scene.emitters.push_back(sky);
  return scene;
}

Camera towardsMiddle(Vec3d from, float fovX) {
  Camera camera;
  camera.toWorld = Transform(*lookAt(from, {0, 0, 0}, {0, 0, 1}));
  camera.fovX = fovX;
  camera.width = 48, camera.height = 48;
  return camera;
}

// Triangles along a silhouette have vertices behind it, whose back sides see the dark within.
TEST(TwoSided, ABallLooksTheSameAlongItsSilhouette) {
  TransferSettings settings = test::coarseTransfer();
  settings.subdivision = 0, settings.bounces = 0;
  Context context;
  const Scene one = ball(false, false), both = ball(true, false);
  const TransferData dataOfOne = test::transferOf(one, settings, context);
  const TransferData dataOfBoth = test::transferOf(both, settings, context);
  EXPECT_EQ(dataOfOne.recordCount(), 0u);
  EXPECT_GT(dataOfBoth.recordCount(), 1000u) << "of the dark within";
  const Camera camera = towardsMiddle({1.2, 1.5, 0.7}, 0.6f);
  const Film a = frameOf(one, dataOfOne, camera, context);
  const Film b = frameOf(both, dataOfBoth, camera, context);
  size_t shown = 0;
  for (size_t i = 0; i < a.pixelCount(); ++i) {
    shown += a.rgb(i).x > 0.1f ? 1 : 0;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(b.rgb(i)[c], a.rgb(i)[c], 1e-3f) << i;
  }
  EXPECT_GT(shown, 500u);
}

// The same where the silhouette is that from a vertex of another surface.
TEST(TwoSided, ABallIsTheSameInAReflection) {
  TransferSettings settings = test::coarseTransfer();
  settings.subdivision = 0;  // a ball with an inside would have more vertices
  Context context;
  const TransferData one = test::transferOf(ball(false, true), settings, context);
  const TransferData both = test::transferOf(ball(true, true), settings, context);
  const auto shares = [](const TransferData& data) {
    std::vector<float> out;
    for (uint32_t v = 0; v < data.mesh.vertices.size(); ++v) {
      if (data.mesh.vertices[v].instance != 1) continue;
      for (uint32_t k = 0; k < GeodesicGrid(data.directionLevel).count(); ++k) {
        const SliceRecord* const record = data.passes[1].glossy[0].find(v, k);
        out.push_back(record ? luminance(unpack(*record).share) : 0);
      }
    }
    return out;
  };
  ASSERT_EQ(one.mesh.vertices.size(), both.mesh.vertices.size());
  const std::vector<float> a = shares(one), b = shares(both);
  size_t some = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    some += a[i] > 0.01f ? 1 : 0;
    EXPECT_NEAR(b[i], a[i], 2e-3f) << i;
  }
  EXPECT_GT(some, 100u);
}

}  // namespace
}  // namespace lobelia::transfer
