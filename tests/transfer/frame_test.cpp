// Frames from transfer made by hand, against sums over lobes.
#include "lobelia/transfer/frame.h"

#include <gtest/gtest.h>

#include "lobelia/base/parallel.h"
#include "lobelia/transfer/prefiltered_light.h"
#include "lobelia/transfer/reflection.h"
#include "transfer/simple_data.h"

namespace lobelia::transfer {
namespace {

// A glossy square in z = 0, seen from above it, under light from infinity.
struct Stage {
  Scene scene;
  TransferData data;
  Context context;
  std::unique_ptr<Tracer> tracer;
  std::unique_ptr<EmitterSampler> emitters;
  std::unique_ptr<TransferRenderer> renderer;

  explicit Stage(Material material) {
    test::addQuad(scene, {-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, test::addMaterial(scene, material));
    data = test::simpleData(scene);
  }
  void addSun(Vec3f towards, Rgb irradiance) {
    Emitter sun;
    sun.type = EmitterType::directional;
    sun.direction = -normalize(towards);
    sun.radiance = irradiance;
    scene.emitters.push_back(sun);
  }
  void addSky(Rgb radiance) {
    Emitter sky;
    sky.type = EmitterType::constant;
    sky.radiance = radiance;
    scene.emitters.push_back(sky);
  }
  void start() {
    tracer = std::make_unique<Tracer>(scene, context);
    renderer = std::make_unique<TransferRenderer>(*tracer, data);
    relight();
  }
  // Was the light convolved anew?
  bool relight() {
    auto sampler = std::make_unique<EmitterSampler>(scene, bounds(scene));
    const bool anew = renderer->relight(*sampler, context);
    emitters = std::move(sampler);
    return anew;
  }
  static Camera camera() {
    Camera camera;
    camera.toWorld = Transform(*lookAt({0, -2, 1.2}, {0, 0, 0}, {0, 0, 1}));
    camera.fovX = 1.1f;
    camera.width = 40, camera.height = 36;
    return camera;
  }
  Film film(const TransferFrameSettings& settings) {
    Film film;
    film.width = film.fullWidth = camera().width, film.height = film.fullHeight = camera().height;
    film.addLayer("");
    renderer->render(settings, camera(), film, context);
    return film;
  }
  // f(pixel, place on the square, direction to the eye).
  template <class F>
  void forHits(const F& f) {
    for (int y = 0; y < camera().height; ++y)
      for (int x = 0; x < camera().width; ++x) {
        const Ray ray = generateRay(
            camera(), {static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f}, {0.5f, 0.5f});
        const Vec3f p = ray.o - ray.d * (ray.o.z / ray.d.z);
        if (ray.d.z < 0 && std::abs(p.x) < 0.99f && std::abs(p.y) < 0.99f)
          f(static_cast<size_t>(y * camera().width + x), p, -ray.d);
      }
  }
};

const Material kShiny = test::phongMaterial({0.6f, 0.5f, 0.4f}, 100);

TEST(TransferFrame, UnoccludedIsTheBrdfAtThePixel) {
  Stage stage(kShiny);
  const Vec3f towards = normalize(Vec3f(0.1f, 1, 0.6f));
  stage.addSun(towards, {3, 2, 1});
  stage.start();
  const Film film = stage.film({});
  int count = 0;
  stage.forHits([&](size_t pixel, Vec3f, Vec3f wo) {
    const float scale = 102 / kTwoPi * 0.6f * 3 * towards.z;
    const Vec3f mirror{-wo.x, -wo.y, wo.z};
    const float expected = scale * std::pow(std::max(dot(mirror, towards), 0.f), 100.f);
    // Steps of the prefiltered light, and a lobe of Phong's that is told as a vMF lobe.
    EXPECT_NEAR(film.rgb(pixel).x, expected, 0.05f * scale);
    EXPECT_NEAR(film.rgb(pixel).z * 4.5f, film.rgb(pixel).x, 1e-3f * scale);
    ++count;
  });
  EXPECT_GT(count, 300);
  EXPECT_GE(stage.context.statistics.count("object_pixels"), static_cast<uint64_t>(count));
  // By each of the four tiles that see some.
  EXPECT_GE(stage.context.statistics.count("vertices_merged"), 4u);
  EXPECT_LE(stage.context.statistics.count("vertices_merged"), 16u);
  EXPECT_EQ(stage.context.statistics.count("nonfinite"), 0u);
}

TEST(TransferFrame, WithoutTablesIsTheReflectionAtThePixel) {
  // Shiny on the left, dull on the right: pixels of a packet have different numbers of lobes.
  Stage stage(kShiny);
  stage.scene.images.push_back({"specular", 2, 1, 1, {0.8f, 0}});
  Texture texture;
  texture.type = TextureType::bitmap;
  texture.image = {0};
  texture.filter = Filter::nearest;
  stage.scene.textures.push_back(texture);
  Material& material = stage.scene.materials[stage.scene.instances[0].material.index];
  material.specular = TextureHandle{0};
  stage.data = test::simpleData(stage.scene);
  stage.addSun({0.1f, 1, 0.6f}, {3, 2, 1});
  stage.addSky({0.1f, 0.2f, 0.3f});
  stage.start();
  ASSERT_FALSE(ReflectionTables(stage.scene).has(stage.scene.instances[0].material));
  const PrefilteredLight light(relight::distantLight(stage.scene));
  const Film film = stage.film({});
  int shiny = 0, dull = 0;
  stage.forHits([&](size_t pixel, Vec3f p, Vec3f wo) {
    const auto hit = stage.tracer->intersect({p + wo, -wo, 0, 2});
    ASSERT_TRUE(hit);
    const Reflection own =
        reflectionOf(makeBsdf(stage.scene, surfacePoint(stage.scene, *hit), wo, 0), wo);
    Rgb expected{};
    for (size_t i = 0; i < static_cast<size_t>(own.count); ++i)
      expected += own.lobes[i].alpha * light.lookUp(own.lobes[i].axis, own.lobes[i].kappa);
    EXPECT_LT(maxComponent(film.rgb(pixel) - expected), 1e-3f) << p.x;
    EXPECT_LT(maxComponent(expected - film.rgb(pixel)), 1e-3f) << p.x;
    ++(own.count > 0 ? shiny : dull);
  });
  EXPECT_GT(shiny, 100);
  EXPECT_GT(dull, 100);
}

TEST(TransferFrame, SharesOfAllPassesAddUpUnderAConstantSky) {
  Material both = kShiny;
  both.diffuse = Rgb(0.2f, 0.3f, 0.1f);
  Stage stage(both);
  stage.addSky({1, 2, 4});
  const auto lobe = [](Rgb share) {
    return [share](const TransferVertex&, Vec3f) {
      return std::optional(TransferLobe{share, normalize(Vec3f(0.3f, 0.2f, 1)) * 0.9f});
    };
  };
  stage.data.passes[0].glossy[0] = test::rowsOf(stage.data, lobe(Rgb(0.5f)));
  DiffuseLobes octants{};
  octants[1] = pack({Rgb(0.25f), {-0.1f, 0.5f, 0.1f}});
  octants[3] = pack({Rgb(0.5f), {-0.1f, -0.5f, 0.1f}});
  stage.data.passes[0].diffuse.assign(stage.data.mesh.vertices.size(), octants);
  stage.data.passes.push_back({{test::rowsOf(stage.data, lobe(Rgb(0.125f))),
                                test::rowsOf(stage.data, lobe({0.25f, 0, 0.0625f}))},
                               {}});
  stage.start();
  const Film all = stage.film({}), direct = stage.film({.endPass = 1}),
             bounced = stage.film({.firstPass = 1});
  stage.forHits([&](size_t pixel, Vec3f, Vec3f wo) {
    const SurfacePoint at = surfacePoint(stage.scene, {1, 0.3f, 0.3f, 0, 0});
    const Reflection own = reflectionOf(makeBsdf(stage.scene, at, wo, 0), wo);
    const Rgb sky{1, 2, 4};
    const Rgb first = sky * (own.glossy * 0.5f + own.diffuse * 0.75f);
    const Rgb second = sky * own.glossy * Rgb(0.375f, 0.125f, 0.1875f);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(direct.rgb(pixel)[c], first[c], 0.006f * first[c]);
      EXPECT_NEAR(bounced.rgb(pixel)[c], second[c], 0.006f * second[c]);
      EXPECT_NEAR(all.rgb(pixel)[c], direct.rgb(pixel)[c] + bounced.rgb(pixel)[c], 1e-5f);
    }
  });
}

TEST(TransferFrame, BlockedIsDarkBesideWhatIsNot) {
  // Blocked at the two vertices on the left: light grows linearly to the right.
  Stage stage(kShiny);
  stage.addSky(Rgb(1));
  stage.data.passes[0].glossy[0] = test::rowsOf(stage.data, [](const TransferVertex& v, Vec3f) {
    return v.p.x < 0 ? std::optional(TransferLobe{}) : std::nullopt;
  });
  stage.start();
  const Film film = stage.film({});
  stage.forHits([&](size_t pixel, Vec3f p, Vec3f wo) {
    const SurfacePoint at = surfacePoint(stage.scene, {1, 0.3f, 0.3f, 0, 0});
    const Rgb own = reflectionOf(makeBsdf(stage.scene, at, wo, 0), wo).glossy;
    EXPECT_NEAR(film.rgb(pixel).y, own.y * 0.5f * (p.x + 1), 0.005f);
  });
}

TEST(TransferFrame, TurningTheLightIsTurningTheEmitters) {
  Stage turned(kShiny), still(kShiny);
  const Vec3f towards{0.3f, 0.8f, 0.6f};
  turned.addSun(towards, Rgb(1));
  turned.start();
  // About +y, as no emitter says otherwise.
  still.addSun(rotation({0, 1, 0}, 40).vector(towards), Rgb(1));
  still.start();
  const Film a = turned.film({.rotation = 40}), b = still.film({}), c = turned.film({});
  float most = 0, apart = 0;
  for (size_t i = 0; i < a.pixelCount(); ++i) {
    most = std::max(most, b.rgb(i).y);
    apart = std::max(apart, std::abs(a.rgb(i).y - c.rgb(i).y));
  }
  EXPECT_GT(apart, 0.5f * most);
  for (size_t i = 0; i < a.pixelCount(); ++i) EXPECT_NEAR(a.rgb(i).y, b.rgb(i).y, 0.05f * most);
}

TEST(TransferFrame, SamePixelsWhateverTheThreads) {
  Stage stage(kShiny);
  stage.addSun({0.1f, 1, 0.6f}, Rgb(2));
  stage.addSky(Rgb(1));
  stage.start();
  const Film many = stage.film({.spp = 3});
  const ThreadLimit one(1);
  EXPECT_EQ(stage.film({.spp = 3}).layers.at("").values, many.layers.at("").values);
}

TEST(TransferFrame, ShowsTheSkyUnlessItIsHiddenAndNewLightAtOnce) {
  Stage stage(kShiny);
  EXPECT_THROW(
      {
        stage.tracer = std::make_unique<Tracer>(stage.scene, stage.context);
        stage.renderer = std::make_unique<TransferRenderer>(*stage.tracer, stage.data);
        stage.film({});
      },
      std::logic_error);
  stage.addSky({1, 2, 3});
  stage.relight();
  const Film film = stage.film({}), hidden = stage.film({.hideEmitters = true});
  EXPECT_EQ(film.rgb(0), Rgb(1, 2, 3));
  EXPECT_EQ(hidden.rgb(0), Rgb{});
  stage.scene.emitters[0].radiance = Rgb(2, 4, 6);
  stage.relight();
  const Film brighter = stage.film({});
  for (size_t i = 0; i < film.pixelCount(); ++i)
    EXPECT_LT(length(brighter.rgb(i) - film.rgb(i) * 2), 1e-5f);
}

TEST(TransferFrame, ConvolvesLightOnlyWhenItIsAnother) {
  Stage stage(kShiny);
  stage.addSky({1, 2, 3});
  stage.addSun({0, 1, 1}, Rgb(2));
  stage.start();
  const Film film = stage.film({});
  EXPECT_FALSE(stage.relight());
  Emitter lamp;  // which transfer does not show
  lamp.type = EmitterType::point;
  stage.scene.emitters.push_back(lamp);
  EXPECT_FALSE(stage.relight());
  EXPECT_EQ(stage.film({}).layers.at("").values, film.layers.at("").values);
  stage.scene.emitters[0].radiance = Rgb(1, 2, 4);
  EXPECT_TRUE(stage.relight());
  stage.scene.emitters[1].direction = normalize(Vec3f{0, -1, -2});
  EXPECT_TRUE(stage.relight());
  EXPECT_NE(stage.film({}).layers.at("").values, film.layers.at("").values);
}

}  // namespace
}  // namespace lobelia::transfer
