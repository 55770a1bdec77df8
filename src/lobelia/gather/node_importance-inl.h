// Estimate of what a node of a light tree contributes to receivers (cut_kernels.h): a node and a
// receiver per lane.
#if defined(LOBELIA_GATHER_NODE_IMPORTANCE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef LOBELIA_GATHER_NODE_IMPORTANCE_INL_H_
#undef LOBELIA_GATHER_NODE_IMPORTANCE_INL_H_
#else
#define LOBELIA_GATHER_NODE_IMPORTANCE_INL_H_
#endif

#include <algorithm>
#include <span>

#include "lobelia/gather/cut_receivers.h"
#include "lobelia/gather/facing-inl.h"
#include "lobelia/trees/light_tree.h"

LOBELIA_CORE_BEGIN

// trees::LightNode.
struct NodeLanes {
  V3<Vf> centre;
  Vf variance;
  V3<Vf> n;
  Vf diffuse;
  V3<Vf> axis;
  Vf sharpness, glossy, radius, count;
  Mf leaf;
  bool anyLeaf, anyDiffuse, anyGlossy;
};

// Nodes as structure of arrays, for a strip: lane i has node i % most.
class NodeTable {
 public:
  // most: a power of two, at most kStrip. Where there are fewer nodes, the last takes the place of
  // what is missing.
  HWY_INLINE void fill(std::span<const trees::LightNode* const> nodes, size_t most) {
    const auto rowOf = [&](size_t lane) {
      return reinterpret_cast<const float*>(nodes[std::min(lane & (most - 1), nodes.size() - 1)]);
    };
#if HWY_TARGET == HWY_SCALAR
    for (size_t lane = 0; lane < g::kStrip; ++lane)
      for (size_t i = 0; i < kFields; ++i) fields_[i][lane] = rowOf(lane)[i];
#else
    const size_t period = std::max(most, kBlock);
    for (size_t block = 0; block < period; block += kBlock) {
      const float* rows[kBlock];
      for (size_t i = 0; i < kBlock; ++i) rows[i] = rowOf(block + i);
      for (size_t field = 0; field < kFields; field += kBlock)
        transpose(rows, field, block, period);
    }
#endif
  }
  HWY_INLINE NodeLanes at(size_t lane) const {
    const auto field = [&](int i) { return Vf::load(fields_[i] + lane); };
    const auto vector = [&](int i) { return V3<Vf>{field(i), field(i + 1), field(i + 2)}; };
    const auto count = hn::BitCast(Di(), field(15).v);
    const Vf lights = hn::ConvertTo(Df(), count);
    const Mf leaf = lights == Vf(1.f);
    NodeLanes node{vector(0), field(3), vector(4), field(7),  vector(8), field(11), field(12),
                   field(13), lights,   leaf,      any(leaf), true,      true};
    node.anyDiffuse = any(node.diffuse > Vf(0.f));
    node.anyGlossy = any(node.glossy > Vf(0.f));
    return node;
  }

 private:
  static constexpr size_t kFields = sizeof(trees::LightNode) / sizeof(float);
  static_assert(kFields == 16);

#if HWY_TARGET != HWY_SCALAR
  static constexpr size_t kBlock = 4;

  // Four fields of four rows, to lanes `first`, first + period and so on.
  HWY_INLINE void transpose(const float* const* rows, size_t field, size_t first, size_t period) {
    const hn::Full128<float> d;
    const auto r0 = hn::LoadU(d, rows[0] + field), r1 = hn::LoadU(d, rows[1] + field);
    const auto r2 = hn::LoadU(d, rows[2] + field), r3 = hn::LoadU(d, rows[3] + field);
    const auto low02 = hn::InterleaveLower(d, r0, r2), low13 = hn::InterleaveLower(d, r1, r3);
    const auto high02 = hn::InterleaveUpper(d, r0, r2), high13 = hn::InterleaveUpper(d, r1, r3);
    for (size_t lane = first; lane < g::kStrip; lane += period) {
      hn::Store(hn::InterleaveLower(d, low02, low13), d, &fields_[field][lane]);
      hn::Store(hn::InterleaveUpper(d, low02, low13), d, &fields_[field + 1][lane]);
      hn::Store(hn::InterleaveLower(d, high02, high13), d, &fields_[field + 2][lane]);
      hn::Store(hn::InterleaveUpper(d, high02, high13), d, &fields_[field + 3][lane]);
    }
  }
#endif

  alignas(64) float fields_[kFields][g::kStrip];
};

