// Receivers' Gaussians and random numbers, for spherical lights.
#include <algorithm>
#include <bit>

#include "lobelia/base/random.h"
#include "lobelia/gather/sphere.h"
#include "lobelia/gather/tile.h"

namespace lobelia::gather {
namespace {

// By the point itself: the same in whatever tile it comes.
void setRandom(const ReceiverPoint& point, size_t lane, SamplingStrip* strip) {
  uint64_t key = hashCombine(point.pixel, point.depth);
  for (const float v : {point.p.x, point.p.y, point.p.z, point.wo.x, point.wo.y})
    key = hashCombine(key, std::bit_cast<uint32_t>(v));
  for (auto& random : strip->random) {
    random[lane] = toUnitFloat(static_cast<uint32_t>(key >> 32));
    key = mixBits(key + 1);
  }
}

}  // namespace

void addSampling(const Receivers& receivers, Tile* tile) {
  tile->receivers = &receivers;
  tile->sampling.resize(tile->strips.size());
  for (size_t s = 0; s < tile->strips.size(); ++s) {
    PointStrip& strip = tile->strips[s];
    SamplingStrip& sampling = tile->sampling[s];
    GaussianStrip found[kSphereGaussians] = {};
    int most = 0, votes[kMaxLobes] = {};
    for (size_t lane = 0; lane < kStrip; ++lane) {
      const ReceiverPoint& point = receivers.points[strip.point[lane]];
      const SamplingLobes lobes = samplingLobes(receiverBsdf(receivers, point), point.wo);
      sampling.diffuse[lane] = lobes.diffuse;
      sampling.sharpest[lane] = lobes.sharpest;
      for (int i = 0; i < kSphereGaussians; ++i) {
        const PreparedSphere::Gaussian g =
            i < lobes.gaussianCount ? lobes.gaussians[i] : PreparedSphere::Gaussian{point.ng, 1, 0};
        found[i].axis.set(static_cast<int>(lane), g.axis);
        found[i].sharpness[lane] = g.sharpness;
        found[i].amplitude[lane] = g.amplitude;
      }
      most = std::max(most, lobes.gaussianCount);
      if (lobes.halfLobe >= 0) ++votes[lobes.halfLobe];
      setRandom(point, lane, &sampling);
    }
    const int* chosen = std::max_element(votes, votes + kMaxLobes);
    sampling.halfLobe = *chosen > 0 ? static_cast<int>(chosen - votes) : -1;
    strip.firstGaussian = tile->gaussians.size();
    strip.gaussianCount = static_cast<size_t>(most);
    tile->gaussians.insert(tile->gaussians.end(), found, found + most);
  }
}

}  // namespace lobelia::gather
