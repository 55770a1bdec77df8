#include "lobelia/gather/cut_receivers.h"

#include <algorithm>
#include <cmath>

#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::gather {
namespace {

// Receivers [begin, end) of a strip, and what one counts among them.
class Run {
 public:
  Run(const CutReceivers& receivers, int begin, int end)
      : receivers_(receivers), begin_(begin), end_(end) {
    for (int lane = begin; lane < end; ++lane) total_ += receivers.weight[lane];
  }

  // Those that count; if none does, the first.
  template <class Use>
  void forEach(const Use& use) const {
    if (!(total_ > 0)) return use(begin_, 1);
    for (int lane = begin_; lane < end_; ++lane)
      if (receivers_.weight[lane] > 0) use(lane, receivers_.weight[lane] / total_);
  }
  // Root of the sum of squares.
  float weight() const {
    float squares = 0;
    for (int lane = begin_; lane < end_; ++lane)
      squares += receivers_.weight[lane] * receivers_.weight[lane];
    return std::sqrt(squares);
  }
  // By the moments of their energy.
  lobes::SphericalGaussian mean(const GaussianStrip& strip) const {
    lobes::Moment moment;
    forEach([&](int lane, float share) {
      const float k = strip.sharpness[lane];
      const float energy = strip.amplitude[lane] * lobes::integral(k);
      moment.add(lobes::momentOf(strip.axis.get(lane), k, share * energy));
    });
    if (moment.weight > 0) return lobes::lobeOf(moment);
    return {{0, 0, 1}, 1, 0};
  }
  // Into one lane.
  void represent(int lane, CutReceivers* out) const;

 private:
  const CutReceivers& receivers_;
  const int begin_, end_;
  float total_ = 0;
};

void Run::represent(int lane, CutReceivers* out) const {
  Vec3f p, n;
  float diffuse = 0, above = 0, below = 0, nearScale = 0;
  forEach([&](int i, float share) {
    p += share * receivers_.p.get(i);
    n += share * receivers_.n.get(i);
    diffuse += share * receivers_.diffuse[i];
    above = std::max(above, receivers_.above[i]);
    below = std::max(below, receivers_.below[i]);
    nearScale = std::max(nearScale, receivers_.nearScale[i]);
  });
  n = dot(n, n) > 1e-12f ? normalize(n) : receivers_.n.get(begin_);
  float variance = 0, placeSlack = 0, normalSlack = 0;
  forEach([&](int i, float share) {
    const Vec3f apart = receivers_.p.get(i) - p;
    variance += share * dot(apart, apart);
    placeSlack = std::max(placeSlack, length(apart));
    normalSlack = std::max(normalSlack, length(receivers_.n.get(i) - n));
  });
  out->p.set(lane, p), out->n.set(lane, n);
  out->above[lane] = above, out->below[lane] = below;
  out->diffuse[lane] = diffuse;
  out->nearScale[lane] = nearScale;
  out->weight[lane] = weight();
  out->variance[lane] = variance;
  out->placeSlack[lane] = placeSlack, out->normalSlack[lane] = normalSlack;
  for (size_t i = 0; i < receivers_.gaussianCount; ++i) {
    const lobes::SphericalGaussian lobe = mean(receivers_.gaussians[i]);
    out->gaussians[i].axis.set(lane, lobe.axis);
    out->gaussians[i].sharpness[lane] = lobe.sharpness;
    out->gaussians[i].amplitude[lane] = lobe.amplitude;
  }
}

}  // namespace

CutReceivers cutReceivers(const Tile& tile, const Receivers& receivers) {
  const PointStrip& strip = tile.strips[0];
  CutReceivers out;
  out.p = strip.p, out.n = strip.n;
  std::copy_n(strip.above, kStrip, out.above);
  std::copy_n(strip.below, kStrip, out.below);
  std::copy_n(tile.sampling[0].diffuse, kStrip, out.diffuse);
  std::copy_n(strip.nearScale, kStrip, out.nearScale);
  out.gaussianCount = strip.gaussianCount;
  for (size_t i = 0; i < strip.gaussianCount; ++i)
    out.gaussians[i] = tile.gaussians[strip.firstGaussian + i];
  for (size_t lane = 0; lane < kStrip; ++lane) {
    const bool active = strip.active >> lane & 1;
    // Filters have weights below 0, too.
    out.weight[lane] = active ? std::abs(luminance(receivers.points[strip.point[lane]].weight)) : 0;
    out.variance[lane] = out.placeSlack[lane] = out.normalSlack[lane] = 0;
  }
  return out;
}

CutReceivers representatives(const CutReceivers& receivers, int count) {
  if (count == kStrip) return receivers;
  CutReceivers out;
  out.gaussianCount = receivers.gaussianCount;
  const int size = kStrip / count;
  for (int begin = 0; begin < kStrip; begin += size) {
    Run(receivers, begin, begin + size).represent(begin, &out);
    for (int lane = begin + 1; lane < begin + size; ++lane) setLane(out, begin, lane, &out);
  }
  return out;
}

CutReceivers peaks(const CutReceivers& receivers, int count) {
  CutReceivers out = representatives(receivers, count);
  const int size = kStrip / count;
  const auto raise = [](float* value, float to) { *value = std::max(*value, to); };
  for (int lane = 0; lane < kStrip; ++lane) {
    if (!(receivers.weight[lane] > 0)) continue;
    for (int to = lane / size * size; to < (lane / size + 1) * size; ++to) {
      raise(&out.diffuse[to], receivers.diffuse[lane]);
      for (size_t i = 0; i < receivers.gaussianCount; ++i)
        raise(&out.gaussians[i].amplitude[to], receivers.gaussians[i].amplitude[lane]);
    }
  }
  return out;
}

void setLane(const CutReceivers& receivers, int lane, int to, CutReceivers* out) {
  out->p.set(to, receivers.p.get(lane)), out->n.set(to, receivers.n.get(lane));
  out->above[to] = receivers.above[lane], out->below[to] = receivers.below[lane];
  out->diffuse[to] = receivers.diffuse[lane];
  out->nearScale[to] = receivers.nearScale[lane];
  out->weight[to] = receivers.weight[lane];
  out->variance[to] = receivers.variance[lane];
  out->placeSlack[to] = receivers.placeSlack[lane];
  out->normalSlack[to] = receivers.normalSlack[lane];
  for (; out->gaussianCount < receivers.gaussianCount; ++out->gaussianCount) {
    GaussianStrip& gaussian = out->gaussians[out->gaussianCount];
    for (int i = 0; i < kStrip; ++i) {
      gaussian.axis.set(i, {0, 0, 1});
      gaussian.sharpness[i] = 1, gaussian.amplitude[i] = 0;
    }
  }
  for (size_t i = 0; i < out->gaussianCount; ++i) {
    GaussianStrip& gaussian = out->gaussians[i];
    const bool has = i < receivers.gaussianCount;
    if (has) gaussian.axis.set(to, receivers.gaussians[i].axis.get(lane));
    if (has) gaussian.sharpness[to] = receivers.gaussians[i].sharpness[lane];
    gaussian.amplitude[to] = has ? receivers.gaussians[i].amplitude[lane] : 0;
  }
}

}  // namespace lobelia::gather
