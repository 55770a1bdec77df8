// Neighbouring receivers on a floor, lit by a wall of lights behind loose triangles: what
// strategies that share lights among receivers are good at.
#pragma once

#include <map>

#include "gather/random_input.h"

namespace lobelia::test {

// Of random receivers: on the floor, seen from about one direction; lobes of a type are all alike.
inline void layOnFloor(Receivers* receivers, uint64_t seed) {
  Rng rng(seed);
  for (ReceiverPoint& point : receivers->points) {
    point.p = {rng.next1D(), rng.next1D(), 0};
    point.frame = frameFromNormal({0, 0, 1});
    point.ng = {0, 0, 1};
    point.wo = normalize(Vec3f{0.3f, 0.2f, 1} + randomPoint(&rng, 0.05f));
    point.weight = Rgb(1.f);
  }
  std::map<LobeType, Lobe> first;
  for (Lobe& lobe : receivers->lobes) lobe = first.try_emplace(lobe.type, lobe).first->second;
}

// Half diffuse, half glossy.
inline VirtualLights wallOfLights(int count, uint64_t seed) {
  Rng rng(seed);
  VirtualLights wall;
  for (int i = 0; i < count; ++i) {
    const Vec3f p{-0.3f, rng.next1D(), 0.2f + rng.next1D()}, n{1, 0, 0};
    const Rgb color = randomColor(&rng);
    if (i % 2 == 0) {
      wall.diffuse.push_back({p, color, encodeOctahedral(n), 1});
    } else {
      const Vec3f axis = normalize(Vec3f{1, 0.1f, -0.8f} + randomPoint(&rng, 0.2f));
      wall.glossy.push_back({p, n, axis, color * 10.f, 20 + 30 * rng.next1D()});
    }
  }
  wall.diffuseDepthEnds = {0, static_cast<uint32_t>(wall.diffuse.size())};
  wall.glossyDepthEnds = {0, static_cast<uint32_t>(wall.glossy.size())};
  return wall;
}

inline Scene trianglesAboveFloor() {
  Scene scene = randomTriangles(60, 11);
  for (Vec3f& p : scene.meshes[0].positions) p = p * 0.2f + Vec3f{0, 0, 0.5f};
  return scene;
}

}  // namespace lobelia::test
