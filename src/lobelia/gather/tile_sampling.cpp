// Receivers' Gaussians and random numbers, for spherical lights.
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

Bsdf receiverBsdf(const Receivers& receivers, const ReceiverPoint& point) {
  Bsdf bsdf;
  bsdf.frames[0] = point.frame;
  bsdf.frames[0].bumpAlpha2 = point.bumpAlpha2;
  bsdf.frames[0].perturbed = point.bumpAlpha2 > 0;
  bsdf.baseNormal = point.bumpAlpha2 > 0 ? point.baseNormal : point.frame.n;
  bsdf.ng = point.ng;
  for (size_t l = 0; l < point.lobeCount; ++l) {
    Lobe lobe = receivers.lobes[point.firstLobe + l];
    lobe.frame = 0;
    bsdf.add(lobe);
  }
  return bsdf;
}

void addSampling(const Receivers& receivers, Tile* tile) {
  tile->receivers = &receivers;
  tile->sampling.resize(tile->strips.size());
  for (size_t s = 0; s < tile->strips.size(); ++s) {
    PointStrip& strip = tile->strips[s];
    SamplingStrip& sampling = tile->sampling[s];
    GaussianStrip found[kSphereGaussians] = {};
    int most = 0;
    for (size_t lane = 0; lane < kStrip; ++lane) {
      const ReceiverPoint& point = receivers.points[strip.point[lane]];
      PreparedSphere::Gaussian gaussians[kSphereGaussians];
      const int count = strongestGaussians(receiverBsdf(receivers, point), point.wo, gaussians,
                                           &sampling.diffuse[lane]);
      sampling.sharpest[lane] = 0;
      for (int i = 0; i < kSphereGaussians; ++i) {
        const PreparedSphere::Gaussian g =
            i < count ? gaussians[i] : PreparedSphere::Gaussian{point.ng, 1, 0};
        found[i].axis.set(static_cast<int>(lane), g.axis);
        found[i].sharpness[lane] = g.sharpness;
        found[i].amplitude[lane] = g.amplitude;
        if (i < count) sampling.sharpest[lane] = std::max(sampling.sharpest[lane], g.sharpness);
      }
      most = std::max(most, count);
      setRandom(point, lane, &sampling);
    }
    strip.firstGaussian = tile->gaussians.size();
    strip.gaussianCount = static_cast<size_t>(most);
    tile->gaussians.insert(tile->gaussians.end(), found, found + most);
  }
}

}  // namespace lobelia::gather
