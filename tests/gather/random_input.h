// Random rooms, receivers and lights for the gather tests.
#pragma once

#include <vector>

#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/gather/gather.h"
#include "lobelia/scene/shading.h"

namespace lobelia::test {

inline Vec3f randomDirection(Rng* rng) { return sampleSphereUniform(rng->next2D()); }
inline Vec3f randomPoint(Rng* rng, float radius) {
  const Vec2f xy = rng->next2D();
  return (Vec3f(xy.x, xy.y, rng->next1D()) - Vec3f(0.5f)) * (2 * radius);
}
inline Rgb randomColor(Rng* rng) { return randomPoint(rng, 0.5f) + Rgb(0.5f); }

// Loose triangles that hide some points from others, within [-1, 1]^3.
inline Scene randomTriangles(int count, uint64_t seed) {
  Rng rng(seed);
  Scene scene;
  Mesh mesh;
  for (int i = 0; i < count; ++i) {
    const Vec3f centre = randomPoint(&rng, 1.f);
    const uint32_t first = static_cast<uint32_t>(mesh.positions.size());
    for (int v = 0; v < 3; ++v) mesh.positions.push_back(centre + randomPoint(&rng, 0.3f));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  scene.meshes.push_back(std::move(mesh));
  scene.materials.emplace_back();
  Instance instance;
  instance.mesh.index = 0;
  instance.material.index = 0;
  scene.instances.push_back(instance);
  return scene;
}

// One of two transmittance tables.
inline const float* randomTable(Rng* rng) {
  static const std::vector<float> table = [] {
    std::vector<float> values;
    for (int i = 0; i <= 2 * kTransmittanceSize; ++i)  // and what follows a table
      values.push_back(0.9f - 0.8f * std::exp(-0.1f * static_cast<float>(i)));
    return values;
  }();
  return table.data() + (rng->next1D() < 0.5f ? 0 : kTransmittanceSize);
}

// A plausible rough lobe of the given kind.
inline Lobe randomLobe(LobeType type, Rng* rng) {
  Lobe lobe;
  lobe.type = type;
  lobe.weight = randomColor(rng);
  lobe.alphaX = 0.1f + 0.5f * rng->next1D();
  lobe.alphaY = 0.1f + 0.5f * rng->next1D();
  lobe.eta = Rgb(1.2f + 0.5f * rng->next1D());
  const bool coin = rng->next1D() < 0.5f;
  switch (type) {
    case LobeType::coatedDiffuse:
      if (coin) {
        lobe.variant = 1;
        lobe.table = randomTable(rng);
      }
      break;
    case LobeType::sheen:
      if (coin) lobe.variant = kCoated, lobe.table = randomTable(rng);
      break;
    case LobeType::principledDiffuse:
      lobe.k = randomColor(rng);
      lobe.parameters = randomColor(rng);
      lobe.tint = randomColor(rng);
      break;
    case LobeType::microfacetReflection:
    case LobeType::thinTransmission:
      if (coin) lobe.variant = kCoated, lobe.table = randomTable(rng);
      lobe.distribution =
          static_cast<Distribution>(std::min(4, static_cast<int>(rng->next1D() * 5)));
      lobe.fresnel = static_cast<Fresnel>(std::min(6, static_cast<int>(rng->next1D() * 7)));
      if (lobe.fresnel == Fresnel::schlick) lobe.eta = randomColor(rng), lobe.k = randomColor(rng);
      if (lobe.fresnel == Fresnel::conductor)
        lobe.eta = randomColor(rng) * 2.f, lobe.k = randomColor(rng) * 3.f;
      lobe.parameters = randomColor(rng);
      lobe.tint = randomColor(rng);
      if (lobe.fresnel == Fresnel::coatedConductor) {
        lobe.k = randomColor(rng) * 3.f;
        lobe.parameters.x = 1.5f;
      }
      lobe.interface = coin && lobe.fresnel == Fresnel::dielectric &&
                       lobe.type == LobeType::microfacetReflection;
      break;
    case LobeType::microfacetTransmission:
      lobe.distribution =
          static_cast<Distribution>(std::min(2, static_cast<int>(rng->next1D() * 3)));
      lobe.fresnel = Fresnel::dielectric;
      lobe.interface = true;
      if (coin) lobe.variant = kCoated, lobe.table = randomTable(rng);
      return lobe;
    case LobeType::phong:
      lobe.alphaX = 5 + 60 * rng->next1D();
      break;
    case LobeType::ward:
      lobe.variant = static_cast<uint8_t>(std::min(2, static_cast<int>(rng->next1D() * 3)));
      break;
    default:
      break;
  }
  lobe.twoSided = !lobe.interface && rng->next1D() < 0.5f;
  return lobe;
}

// Points in the room; each has `lobesPerPoint` lobes drawn from `types`.
inline Receivers randomReceivers(size_t count, const std::vector<LobeType>& types,
                                 size_t lobesPerPoint, uint64_t seed) {
  Rng rng(seed);
  Receivers receivers;
  for (size_t i = 0; i < count; ++i) {
    ReceiverPoint point;
    point.p = randomPoint(&rng, 1.f);
    point.frame = frameFromNormal(randomDirection(&rng));
    point.ng = normalize(point.frame.n + randomPoint(&rng, 0.1f));
    point.wo = randomDirection(&rng);
    point.weight = randomColor(&rng);
    point.error = 1e-5f;
    point.pixel = static_cast<uint32_t>(i);
    point.firstLobe = static_cast<uint32_t>(receivers.lobes.size());
    point.depth = static_cast<uint8_t>(1 + 3 * rng.next1D());
    point.lobeCount = static_cast<uint8_t>(lobesPerPoint);
    for (size_t l = 0; l < lobesPerPoint; ++l) {
      const float pick = rng.next1D() * static_cast<float>(types.size());
      receivers.lobes.push_back(
          randomLobe(types[std::min(types.size() - 1, static_cast<size_t>(pick))], &rng));
    }
    receivers.points.push_back(point);
  }
  return receivers;
}

// Lights of every class; depths 0, 1, 2, 3 in equal shares.
inline VirtualLights randomLights(size_t perClass, float maxSharpness, uint64_t seed) {
  Rng rng(seed);
  VirtualLights lights;
  for (size_t i = 0; i < perClass; ++i) {
    lights.omni.push_back({randomPoint(&rng, 1.f), randomColor(&rng), 0xffffffffu});
    lights.directional.push_back({randomDirection(&rng), randomColor(&rng)});
    lights.diffuse.push_back({randomPoint(&rng, 1.f), randomColor(&rng),
                              encodeOctahedral(randomDirection(&rng)),
                              static_cast<uint32_t>(i * 4 / perClass)});
    const Vec3f n = randomDirection(&rng);
    const Vec3f axis = normalize(n + randomDirection(&rng) * 0.9f);
    lights.glossy.push_back(
        {randomPoint(&rng, 1.f), n, axis, randomColor(&rng), std::pow(maxSharpness, rng.next1D())});
  }
  for (uint32_t d = 1; d <= 4; ++d) {
    lights.diffuseDepthEnds.push_back(static_cast<uint32_t>((perClass * d + 3) / 4));
    lights.glossyDepthEnds.push_back(static_cast<uint32_t>((perClass * d + 3) / 4));
  }
  return lights;
}

}  // namespace lobelia::test
