// Eye pass and virtual lights together against plain path tracing: what one leaves out the other
// has to bring, for every kind of surface that splits light between them.
#include <gtest/gtest.h>

#include "lobelia/base/parallel.h"
#include "lobelia/lights/light_pass.h"
#include "lobelia/path/path_tracer.h"
#include "lobelia/path/receivers.h"
#include "support/box_scene.h"
#include "support/split_oracle.h"

namespace lobelia {
namespace {

using test::addMaterial;
using test::boxScene;

constexpr float kMinDistance = 0.2f;

Rgb lightAt(const DiffuseLight& l, Vec3f w) {
  return l.intensity * std::max(0.f, dot(decodeOctahedral(l.normal), w));
}
Rgb lightAt(const GlossyLight& l, Vec3f w) {
  if (dot(l.n, w) <= 0) return {};
  return l.intensity * std::exp(l.sharpness * (dot(l.axis, w) - 1));
}

class Split {
 public:
  explicit Split(Scene s, uint64_t seed = 0)
      : scene_(std::move(s)), tracer_(scene_, context_), emitters_(scene_, tracer_.bounds()) {
    context_.seed = seed;
  }

  test::SplitMeans virtualLights(int maxDepth, int spp, bool directAsLights = false) {
    const Camera& camera = scene_.cameras[0];
    LightSettings lightSettings;
    lightSettings.count = 60000;
    lightSettings.maxDepth = maxDepth;
    lightSettings.directAsLights = directAsLights;
    const VirtualLights lights = makeLights(tracer_, emitters_, lightSettings, context_);

    Film film;
    film.width = film.fullWidth = camera.width;
    film.height = film.fullHeight = camera.height;
    film.addLayer("direct");
    film.addLayer("indirect");
    EyeSettings eye;
    eye.sampleCount = spp;
    eye.maxDepth = maxDepth;
    eye.directSamples = directAsLights ? 0 : 1;
    Rgb gathered;
    for (eye.sample = 0; eye.sample < spp; ++eye.sample)
      gathered += gather(
          lights, traceReceivers(tracer_, emitters_, camera, eye, 0, camera.height, film, context_),
          maxDepth);
    test::SplitMeans mean;
    for (size_t i = 0; i < film.pixelCount(); ++i) {
      mean.direct += film.rgb(i, "direct");
      mean.indirect += film.rgb(i, "indirect");
    }
    const float n = static_cast<float>(film.pixelCount());
    return {mean.direct / n, (mean.indirect + gathered) / n};
  }

  test::SplitMeans pathTracer(int maxDepth, int spp) {
    const Camera& camera = scene_.cameras[0];
    Film film;
    film.width = film.fullWidth = camera.width;
    film.height = film.fullHeight = camera.height;
    for (const char* name : {"", "direct", "indirect"}) film.addLayer(name);
    PathSettings settings;
    settings.spp = spp;
    settings.maxDepth = maxDepth;
    renderPath(tracer_, emitters_, camera, settings, film, context_);
    test::SplitMeans mean;
    for (size_t i = 0; i < film.pixelCount(); ++i) {
      mean.direct += film.rgb(i, "direct");
      mean.indirect += film.rgb(i, "indirect");
    }
    const float n = static_cast<float>(film.pixelCount());
    return {mean.direct / n, mean.indirect / n};
  }

  test::SplitMeans oracle(int maxDepth, int spp, float minDistance = kMinDistance) {
    return test::SplitOracle{tracer_, emitters_, 0.08f, maxDepth, minDistance}.mean(
        scene_.cameras[0], spp, 11);
  }

 private:
  // Some lights for each receiver, drawn evenly: an unbiased sum over all.
  Rgb gather(const VirtualLights& lights, const Receivers& receivers, int maxDepth) {
    constexpr int kPerReceiver = 16;
    std::vector<Rgb> values(receivers.points.size());
    const uint64_t salt = runs_++;
    parallelFor(values.size(), 64, [&](size_t i) {
      const ReceiverPoint& r = receivers.points[i];
      Bsdf bsdf;
      bsdf.frames[0] = r.frame;
      bsdf.ng = r.ng;
      for (uint32_t k = 0; k < r.lobeCount; ++k) bsdf.add(receivers.lobes[r.firstLobe + k]);
      Rng random(salt, i);
      const auto limit = [&](const std::vector<uint32_t>& ends) -> size_t {
        if (ends.empty()) return 0;
        const int last = maxDepth < 0 ? 1000 : maxDepth - r.depth - 1;
        if (last < 0) return 0;
        return ends[std::min(static_cast<size_t>(last), ends.size() - 1)];
      };
      values[i] =
          r.weight *
          (some(lights.diffuse, limit(lights.diffuseDepthEnds), r, bsdf, kPerReceiver, random) +
           some(lights.glossy, limit(lights.glossyDepthEnds), r, bsdf, kPerReceiver, random));
    });
    Rgb sum;
    for (const Rgb v : values) sum += v;
    return sum;
  }

