// Directions of an environment, evenly spread by repulsion [P004 section 4.1].
//
// Deviation: the paper starts from random points. Here the start is a spherical Fibonacci lattice
// [Marques13], turned and jittered by the seed: what repulsion between neighbours cannot even out
// in few steps, differences over long ways, is even from the start. All directions stand for the
// same solid angle, so that a node's share of the sphere is its number of leaves.
#include "lobelia/relight/light_samples.h"

#include <fmt/format.h>

#include <bit>
#include <stdexcept>

#include "lobelia/base/frame.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/relight/point_grid.h"

namespace lobelia::relight {
namespace {

constexpr uint64_t kStream = 0x656e7620;  // of the environment's random numbers

std::vector<Vec3f> jitteredLattice(size_t count, uint64_t seed, float spacing) {
  Sampler turn(seed, kStream, 0);
  const Frame frame = frameFromNormal(sampleSphereUniform(turn.next2D()));
  const double golden = 0.5 * (3 - std::sqrt(5.0)), shift = static_cast<double>(turn.next1D());
  std::vector<Vec3f> points(count);
  parallelFor(count, 1024, [&](size_t i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double r = std::sqrt(1 - z * z);
    const double phi = 2 * M_PI * (golden * static_cast<double>(i) + shift);
    const Vec3f p = frame.toWorld({static_cast<float>(r * std::cos(phi)),
                                   static_cast<float>(r * std::sin(phi)), static_cast<float>(z)});
    Sampler random(hashCombine(seed, kStream), i, 0);
    const Vec2f move = sampleDiskConcentric(random.next2D()) * (0.1f * spacing);
    points[i] = normalize(frameFromNormal(p).toWorld({move.x, move.y, 1}));
  });
  return points;
}

// A step along the forces of the neighbours, which fall to zero at `reach`.
std::vector<Vec3f> repelled(const std::vector<Vec3f>& points, float spacing) {
  const float reach = 2 * spacing;
  const PointGrid grid(points, reach);
  std::vector<Vec3f> moved(points.size());
  parallelFor(points.size(), 256, [&](size_t i) {
    const Vec3f p = points[i];
    Vec3f force;
    grid.near(p, [&](uint32_t j) {
      const Vec3f away = p - points[j];
      const float distance = length(away);
      if (j != i && distance > 0) force += away * (sqr(1 - distance / reach) / distance);
    });
    const Vec3f step = force * (0.2f * spacing);
    moved[i] = normalize(p + step - p * dot(p, step));
  });
  return moved;
}

}  // namespace

void requireSampleCount(size_t count) {
  if (count < 2 || count > 32768 || !std::has_single_bit(count)) {
    throw std::invalid_argument(
        fmt::format("{} light samples: their number is a power of two from 2 to 32768", count));
  }
}

LightSamples environmentSamples(size_t count, uint64_t seed) {
  requireSampleCount(count);
  constexpr int kSteps = 24;
  const float spacing = std::sqrt(4 * kPi / static_cast<float>(count));
  LightSamples samples;
  samples.kind = LightSamples::Kind::environment;
  samples.p = jitteredLattice(count, seed, spacing);
  for (int step = 0; step < kSteps; ++step) samples.p = repelled(samples.p, spacing);
  samples.measure.assign(count, 4 * kPi / static_cast<float>(count));
  return samples;
}

LightSamples reordered(const LightSamples& samples, const std::vector<uint32_t>& order) {
  LightSamples out;
  out.kind = samples.kind;
  for (const uint32_t i : order) {
    out.p.push_back(samples.p[i]);
    if (!samples.n.empty()) out.n.push_back(samples.n[i]);
    out.measure.push_back(samples.measure[i]);
  }
  return out;
}

}  // namespace lobelia::relight
