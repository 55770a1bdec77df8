// Frames as a whole: what they do not depend on.
#include "lobelia/relight/frame.h"

#include <gtest/gtest.h>

#include "lobelia/relight/precompute.h"
#include "relight/scenes.h"

namespace lobelia::relight {
namespace {

// A glossy ground with a ball above it, under light from two directions.
struct Stage {
  Scene scene = litScene();
  Context context;
  Tracer tracer{scene, context};
  EmitterSampler emitters{scene, bounds(scene)};
  VisibilityData data =
      precomputeVisibility(tracer, {.sampleCount = 1024, .clusterCount = 32}, context);
  FrameRenderer renderer{tracer, emitters, data};

  static Scene litScene() {
    Scene scene = test::ballScene(8);
    Material glossy;
    glossy.type = MaterialType::roughConductor;
    glossy.alphaU = glossy.alphaV = 0.2f;
    scene.instances[0].material = test::addMaterial(scene, glossy);
    for (const Vec3f towards : {Vec3f(0.5f, 0.3f, 0.8f), Vec3f(-0.6f, 0.2f, 0.4f)}) {
      Emitter sun;
      sun.type = EmitterType::directional;
      sun.direction = -normalize(towards);
      sun.radiance = Rgb(3, 2, 1);
      scene.emitters.push_back(sun);
    }
    return scene;
  }
  Camera camera() const {
    Camera camera;
    camera.toWorld = Transform(*lookAt({0, -2.5, 1.5}, {0, 0, 0.2}, {0, 0, 1}));
    camera.fovX = 0.9f;
    camera.width = 48, camera.height = 40;
    return camera;
  }
  std::vector<float> picture(const FrameSettings& settings, size_t nodes = 64) {
    Film film;
    film.width = film.fullWidth = camera().width, film.height = film.fullHeight = camera().height;
    film.addLayer("");
    renderer.render(renderer.light(0, {.nodeCount = nodes}, context), camera(), settings, film,
                    context);
    return film.layers.at("").values;
  }
};

TEST(Frame, DoesNotDependOnTheMemoryForVertices) {
  Stage stage;
  const std::vector<float> roomy = stage.picture({.spp = 3});
  const uint64_t once = stage.context.statistics.count("vertices_merged");
  EXPECT_GT(stage.context.statistics.count("fine_chunks"), 0u);
  for (const size_t bytes : {size_t{1}, size_t{20000}}) {
    const uint64_t before = stage.context.statistics.count("vertices_merged");
    EXPECT_EQ(stage.picture({.spp = 3, .cacheBytes = bytes}), roomy) << bytes;
    EXPECT_GT(stage.context.statistics.count("vertices_merged") - before, once) << bytes;
  }
}

TEST(Frame, RelightIsANewRenderer) {
  Stage stage;
  const std::vector<float> before = stage.picture({});
  stage.scene.emitters.pop_back();
  const EmitterSampler emitters(stage.scene, bounds(stage.scene));
  stage.renderer.relight(emitters);
  const std::vector<float> after = stage.picture({});
  EXPECT_NE(after, before);
  FrameRenderer fresh(stage.tracer, emitters, stage.data);
  Film film;
  film.width = stage.camera().width, film.height = stage.camera().height;
  film.addLayer("");
  fresh.render(fresh.light(0, {.nodeCount = 64}, stage.context), stage.camera(), {}, film,
               stage.context);
  EXPECT_EQ(film.layers.at("").values, after);
}

}  // namespace
}  // namespace lobelia::relight