// Radiant intensity times reflectance over squared distance, roughly: both ends' lobes widened by
// the angle at which the node's lights appear; times the receiver's weight and `scale`. 0 only
// where nothing is contributed. floor: CutSettings. relativeVariance: of what the node's lights
// contribute to one receiver, roughly; null: not asked for.
HWY_INLINE Vf nodeImportance(const NodeLanes& node, const g::CutReceivers& receivers, size_t lane,
                             Vf floor, Vf scale, Vf* relativeVariance) {
  constexpr float kLeastVariance = 0.02f;  // of visibility, and where the estimate is wrong
  const V3<Vf> n = load(receivers.n, lane);
  const V3<Vf> d = node.centre - load(receivers.p, lane);
  const Vf d2 = dot(d, d);
  const Vf variance = node.variance + Vf::load(receivers.variance + lane);
  const Vf square = d2 + variance + Vf(1e-20f);
  const Vf inverse = Vf(1.f) / square, inverseRoot = sqrt(inverse);
  const Vf height = dot(n, d);
  const Vf placeSlack = Vf::load(receivers.placeSlack + lane);
  const Vf reach = node.radius + placeSlack;
  // The root of `square` is no shorter than d.
  const Vf slack = reach + Vf::load(receivers.normalSlack + lane) * (square * inverseRoot + reach);
  const Vf above = Vf::load(receivers.above + lane), below = Vf::load(receivers.below + lane);
  Mf faces = ((height + slack) * above > Vf(0.f)) | ((height - slack) * below < Vf(0.f));
  if (node.anyLeaf) {
    const Mf oneSided = dot(node.n, node.n) > Vf(trees::kSpreadNormal * trees::kSpreadNormal);
    faces = faces & !(node.leaf & oneSided & (dot(node.n, d) > placeSlack));
  }
  if (relativeVariance != nullptr) *relativeVariance = Vf(0.f);
  if (!any(faces)) return Vf(0.f);

  const V3<Vf> w = d * inverseRoot;  // shorter than 1 where the node is wide
  const Vf wide = variance * inverse;
  // Cosine lobes of both ends: [c]+ where c is known to spread by about a root of `spread`.
  const Vf c = height * inverseRoot, spread = Vf(0.25f) * wide;
  const Vf root = sqrt(c * c + spread);
  const Vf diffuse = Vf::load(receivers.diffuse + lane);
  const Vf reflected = Vf(0.5f) * diffuse * (above * (root + c) + below * (root - c));
  Vf leaving(0.f);
  if (node.anyDiffuse) {
    const Vf disagreement = Vf(1.f) - dot(node.n, node.n) * (Vf(1.f) - wide);
    const Vf cosine = dot(node.n, w);
    leaving = Vf(0.5f) * node.diffuse *
              (sqrt(cosine * cosine + max(Vf(0.25f) * disagreement, Vf(0.f))) - cosine);
  }
  Vf total = leaving * reflected, slope(0.f);
  Vf light = leaving, lightPeak = node.diffuse, receiver = reflected, receiverPeak = diffuse;
  // The lights' Gaussian over the receivers' cosine.
  const Vf sharpness = node.sharpness;
  const Vf amplitude = node.glossy * Vf(0.5f / kPi) * (sharpness + Vf(0.5f));
  if (node.anyGlossy) {
    const Vf narrow = Vf(1.f) / (Vf(1.f) + sharpness * wide);
    const Vf peak = amplitude * narrow;
    const Vf widened = peak * exp(Vf(0.f) - sharpness * narrow * (dot(node.axis, w) + Vf(1.f)));
    light += widened;
    lightPeak += peak;
    const Vf part = widened * reflected;
    total += part;
    if (relativeVariance != nullptr) slope += part * sharpness;
  }
  for (size_t i = 0; i < receivers.gaussianCount; ++i) {
    const g::GaussianStrip& lobe = receivers.gaussians[i];
    const V3<Vf> axis = load(lobe.axis, lane);
    const Vf k = Vf::load(lobe.sharpness + lane), a = Vf::load(lobe.amplitude + lane);
    const Vf narrow = Vf(1.f) / (Vf(1.f) + k * wide);
    const Vf peak = a * narrow;
    const Vf widened = peak * exp(k * narrow * (dot(axis, w) - Vf(1.f)));
    receiver += widened;
    receiverPeak += peak;
    const Vf part = leaving * widened;
    total += part;
    if (relativeVariance != nullptr) slope += part * k;
    if (!node.anyGlossy) continue;
    // The product of both Gaussians is one, which the node's width widens.
    const V3<Vf> v = axis * k - node.axis * sharpness;
    const Vf length = sqrt(dot(v, v)), sum = max(length + sharpness + k, Vf(1e-20f));
    const V3<Vf> apart = axis + node.axis;
    const Vf widening = Vf(1.f) + length * wide;
    const Vf one = Vf(1.f) / (widening * sum);  // for two divisions
    const Vf narrower = sum * one;
    const Vf product =
        amplitude * a * narrower *
        exp(narrower * (dot(v, w) - length) - sharpness * k * dot(apart, apart) * widening * one);
    total += product;
    if (relativeVariance != nullptr) slope += product * length;
  }
  total += floor * (light * receiverPeak + lightPeak * (receiver + floor * receiverPeak));
  if (relativeVariance != nullptr) {
    // Within the node: by distance, and by the slopes of the lobes; among lights around the
    // receiver, the nearest may matter most.
    const Vf slopes = slope / max(total, Vf(1e-30f));
    const Vf among = max(wide + wide - Vf(1.f), Vf(0.f));
    *relativeVariance =
        min(Vf(kLeastVariance) + wide * (Vf(1.f) + slopes), Vf(1.f)) + among * among * node.count;
  }
  // gatheredShare(), at most, of a light of the node. Not 0: emitters that are points count whole.
  constexpr float kLeastShare = 0.02f;
  const Vf distance = square * inverseRoot + reach;
  const Vf share =
      min(max(distance * Vf::load(receivers.nearScale + lane) - Vf(1.f), Vf(kLeastShare)), Vf(1.f));
  total = total * share;
  const Vf weight = Vf::load(receivers.weight + lane) * scale;
  // Squares neither vanish nor overflow.
  const Vf value = min(max(weight * total * inverse, Vf(1e-18f)), Vf(1e18f));
  return select(faces & (weight > Vf(0.f)), value, Vf(0.f));
}

LOBELIA_CORE_END

#endif  // per-target include guard
