// Light samples, trees and light for tests, made without the precomputation.
#pragma once

#include <algorithm>
#include <cmath>

#include "lobelia/base/sampling.h"
#include "lobelia/relight/frame_light.h"

namespace lobelia::test {

// Directions on a spiral, sorted so that each half of the list is a half of space in the small.
inline void sortTree(std::span<Vec3f> p) {
  if (p.size() < 2) return;
  Bounds3f box;
  for (const Vec3f v : p) box.add(v);
  const Vec3f e = box.extent();
  const int axis = e.x >= e.y && e.x >= e.z ? 0 : e.y >= e.z ? 1 : 2;
  const auto middle = p.begin() + static_cast<std::ptrdiff_t>(p.size() / 2);
  std::nth_element(p.begin(), middle, p.end(), [&](Vec3f a, Vec3f b) { return a[axis] < b[axis]; });
  sortTree(p.first(p.size() / 2));
  sortTree(p.subspan(p.size() / 2));
}
inline relight::LightSamples spiralSamples(int levels) {
  relight::LightSamples out;
  const size_t count = size_t{1} << levels;
  for (size_t i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double phi = 2.399963229728653 * static_cast<double>(i), r = std::sqrt(1 - z * z);
    out.p.push_back(normalize(Vec3f(static_cast<float>(r * std::cos(phi)),
                                    static_cast<float>(r * std::sin(phi)), static_cast<float>(z))));
  }
  sortTree(out.p);
  out.measure.assign(count, 4 * kPi / static_cast<float>(count));
  return out;
}

// Some bright places over a dim, uneven sky.
inline relight::DistantLight spottedLight(size_t spots, uint64_t seed) {
  Rng rng(seed, 1);
  relight::DistantLight light;
  light.everywhere = {0.3f, 0.4f, 0.5f};
  for (size_t i = 0; i < spots; ++i) {
    const Vec3f d = sampleSphereUniform(rng.next2D());
    light.powers.push_back({d, Rgb(rng.next1D(), rng.next1D(), rng.next1D()) * 0.05f});
  }
  return light;
}

struct LitTree {
  relight::LightSamples samples;
  relight::SampleTree tree;
  relight::DirectionLookup lookup;
  relight::FrameLight light;
};
inline LitTree litTree(int levels, const relight::DistantLight& from, size_t nodes,
                       const Mat4& turned = {}) {
  LitTree out;
  out.samples = spiralSamples(levels);
  out.tree = relight::makeSampleTree(out.samples);
  out.lookup = relight::DirectionLookup(out.samples.p);
  out.light = relight::makeFrameLight(from, turned, out.samples, out.tree, out.lookup,
                                      {.nodeCount = nodes});
  return out;
}

}  // namespace lobelia::test
