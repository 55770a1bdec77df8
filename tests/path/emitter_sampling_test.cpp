#include "lobelia/path/emitter_sampling.h"

#include <gtest/gtest.h>

#include <limits>

#include "lobelia/base/random.h"
#include "support/test_scenes.h"

namespace lobelia {
namespace {

using test::Lighting;
using test::Renderable;

// Standard error of a mean from the means of values and squares.
double standardError(double mean, double meanSquare, double n) {
  return std::sqrt(std::max(0.0, meanSquare - mean * mean) / n);
}

Vec3f next3D(Rng& random) {
  const Vec2f a = random.next2D();
  return {a.x, a.y, random.next1D()};
}

class EmitterSampling : public testing::TestWithParam<Lighting> {
 protected:
  static Scene lit() {
    Scene scene = test::stageScene();
    addLighting(scene, GetParam());
    return scene;
  }
  Renderable r{lit()};
  // Where light is asked for: on the floor, on the wall, in the air; with and without a side.
  struct Place {
    Vec3f p, n;
  };
  static std::vector<Place> places() {
    return {{{0.3f, 1e-3f, 0.2f}, {0, 1, 0}},
            {{-0.5f, 0.9f, 1.999f}, {0, 0, -1}},
            {{-0.9f, 0.7f, -0.3f}, {}}};
  }
};

// Emission along a ray, and the density with which an emitter sample would have found it.
struct Met {
  Rgb radiance;
  float pdf;
};
Met meet(const Renderable& r, Vec3f p, Vec3f n, Vec3f d) {
  const auto hit = r.tracer.intersect({p, d});
  if (!hit) return {r.emitters.escaped(d), r.emitters.pdfEscaped(p, n, d)};
  const SurfacePoint at = surfacePoint(r.scene, *hit);
  if (!at.emitter.valid()) return {};
  return {r.emitters.emitted(at, -d), r.emitters.pdfHit(p, n, at, d)};
}
bool seen(const Renderable& r, Vec3f p, const EmitterDirection& s) {
  return s.distance < 1e38f ? r.tracer.visible(p, s.target) : !r.tracer.occluded({p, s.wi});
}

// What a sample says of itself, the functions for hits say too.
TEST_P(EmitterSampling, SamplesAgreeWithHits) {
  Rng random(1);
  int checked = 0, differ = 0;
  for (const Place& place : places()) {
    for (int i = 0; i < 3000; ++i) {
      const auto s = r.emitters.sampleDirection(place.p, place.n, next3D(random));
      if (!s) continue;
      EXPECT_NEAR(length(s->wi), 1, 1e-4f);
      EXPECT_GE(minComponent(s->weight), 0);
      EXPECT_EQ(s->delta, s->pdf == 0);
      if (s->delta || !seen(r, place.p, *s)) continue;
      const Met met = meet(r, place.p, place.n, s->wi);
      ++checked;
      const float value = luminance(s->weight) * s->pdf;
      // At the edge of a triangle or of a tessellated sphere the ray may just miss.
      if (std::abs(met.pdf - s->pdf) > 0.01f * s->pdf ||
          std::abs(luminance(met.radiance) - value) > 0.01f * value) {
        ++differ;
      }
    }
  }
  EXPECT_LE(differ, checked / 100 + 1);
}

// Irradiance (or fluence where there is no normal) by emitter samples, by sampling directions
// blindly, and the integral of the density itself.
TEST_P(EmitterSampling, IntegratesLikeBlindSampling) {
  constexpr int kSamples = 60000;
  Rng random(2);
  for (const Place& place : places()) {
    const auto cosine = [&](Vec3f d) {
      return place.n == Vec3f{} ? 1.f : std::max(0.f, dot(place.n, d));
    };
    double smart = 0, smart2 = 0, blind = 0, blind2 = 0, density = 0, density2 = 0, visible = 0;
    bool delta = false;
    for (int i = 0; i < kSamples; ++i) {
      const auto s = r.emitters.sampleDirection(place.p, place.n, next3D(random));
      if (s && seen(r, place.p, *s)) {
        if (s->delta) {
          delta = true;
        } else {
          const double v = double{luminance(s->weight)} * double{cosine(s->wi)};
          smart += v, smart2 += v * v;
          visible += 1;
        }
      }
      const Vec3f d = sampleSphereUniform(random.next2D());
      const Met met = meet(r, place.p, place.n, d);
      const double v = double{luminance(met.radiance)} * double{cosine(d)} * 4 * M_PI;
      const double q = double{met.pdf} * 4 * M_PI;
      blind += v, blind2 += v * v;
      density += q, density2 += q * q;
    }
    const double n = kSamples;
    smart /= n, blind /= n, density /= n, visible /= n;
    const double error = standardError(smart, smart2 / n, n) + standardError(blind, blind2 / n, n);
    if (!delta || GetParam() == Lighting::mixed) {
      EXPECT_NEAR(smart, blind, 4 * error + 0.005 * blind);
    } else {
      EXPECT_EQ(blind, 0);
    }
    // Directions that are drawn and seen are those that blind rays meet.
    const double densityError = standardError(density, density2 / n, n);
    EXPECT_NEAR(density, visible, 4 * densityError + 0.008);
  }
}

TEST_P(EmitterSampling, ParticlesCarryThePower) {
  Rng random(3);
  double sum = 0, square = 0;
  constexpr int kSamples = 100000;
  for (int i = 0; i < kSamples; ++i) {
    const float select = random.next1D();
    const Vec2f a = random.next2D();
    const auto ray = r.emitters.sampleRay(select, a, random.next2D());
    ASSERT_TRUE(ray);
    EXPECT_NEAR(length(ray->ray.d), 1, 1e-4f);
    EXPECT_GE(dot(ray->ng, ray->ray.d), -1e-5f);
    const double flux = double{luminance(ray->power)};
    sum += flux, square += flux * flux;
  }
  const double mean = sum / kSamples;
  const double error = standardError(mean, square / kSamples, kSamples);
  // Textures' mean and a spot's fall-off are estimates in power().
  const bool exact = GetParam() == Lighting::quad || GetParam() == Lighting::sphere ||
                     GetParam() == Lighting::point || GetParam() == Lighting::directional ||
                     GetParam() == Lighting::constant || GetParam() == Lighting::manyTriangles;
  EXPECT_NEAR(r.emitters.power(), mean, (exact ? 1e-3 : 0.2) * mean + 4 * error);
}

INSTANTIATE_TEST_SUITE_P(All, EmitterSampling,
                         testing::Values(Lighting::quad, Lighting::texturedQuad, Lighting::sphere,
                                         Lighting::meshSphere, Lighting::insideOut,
                                         Lighting::manyTriangles, Lighting::point, Lighting::spot,
                                         Lighting::projector, Lighting::directional,
                                         Lighting::constant, Lighting::environment,
                                         Lighting::goniometric, Lighting::sun, Lighting::sunAndSky,
                                         Lighting::mixed),
                         [](const auto& i) { return std::string(test::nameOf(i.param)); });

TEST(EmitterSampler, PointEmittersFollowTheirFormulas) {
  Scene scene = test::stageScene();
  Emitter emitter;
  emitter.toWorld = Transform(*lookAt({0, 3, 0}, {0, 0, 0}, {0, 0, 1}));
  emitter.type = EmitterType::spot;
  emitter.radiance = Rgb(10);
  emitter.cutoff = 0.5f;
  emitter.beamWidth = 0.3f;
  test::addEmitter(scene, emitter);
  Renderable spot(scene);
  const auto irradiance = [](Renderable& r, Vec3f p) {
    const auto s = r.emitters.sampleDirection(p, {0, 1, 0}, {0.3f, 0.4f, 0.5f});
    return s ? s->weight.x : 0.f;
  };
  EXPECT_NEAR(irradiance(spot, {0, 0, 0}), 10 / 9.f, 1e-4f);
  // 0.4 rad off the axis: half way down.
  const float x = 3 * std::tan(0.4f);
  EXPECT_NEAR(irradiance(spot, {x, 0, 0}), 5 / (9 + x * x), 1e-3f);
  EXPECT_EQ(irradiance(spot, {3 * std::tan(0.51f), 0, 0}), 0);

  // Projector: pi times the picture is the irradiance of the plane at distance one.
  emitter.type = EmitterType::projector;
  emitter.radiance = Rgb(2);
  emitter.fov = 1;
  emitter.scale = 3;
  scene.emitters = {emitter};
  Renderable projector(scene);
  for (const float px : {0.f, 0.2f, 0.5f}) {
    const Vec3f p{px, 2, 0};
    const float cosine = 1 / std::sqrt(1 + px * px);
    EXPECT_NEAR(irradiance(projector, p) * cosine, 6 * kPi, 1e-3f);
  }
  EXPECT_EQ(irradiance(projector, {std::tan(0.5f) + 0.01f, 2, 0}), 0);
}

TEST(EmitterSampler, MirroredAndFlippedShapesEmitFromTheirOutside) {
  for (const bool mirrored : {false, true}) {
    for (const bool flipped : {false, true}) {
      Scene scene = test::stageScene();
      addLighting(scene, Lighting::quad);
      Instance& lamp = scene.instances.back();
      if (mirrored) lamp.toWorld = Transform(scaling({-1, 1, 1}));
      lamp.flipNormals = flipped;
      const Renderable r(scene);
      Rng random(4);
      int below = 0, above = 0;
      for (int i = 0; i < 200; ++i) {
        const Vec3f u = next3D(random);
        const auto low = r.emitters.sampleDirection({0, 0.5f, 0}, {}, u);
        const auto high = r.emitters.sampleDirection({0, 3, 0}, {}, u);
        below += low && low->weight.x > 0 && meet(r, {0, 0.5f, 0}, {}, low->wi).radiance.x > 0;
        above += high && high->weight.x > 0 && meet(r, {0, 3, 0}, {}, high->wi).radiance.x > 0;
        EXPECT_FALSE(low && high);
      }
      EXPECT_TRUE((below > 150) != (above > 150)) << below << ' ' << above;
    }
  }
}

// No emitter is chosen more than twice as rarely as by uniform selection.
TEST(EmitterSampler, KeepsHalfOfUniformSelection) {
  Scene scene = test::stageScene();
  addLighting(scene, Lighting::mixed);
  Emitter dim;
  dim.type = EmitterType::point;
  dim.radiance = Rgb(1e-6f);
  dim.toWorld = Transform(translation({0, 1, 0}));
  test::addEmitter(scene, dim);
  const uint32_t dimIndex = static_cast<uint32_t>(scene.emitters.size() - 1);
  const Renderable r(scene);
  Rng random(5);
  int count = 0;
  constexpr int kSamples = 40000, kEmitters = 8;
  for (int i = 0; i < kSamples; ++i) {
    const auto s = r.emitters.sampleDirection({0.5f, 0, 0.5f}, {0, 1, 0}, next3D(random));
    if (s && s->emitter == dimIndex) ++count;
  }
  EXPECT_GT(count, kSamples / (2 * kEmitters) * 0.93);
}

// A broken or black emitter, alone or beside a sound one: no density is out of bounds or not
// finite, and the sound one is sampled as before.
TEST(EmitterSampler, BrokenEmittersDoNotSpoilOthers) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const Rgb value : {Rgb(nan, 1, 1), Rgb(inf), Rgb(-1.f), Rgb(0.f)}) {
    for (const Lighting broken : {Lighting::quad, Lighting::sphere, Lighting::point,
                                  Lighting::directional, Lighting::constant}) {
      for (const bool sound : {false, true}) {
        Scene scene = test::stageScene();
        addLighting(scene, broken);
        scene.emitters.back().radiance = value;
        const size_t bad = scene.emitters.size() - 1;
        if (sound) {
          test::addQuad(scene, {-1.8f, 1.5f, -1}, {0.4f, 0, 0}, {0, 0, 0.4f}, {0},
                        test::addAreaEmitter(scene, Rgb(2)));
        }
        const Renderable r(scene);
        EXPECT_TRUE(std::isfinite(r.emitters.power()));
        Rng random(7);
        int found = 0;
        for (int i = 0; i < 400; ++i) {
          const Vec3f p{-1.5f, 0.5f, -0.8f};
          const auto s = r.emitters.sampleDirection(p, {0, 1, 0}, next3D(random));
          if (s && s->emitter != bad) {
            EXPECT_TRUE(isFinite(s->weight) && std::isfinite(s->pdf));
            ++found;
          }
          EXPECT_TRUE(
              std::isfinite(meet(r, p, {0, 1, 0}, sampleSphereUniform(random.next2D())).pdf));
          const float select = random.next1D();
          const Vec2f a = random.next2D();
          r.emitters.sampleRay(select, a, random.next2D());
        }
        EXPECT_EQ(found > 100, sound) << nameOf(broken);
      }
    }
  }
}

