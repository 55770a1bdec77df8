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
  Spread spread;
};

Spread mixed(const Spread& a, float shareA, const Spread& b, float shareB, Vec3f apart) {
  const float w = shareA * shareB;  // parallel axes
  return {a.xx * shareA + b.xx * shareB + w * apart.x * apart.x,
          a.yy * shareA + b.yy * shareB + w * apart.y * apart.y,
          a.zz * shareA + b.zz * shareB + w * apart.z * apart.z,
          a.xy * shareA + b.xy * shareB + w * apart.x * apart.y,
          a.xz * shareA + b.xz * shareB + w * apart.x * apart.z,
          a.yz * shareA + b.yz * shareB + w * apart.y * apart.z};
}

Node merged(const Node& a, const Node& b) {
  Node out;
  out.power = a.power + b.power;
  out.weight = a.weight + b.weight;
  const float shareB = out.weight > 0 ? b.weight / out.weight : 0.5f, shareA = 1 - shareB;
  out.p = a.p * shareA + b.p * shareB;
  out.n = a.n * shareA + b.n * shareB;
  out.spread = mixed(a.spread, shareA, b.spread, shareB, a.p - b.p);
  return out;
}

}  // namespace

SurfaceLight surfaceLight(const LightSamples& samples, std::span<const Rgb> radiance) {
  const size_t count = samples.count();
  std::vector<Node> nodes(2 * count);
  for (size_t i = 0; i < count; ++i) {
    const Rgb power = radiance[i] * samples.measure[i];
    nodes[count + i] = {power, std::abs(luminance(power)), samples.p[i], samples.n[i], {}};
  }
  for (size_t i = count - 1; i > 0; --i) nodes[i] = merged(nodes[2 * i], nodes[2 * i + 1]);

  SurfaceLight light;
  light.sums.resize(std::countr_zero(count));
  light.sampleArea = samples.measure[0];
  LightSums& sums = light.sums;
  for (AlignedFloats* values : {&light.nx, &light.ny, &light.nz}) values->resize(2 * count);
  light.spread.resize(2 * count);
  for (size_t i = 1; i < 2 * count; ++i) {
    const Node& node = nodes[i];
    sums.setPower(i, node.power);
    sums.x[i] = node.p.x, sums.y[i] = node.p.y, sums.z[i] = node.p.z;
    light.nx[i] = node.n.x, light.ny[i] = node.n.y, light.nz[i] = node.n.z;
    light.spread[i] = node.spread;
  }
  return light;
}

}  // namespace lobelia::relight
