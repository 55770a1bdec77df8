// A surface with one spherical light and points over it, for the tests of spherical lights.
#pragma once

#include <gtest/gtest.h>

#include "lobelia/gather/gather.h"
#include "lobelia/gather/spherical_paper.h"
#include "support/box_scene.h"

namespace lobelia::test {

inline Material phongMaterial(float diffuse, float specular, float exponent) {
  Material m;
  m.type = MaterialType::phong;
  m.diffuse = Rgb(diffuse), m.specular = Rgb(specular);
  m.alphaU = m.alphaV = exponent;
  return m;
}
inline Material roughMetal(Distribution distribution, float alphaU, float alphaV) {
  Material m;
  m.type = MaterialType::roughConductor;
  m.distribution = distribution;
  m.specular = Rgb(0.9f);
  m.alphaU = alphaU, m.alphaV = alphaV;
  return m;
}
inline Material wardMaterial(float alphaU, float alphaV) {
  Material m;
  m.type = MaterialType::ward;
  m.diffuse = Rgb(0.1f), m.specular = Rgb(0.6f);
  m.alphaU = alphaU, m.alphaV = alphaV;
  return m;
}

// A square floor, 40 wide, facing +z, of the material; a light at its middle, kMiddle, from which
// places are counted.
class LitFloor {
 public:
  static constexpr float kMiddle = 2;  // all three coordinates: away from 0, as rays are in scenes
  LitFloor(const Material& material, float radius, Vec3f arriving)
      : scene_(floor(material)), tracer_(scene_, context_) {
    lights_.model = "vsl";
    lights_.specularLimit = 0.01f;
    SphericalLight light{};
    light.p = Vec3f(kMiddle);
    light.power = Rgb(1, 0.8f, 0.6f);
    light.radius = radius;
    light.arriving = encodeOctahedral(normalize(arriving));
    light.instance = 0, light.triangle = 0;
    light.b1 = 0, light.b2 = 0.5f;  // middle of the quad: half of its diagonal
    light.coverage[0] = light.coverage[1] = ~0u;
    light.depth = 1;
    lights_.spherical = {light};
    lights_.sphericalDepthEnds = {0, 1};
  }

  // `copies` receivers of one BSDF at p, which differ in their random numbers only.
  static Receivers receivers(Vec3f p, Vec3f n, Vec3f wo, const Bsdf& bsdf, size_t copies) {
    Receivers result;
    for (int l = 0; l < bsdf.lobeCount; ++l) result.lobes.push_back(bsdf.lobes[l]);
    for (size_t i = 0; i < copies; ++i) {
      ReceiverPoint point;
      point.p = p + Vec3f(kMiddle), point.ng = n, point.frame = frameFromNormal(n);
      point.wo = normalize(wo);
      point.weight = Rgb(1.f);
      point.pixel = static_cast<uint32_t>(i);
      point.lobeCount = static_cast<uint8_t>(bsdf.lobeCount);
      result.points.push_back(point);
    }
    return result;
  }

  std::vector<Rgb> gather(const Receivers& receivers) {
    std::vector<Rgb> radiance(receivers.points.size());
    gatherAll(tracer_, receivers, lights_, {}, radiance, context_);
    return radiance;
  }

  // What evaluates the pair of the first receiver in scalar code; refers to the block.
  gather::SpherePair pair(const Receivers& receivers, gather::LightBlock* block) {
    gather::prepare(lights_, scene_, gather::LightClass::spherical, 0, 1, block);
    return {receivers.points[0], receiverBsdf(receivers, receivers.points[0]), block->lights[0],
            *block->spheres[0], lights_.sphereShading.indicator};
  }

  VirtualLights& lights() { return lights_; }
  const Scene& scene() const { return scene_; }
  const Tracer& tracer() const { return tracer_; }

 private:
  static Scene floor(const Material& material) {
    Scene scene;
    addQuad(scene, {kMiddle - 20, kMiddle - 20, kMiddle}, {40, 0, 0}, {0, 40, 0},
            addMaterial(scene, material));
    return scene;
  }
  Context context_;
  Scene scene_;
  Tracer tracer_;
  VirtualLights lights_;
};

// Mean and its standard error of a luminance.
struct Mean {
  double sum = 0, squares = 0;
  size_t count = 0;
  void add(Rgb value) {
    const double v = static_cast<double>(luminance(value));
    sum += v, squares += v * v, ++count;
  }
  double mean() const { return sum / static_cast<double>(count); }
  double deviation() const {
    return std::sqrt(std::max(0.0, squares / static_cast<double>(count) - mean() * mean()));
  }
  double error() const { return deviation() / std::sqrt(static_cast<double>(count)); }
};

}  // namespace lobelia::test
