#include "lobelia/trees/bound_node.h"

#include "lobelia/lights/virtual_lights.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia::trees {
namespace {

float powerOf(const BoundNode& node) { return kPi * node.cosine + node.energy; }

// Rounding of places and of octahedral axes is made up for by a little room.
constexpr float kRadiusRoom = 1.000002f, kAngleRoom = 2e-6f;

void setCone(const Cone& cone, uint32_t* axis, uint16_t* angle) {
  *axis = encodeOctahedral(cone.axis);
  *angle = codeOfAngle(cone.angle + angleBetween(decodeOctahedral(*axis), cone.axis) + kAngleRoom);
}

Cone coneOf(uint32_t axis, uint16_t angle) { return {decodeOctahedral(axis), angleOfCode(angle)}; }

// What merges alike on both sides. share: of b in the representative's place and normal.
BoundNode mergedShapes(const BoundNode& a, const BoundNode& b, float share) {
  BoundNode node;
  node.lo = min(a.lo, b.lo), node.hi = max(a.hi, b.hi);
  node.centre = a.centre + (b.centre - a.centre) * share;
  const float spheres = std::max(length(node.centre - a.centre) + a.radius,
                                 length(node.centre - b.centre) + b.radius);
  const float corner = length(max(node.hi - node.centre, node.centre - node.lo));
  node.radius = std::min(spheres, corner) * kRadiusRoom;
  setCone(merged(coneOf(a.normalAxis, a.normalAngle), coneOf(b.normalAxis, b.normalAngle)),
          &node.normalAxis, &node.normalAngle);
  const Vec3f n = decodeOctahedral(a.n) * (1 - share) + decodeOctahedral(b.n) * share;
  const float l = length(n);
  node.n = l > 1e-3f ? encodeOctahedral(n / l) : a.n;
  node.first = a.first;
  node.count = a.count + b.count;
  if (!(a.energy > 0) || !(b.energy > 0)) {
    const BoundNode& one = a.energy > 0 ? a : b;
    node.lobeAxis = one.lobeAxis, node.lobeAngle = one.lobeAngle;
    node.leastSharpness = one.leastSharpness, node.mostSharpness = one.mostSharpness;
    node.axis = one.axis, node.sharpness = one.sharpness;
    return node;
  }
  setCone(merged(coneOf(a.lobeAxis, a.lobeAngle), coneOf(b.lobeAxis, b.lobeAngle)), &node.lobeAxis,
          &node.lobeAngle);
  node.leastSharpness = std::min(a.leastSharpness, b.leastSharpness);
  node.mostSharpness = std::max(a.mostSharpness, b.mostSharpness);
  return node;
}

// The representative's Gaussian: energies by which the two count.
void mergeLobes(const BoundNode& a, float energyA, const BoundNode& b, float energyB,
                BoundNode* node) {
  if (!(a.energy > 0) || !(b.energy > 0)) return;
  lobes::Moment moment = lobes::momentOf(decodeOctahedral(a.axis), a.sharpness, energyA);
  moment.add(lobes::momentOf(decodeOctahedral(b.axis), b.sharpness, energyB));
  const lobes::SphericalGaussian lobe = lobes::lobeOf(moment);
  node->axis = encodeOctahedral(lobe.axis);
  node->sharpness = lobe.sharpness;
}

}  // namespace

uint16_t codeOfAngle(float angle) {
  if (angle >= kPi) return static_cast<uint16_t>(kAngleCodes);
  return static_cast<uint16_t>(std::min(std::ceil(std::sin(angle / 2) * kAngleCodes), kAngleCodes));
}

float angleOfCode(uint16_t code) {
  return 2 * std::asin(std::min(static_cast<float>(code) / kAngleCodes, 1.f));
}

BoundNode leafOf(const BoundItem& item, uint32_t place) {
  BoundNode node;
  node.lo = item.p - Vec3f(item.radius), node.hi = item.p + Vec3f(item.radius);
  node.centre = item.p;
  node.radius = item.radius;
  const bool sided = lengthSquared(item.n) > 0;
  const Vec3f n = sided ? item.n : Vec3f{0, 0, 1};
  setCone({n, sided ? 0 : kPi}, &node.normalAxis, &node.normalAngle);
  node.n = node.normalAxis;
  node.cosine = item.cosine;
  node.leastPeak = item.cosine * item.least;
  node.amount = item.cosine * item.mean;
  node.first = place;
  node.count = 1;
  if (item.gaussianCount == 0) return node;
  Cone axes{item.gaussians[0].axis, 0};
  node.leastSharpness = 3.4e38f;
  lobes::Moment moment;
  for (int i = 0; i < item.gaussianCount; ++i) {
    const BoundItem::Gaussian& g = item.gaussians[i];
    const float energy = g.amplitude * lobes::integral(g.sharpness);
    moment.add(lobes::momentOf(g.axis, g.sharpness, energy));
    axes = merged(axes, {g.axis, 0});
    node.leastSharpness = std::min(node.leastSharpness, g.sharpness);
    node.mostSharpness = std::max(node.mostSharpness, g.sharpness);
    node.peak += g.amplitude;
    node.energy += energy;
  }
  setCone(axes, &node.lobeAxis, &node.lobeAngle);
  if (item.gaussianCount == 1) {
    node.axis = node.lobeAxis;
    node.sharpness = item.gaussians[0].sharpness;
  } else if (moment.weight > 0) {
    const lobes::SphericalGaussian lobe = lobes::lobeOf(moment);
    node.axis = encodeOctahedral(lobe.axis);
    node.sharpness = lobe.sharpness;
  }
  node.leastPeak = node.peak * item.least;
  node.leastEnergy = node.energy * item.least;
  node.amount = node.energy * item.mean;
  return node;
}

BoundNode mergedLights(const BoundNode& a, const BoundNode& b) {
  const float total = powerOf(a) + powerOf(b);
  // Without power all places count alike.
  BoundNode node = mergedShapes(a, b, total > 0 ? powerOf(b) / total : 0.5f);
  node.cosine = a.cosine + b.cosine;
  node.peak = a.peak + b.peak;
  node.energy = a.energy + b.energy;
  node.leastPeak = a.leastPeak + b.leastPeak;
  node.leastEnergy = a.leastEnergy + b.leastEnergy;
  node.amount = a.amount + b.amount;
  mergeLobes(a, a.energy, b, b.energy, &node);
  return node;
}

BoundNode mergedReceivers(const BoundNode& a, const BoundNode& b) {
  const float share = static_cast<float>(b.count) / static_cast<float>(a.count + b.count);
  BoundNode node = mergedShapes(a, b, share);
  node.cosine = std::max(a.cosine, b.cosine);
  node.peak = std::max(a.peak, b.peak);
  node.energy = std::max(a.energy, b.energy);
  node.leastPeak = std::min(a.leastPeak, b.leastPeak);
  node.leastEnergy = std::min(a.leastEnergy, b.leastEnergy);
  node.amount = a.amount + share * (b.amount - a.amount);
  mergeLobes(a, (1 - share) * a.amount, b, share * b.amount, &node);
  return node;
}

}  // namespace lobelia::trees