TEST(EmitterSampler, ManyTrianglesAreSampledEvenly) {
  Scene scene;
  const EmitterHandle light = test::addAreaEmitter(scene, Rgb(1));
  const MaterialHandle black = test::addMaterial(scene, test::diffuseMaterial(Rgb(0.f)));
  Mesh mesh;
  constexpr uint32_t kSide = 300;
  for (uint32_t y = 0; y <= kSide; ++y) {
    for (uint32_t x = 0; x <= kSide; ++x) {
      mesh.positions.push_back({static_cast<float>(x) / kSide, 0, static_cast<float>(y) / kSide});
    }
  }
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x) {
      const uint32_t v = y * (kSide + 1) + x;
      mesh.triangles.push_back({v, v + kSide + 1, v + 1});
      mesh.triangles.push_back({v + 1, v + kSide + 1, v + kSide + 2});
    }
  }
  scene.meshes.push_back(std::move(mesh));
  Instance instance;
  instance.mesh = {0};
  instance.material = black;
  instance.emitter = light;
  scene.instances.push_back(instance);
  const EmitterSampler emitters(scene, bounds(scene));
  // Irradiance from a unit square above its middle at distance 1/2: E = L pi F with the form
  // factor of a differential area and a parallel rectangle over its corner, four times.
  const double a = 1, b = std::sqrt(2.0);  // side / distance, and sqrt(1 + a^2)
  const double exact = M_PI * 4 / (2 * M_PI) * 2 * (a / b) * std::atan(a / b);
  Rng random(6);
  double sum = 0, square = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const auto s = emitters.sampleDirection({0.5f, 0.5f, 0.5f}, {0, -1, 0}, next3D(random));
    const double v = s ? double{s->weight.x * std::max(0.f, -s->wi.y)} : 0;
    sum += v, square += v * v;
  }
  const double mean = sum / kSamples;
  const double deviation = std::sqrt(square / kSamples - mean * mean);
  EXPECT_NEAR(mean, exact, 4 * deviation / std::sqrt(double{kSamples}));
  EXPECT_LT(deviation, mean);  // uniform choice by area alone: 0.56
}

}  // namespace
}  // namespace lobelia
