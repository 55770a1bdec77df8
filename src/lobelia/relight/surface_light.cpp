#include "lobelia/relight/surface_light.h"

#include <bit>
#include <cmath>

namespace lobelia::relight {
namespace {

// A node's means: by light, or evenly where there is none.
struct Node {
  Rgb power{};
  float weight = 0;  // luminance of the light
  Vec3f p, n;
  float spread = 0;  // mean squared distance from p
};

Node merged(const Node& a, const Node& b) {
  Node out;
  out.power = a.power + b.power;
  out.weight = a.weight + b.weight;
  const float shareB = out.weight > 0 ? b.weight / out.weight : 0.5f, shareA = 1 - shareB;
  out.p = a.p * shareA + b.p * shareB;
  out.n = a.n * shareA + b.n * shareB;
  out.spread = a.spread * shareA + b.spread * shareB + shareA * shareB * lengthSquared(a.p - b.p);
  return out;
}

}  // namespace

SurfaceLight surfaceLight(const LightSamples& samples, std::span<const Rgb> radiance) {
  const size_t count = samples.count();
  std::vector<Node> nodes(2 * count);
  for (size_t i = 0; i < count; ++i) {
    const Rgb power = radiance[i] * samples.measure[i];
    nodes[count + i] = {power, std::abs(luminance(power)), samples.p[i], samples.n[i], 0};
  }
  for (size_t i = count - 1; i > 0; --i) nodes[i] = merged(nodes[2 * i], nodes[2 * i + 1]);

  SurfaceLight light;
  light.sums.levels = std::countr_zero(count);
  light.sampleArea = samples.measure[0];
  LightSums& sums = light.sums;
  for (AlignedFloats* values :
       {&sums.r, &sums.g, &sums.b, &sums.x, &sums.y, &sums.z, &light.nx, &light.ny, &light.nz})
    values->resize(2 * count);
  light.size.resize(2 * count);
  for (size_t i = 1; i < 2 * count; ++i) {
    const Node& node = nodes[i];
    sums.r[i] = node.power.x, sums.g[i] = node.power.y, sums.b[i] = node.power.z;
    sums.x[i] = node.p.x, sums.y[i] = node.p.y, sums.z[i] = node.p.z;
    light.nx[i] = node.n.x, light.ny[i] = node.n.y, light.nz[i] = node.n.z;
    light.size[i] = std::sqrt(node.spread);
  }
  return light;
}

}  // namespace lobelia::relight
