#include "lobelia/gather/receiver_nodes.h"

#include <algorithm>
#include <cmath>

#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::gather {
namespace {

constexpr float kTailShare = 1e-3f;  // of the peaks, that the cosine lobe has at least
constexpr float kNarrowest = 0.02f;  // of the fitted sharpness that is left at grazing angles
constexpr float kFarExponent = 4;    // where a Gaussian has fallen so far, the cosine lobe bounds
constexpr int kHemisphereSamples = 48, kAzimuths = 8;

// How much broader than the fitted Gaussian a lobe is in its broader direction: half vectors turn
// twice as far in the plane of incidence as across it, over the cosine.
float broadening(const Bsdf& bsdf, Vec3f wo) {
  float least = 1;
  for (int i = 0; i < bsdf.lobeCount; ++i) {
    const Lobe& lobe = bsdf.lobes[i];
    if (!drawnByHalfVector(lobe)) continue;
    const float thin = std::min(lobe.alphaX, lobe.alphaY),
                wide = std::max(lobe.alphaX, lobe.alphaY);
    least = std::min(least, std::abs(dot(wo, bsdf.frames[0].n)) * (wide > 0 ? thin / wide : 1.f));
  }
  return std::max(least, kNarrowest);
}

// What bounds a receiver: a cosine lobe and Gaussians, which are scaled sample by sample.
class Envelope {
 public:
  Envelope(const Bsdf& bsdf, Vec3f wo, bool above, bool below)
      : bsdf_(bsdf), wo_(wo), n_(bsdf.frames[0].n), above_(above), below_(below) {
    const SamplingLobes lobes = samplingLobes(bsdf, wo);
    diffuse = maxComponent(lobes.diffuseColor);
    diffuseMean = meanShare(lobes.diffuseColor);
    count = lobes.gaussianCount;
    Rgb glossy{};
    const float broad = broadening(bsdf, wo);
    for (int i = 0; i < count; ++i) {
      gaussians[i] = lobes.gaussians[i];
      glossy += gaussians[i].color;
      gaussians[i].amplitude = maxComponent(gaussians[i].color);
      gaussians[i].sharpness *= broad;
      diffuse += kTailShare * gaussians[i].amplitude;
    }
    glossyMean = meanShare(glossy);
    for (int i = 0; i < count; ++i) raiseAround(gaussians[i].axis, gaussians[i].sharpness);
    raiseOverHemispheres();
  }

  // Largest components of the colour; the luminance's share of them (BoundItem::mean).
  float diffuse = 0, diffuseMean = 1, glossyMean = 1;
  int count = 0;
  PreparedSphere::Gaussian gaussians[kSphereGaussians];

 private:
  static float meanShare(Rgb color) {
    return maxComponent(color) > 0 ? luminance(color) / maxComponent(color) : 1.f;
  }

  // Lobes' peaks, which may lie beside the axis.
  void raiseAround(Vec3f axis, float sharpness) {
    raise(axis);
    const Frame frame = frameFromNormal(axis);
    for (const float exponent : {0.125f, 0.5f, 1.f, 2.f, 3.5f}) {
      const float c = std::max(1 - exponent / std::max(sharpness, 0.5f * exponent), -1.f);
      const float s = std::sqrt(std::max(1 - c * c, 0.f));
      for (int i = 0; i < kAzimuths; ++i) {
        const float phi = kTwoPi * static_cast<float>(i) / kAzimuths;
        raise(frame.toWorld({s * std::cos(phi), s * std::sin(phi), c}));
      }
    }
  }

  void raiseOverHemispheres() {
    constexpr float kGoldenAngle = 2.39996323f;
    const Frame frame = frameFromNormal(n_);
    for (int i = 0; i < kHemisphereSamples; ++i) {
      const float z = (static_cast<float>(i) + 0.5f) / kHemisphereSamples;
      const float s = std::sqrt(1 - z * z), phi = kGoldenAngle * static_cast<float>(i);
      const Vec3f w{s * std::cos(phi), s * std::sin(phi), z};
      if (above_) raise(frame.toWorld(w));
      if (below_) raise(frame.toWorld({w.x, w.y, -w.z}));
    }
  }