  template <class Light>
  Rgb some(const std::vector<Light>& lights, size_t count, const ReceiverPoint& r, const Bsdf& bsdf,
           int tries, Rng& random) const {
    Rgb sum;
    if (count == 0) return sum;
    for (int k = 0; k < tries; ++k) {
      const size_t chosen =
          std::min(count - 1, static_cast<size_t>(random.next1D() * static_cast<float>(count)));
      const Light& light = lights[chosen];
      const Vec3f d = light.p - r.p;
      const float d2 = lengthSquared(d);
      if (d2 < kMinDistance * kMinDistance) continue;
      const Vec3f wi = d / std::sqrt(d2);
      const Rgb value = lightAt(light, -wi) * evaluate(bsdf, r.wo, wi, LobeSet::rough) / d2;
      if (value == Rgb{}) continue;
      if (tracer_.visible(offsetOrigin(r.p, r.ng, r.error, wi), light.p)) sum += value;
    }
    return sum * (static_cast<float>(count) / static_cast<float>(tries));
  }

  Context context_;
  Scene scene_;
  Tracer tracer_;
  EmitterSampler emitters_;
  uint64_t runs_ = 0;
};

void expectEqualLight(Scene scene, int maxDepth, float tolerance, const char* name) {
  SCOPED_TRACE(name);
  Split split(std::move(scene));
  const test::SplitMeans ours = split.virtualLights(maxDepth, 128),
                         truth = split.oracle(maxDepth, 1500);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(ours.direct[c] / truth.direct[c], 1, 0.025) << "direct, channel " << c;
    EXPECT_NEAR(ours.indirect[c] / truth.indirect[c], 1, tolerance) << "indirect, channel " << c;
  }
}

Scene with(Scene scene, test::BoxWall wall, const Material& material) {
  scene.instances[wall].material = addMaterial(scene, material);
  return scene;
}

Material mirror() {
  Material m;
  m.type = MaterialType::conductor;
  m.specular = Rgb(0.9f);
  return m;
}
Material metal(float alpha) {
  Material m;
  m.type = MaterialType::roughConductor;
  m.distribution = Distribution::beckmann;
  m.alphaU = alpha;
  m.alphaV = alpha;
  m.specular = Rgb(0.9f);
  return m;
}
Material polished(MaterialType type, float alpha) {
  Material m;
  m.type = type;
  m.ior = 1.9f;
  m.diffuse = Rgb(0.5f, 0.4f, 0.3f);
  m.alphaU = alpha;
  m.alphaV = alpha;
  return m;
}

TEST(LightSplit, DiffuseRoom) {
  expectEqualLight(boxScene(), -1, 0.03f, "unlimited");
  expectEqualLight(boxScene(), 3, 0.025f, "one bounce");
}
TEST(LightSplit, Mirror) {
  expectEqualLight(with(boxScene(), test::backWall, mirror()), -1, 0.03f, "unlimited");
  expectEqualLight(with(boxScene(), test::backWall, mirror()), 4, 0.03f, "four edges");
}
TEST(LightSplit, SharpMetalIsNoMirrorButActsAlike) {
  expectEqualLight(with(boxScene(), test::floorWall, metal(0.06f)), -1, 0.03f, "unlimited");
}
TEST(LightSplit, LampBehindGlass) {
  Scene scene = boxScene();
  test::addPane(scene);
  expectEqualLight(scene, -1, 0.03f, "slab, unlimited");
  expectEqualLight(scene, 6, 0.03f, "slab, six edges");
}
TEST(LightSplit, LampBehindAThinPane) {
  Material pane;
  pane.type = MaterialType::thinDielectric;
  pane.ior = 1.5f;
  Scene scene = boxScene();
  test::addQuad(scene, {-1, 0.85f, -1}, {2, 0, 0}, {0, 0, 2}, addMaterial(scene, pane));
  expectEqualLight(scene, -1, 0.03f, "unlimited");
}
TEST(LightSplit, PolishedCoats) {
  const Scene smooth = with(boxScene(), test::floorWall, polished(MaterialType::plastic, 0.f));
  expectEqualLight(smooth, -1, 0.03f, "smooth");
  const Scene sharp =
      with(boxScene(), test::floorWall, polished(MaterialType::roughPlastic, 0.05f));
  expectEqualLight(sharp, -1, 0.03f, "sharper than the limit");
}
// Glossy lights are approximate.
TEST(LightSplit, RoughMetalByGaussians) {
  expectEqualLight(with(boxScene(), test::floorWall, metal(0.25f)), -1, 0.03f, "unlimited");
}
// The reference splits by the same definition, so that its components can judge ours.
TEST(LightSplit, ThePathTracerSplitsAlike) {
  Scene scene = with(boxScene(), test::floorWall, polished(MaterialType::roughPlastic, 0.05f));
  scene = with(scene, test::backWall, mirror());
  for (const int maxDepth : {-1, 4}) {
    Split split(scene);
    const test::SplitMeans path = split.pathTracer(maxDepth, 256),
                           truth = split.oracle(maxDepth, 1500, 0);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(path.direct[c] / truth.direct[c], 1, 0.02) << "depth " << maxDepth;
      EXPECT_NEAR(path.indirect[c] / truth.indirect[c], 1, 0.02) << "depth " << maxDepth;
    }
  }
}
// Emitters as lights: direct and indirect light are gathered together.
TEST(LightSplit, EmittersAsLights) {
  Split split(with(boxScene(), test::backWall, mirror()));
  const test::SplitMeans ours = split.virtualLights(5, 128, true), truth = split.oracle(5, 1500);
  for (int c = 0; c < 3; ++c) {
    const float expected = truth.direct[c] + truth.indirect[c];
    EXPECT_NEAR((ours.direct[c] + ours.indirect[c]) / expected, 1, 0.025);
  }
}

}  // namespace
}  // namespace lobelia
