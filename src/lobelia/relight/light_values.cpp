#include "lobelia/relight/light_values.h"

#include <array>
#include <bit>
#include <cmath>

#include "lobelia/base/parallel.h"

namespace lobelia::relight {
namespace {

// Of one sample or node; `weighted` is the sum of luminance times direction.
struct Gathered {
  Rgb power{};
  Vec3f weighted{};
};

// Parts of the list, each with sums of its own: always as many, so that sums do not depend on the
// number of threads.
constexpr size_t kParts = 4;

std::vector<Gathered> atSamples(const DistantLight& light, const Mat4& turned,
                                const LightSamples& samples, const DirectionLookup& lookup) {
  const Vec3f toX = turned.vector({1, 0, 0}), toY = turned.vector({0, 1, 0}),
              toZ = turned.vector({0, 0, 1});
  std::array<std::vector<Gathered>, kParts> parts;
  const size_t count = light.powers.size(), each = (count + kParts - 1) / kParts;
  parallelFor(kParts, 1, [&](size_t part) {
    const size_t begin = std::min(part * each, count), end = std::min(begin + each, count);
    if (begin == end) return;
    parts[part].resize(samples.count());
    for (size_t i = begin; i < end; ++i) {
      const DirectedPower& from = light.powers[i];
      const Vec3f d = toX * from.direction.x + toY * from.direction.y + toZ * from.direction.z;
      Gathered& at = parts[part][lookup.nearest(d)];
      at.power += from.power;
      at.weighted += d * std::abs(luminance(from.power));
    }
  });
  std::vector<Gathered> out(samples.count());
  parallelFor(out.size(), 1024, [&](size_t i) {
    const Rgb even = light.everywhere * samples.measure[i];
    out[i] = {even, samples.p[i] * luminance(even)};
    for (const std::vector<Gathered>& part : parts) {
      if (part.empty()) continue;
      out[i].power += part[i].power;
      out[i].weighted += part[i].weighted;
    }
  });
  return out;
}

}  // namespace

void LightSums::resize(int newLevels) {
  levels = newLevels;
  const size_t nodes = size_t{2} << levels;
  powers.assign(nodes, {});
  rows.assign(3 * nodes, 0.f);
  for (AlignedFloats* values : {&x, &y, &z}) values->assign(nodes, 0.f);
}

LightSums lightSums(const DistantLight& light, const Mat4& turned, const LightSamples& samples,
                    const DirectionLookup& lookup) {
  const size_t count = samples.count();
  std::vector<Gathered> nodes = atSamples(light, turned, samples, lookup);
  nodes.insert(nodes.begin(), count, Gathered{});
  std::vector<Vec3f> plain(2 * count);  // sums of the samples' directions, for the dark
  std::copy(samples.p.begin(), samples.p.end(), plain.begin() + static_cast<std::ptrdiff_t>(count));
  for (size_t i = count - 1; i > 0; --i) {
    nodes[i] = {nodes[2 * i].power + nodes[2 * i + 1].power,
                nodes[2 * i].weighted + nodes[2 * i + 1].weighted};
    plain[i] = plain[2 * i] + plain[2 * i + 1];
  }
  LightSums sums;
  sums.resize(std::countr_zero(count));
  parallelFor(2 * count, 1024, [&](size_t i) {
    if (i == 0) return;
    const Gathered& node = nodes[i];
    sums.setPower(i, node.power);
    Vec3f d = node.weighted;
    // Light from all around has no direction; neither does what has rounded away.
    if (!(lengthSquared(d) > 1e-30f)) d = plain[i];
    if (!(lengthSquared(d) > 1e-30f)) d = samples.p[0];
    d = normalize(d);
    sums.x[i] = d.x, sums.y[i] = d.y, sums.z[i] = d.z;
  });
  return sums;
}

}  // namespace lobelia::relight