  void raise(Vec3f wi) {
    // A cosine lobe on both sides counts as one of no cosine (receiverNodes()).
    const float cosine = above_ && below_ ? 1.f : dot(n_, wi) * (above_ ? 1.f : -1.f);
    if (!(cosine > 0)) return;
    const float value = maxComponent(evaluate(bsdf_, wo_, wi)), even = diffuse * cosine;
    float glossy = 0;
    bool far = true;
    for (int i = 0; i < count; ++i) {
      const PreparedSphere::Gaussian& g = gaussians[i];
      const float exponent = 0.5f * g.sharpness * lengthSquared(wi - g.axis);
      glossy += g.amplitude * std::exp(-exponent);
      far = far && exponent > kFarExponent;
    }
    if (!(value > even + glossy) || !std::isfinite(value)) return;
    if (far) {
      diffuse = (value - glossy) / cosine;
      return;
    }
    for (int i = 0; i < count; ++i) gaussians[i].amplitude *= (value - even) / glossy;
  }

  const Bsdf& bsdf_;
  const Vec3f wo_, n_;
  const bool above_, below_;
};

// The side on which light counts.
struct Sides {
  bool above, below;
  Sides(const PointStrip& strip, size_t lane)
      : above(strip.above[lane] > 0), below(strip.below[lane] > 0) {}
};

Envelope envelopeOf(const Receivers& receivers, size_t point, Sides sides) {
  const ReceiverPoint& at = receivers.points[point];
  return Envelope(receiverBsdf(receivers, at), at.wo, sides.above, sides.below);
}

// Without lobes.
trees::BoundItem placeOf(const ReceiverPoint& at, Sides sides) {
  trees::BoundItem item;
  item.p = at.p;
  if (sides.above != sides.below) item.n = sides.above ? at.frame.n : -at.frame.n;
  return item;
}

void addGaussians(const Envelope& envelope, trees::BoundItem* item) {
  item->gaussianCount = envelope.count;
  for (int i = 0; i < envelope.count; ++i) {
    const PreparedSphere::Gaussian& g = envelope.gaussians[i];
    item->gaussians[i] = {g.axis, g.sharpness, g.amplitude};
  }
}

}  // namespace

trees::BoundItem receiverItem(const Receivers& receivers, size_t point, const PointStrip& strip,
                              size_t lane) {
  const Sides sides(strip, lane);
  const Envelope envelope = envelopeOf(receivers, point, sides);
  trees::BoundItem item = placeOf(receivers.points[point], sides);
  item.cosine = envelope.diffuse;
  addGaussians(envelope, &item);
  const float diffuse = kPi * envelope.diffuse;
  float glossy = 0;
  for (int i = 0; i < envelope.count; ++i)
    glossy += envelope.gaussians[i].amplitude * lobes::integral(envelope.gaussians[i].sharpness);
  if (diffuse + glossy > 0)
    item.mean =
        (diffuse * envelope.diffuseMean + glossy * envelope.glossyMean) / (diffuse + glossy);
  return item;
}

ReceiverNodes receiverNodes(const Receivers& receivers, size_t point, const PointStrip& strip) {
  const Sides sides(strip, 0);
  const Envelope envelope = envelopeOf(receivers, point, sides);
  trees::BoundItem item = placeOf(receivers.points[point], sides);
  item.cosine = envelope.diffuse;
  item.mean = envelope.diffuseMean;
  ReceiverNodes nodes;
  nodes.cosine = trees::leafOf(item, 0);
  nodes.glossy = envelope.count > 0;
  if (!nodes.glossy) return nodes;
  item.cosine = 0;
  item.mean = envelope.glossyMean;
  addGaussians(envelope, &item);
  nodes.gaussians = trees::leafOf(item, 0);
  return nodes;
}

void NodeBounder::bound(const ReceiverNodes& receiver, uint32_t tree,
                        std::span<const uint32_t> nodes, NodeBound* bounds) {
  const LightForest::Tree& lights = forest_.trees[tree];
  evaluations_ += nodes.size();
  boundNodes(receiver.cosine, receiver.glossy ? &receiver.gaussians : nullptr, lights.tree.nodes(),
             nodes, lights.lightClass, bounds);
  if (!(clamp_ > 0) || !clampBounds(lights.lightClass)) return;
  for (size_t i = 0; i < nodes.size(); ++i) {
    const trees::BoundNode& node = lights.tree.nodes()[nodes[i]];
    // Of glossy lights, whose cosine lobe is 0, the sum of intensities.
    bounds[i].upper = std::min(bounds[i].upper, clamp_ * (node.cosine + node.peak));
  }
}

}  // namespace lobelia::gather
