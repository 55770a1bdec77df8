// The emitter tree's way down: eight clusters are weighed at once. EmitterTree::importance() is the
// same for one, with the formulas' source.
#include <algorithm>
#include <bit>

#include "lobelia/path/emitter_tree_node.h"

#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lobelia/path/emitter_tree_kernels.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace lobelia {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, EmitterTreeNode::kWidth>;
using V = hn::Vec<Lanes>;

// The cosine and sine of an angle.
struct Angles {
  V cosine, sine;
};
HWY_INLINE V sineOf(V cosine) {
  const Lanes d;
  return hn::Sqrt(hn::Max(hn::Zero(d), hn::Sub(hn::Set(d, 1.f), hn::Mul(cosine, cosine))));
}
HWY_INLINE V minusCosine(Angles a, Angles b) {  // cos(max(0, a - b)) in [0, pi]
  const V difference = hn::Add(hn::Mul(a.cosine, b.cosine), hn::Mul(a.sine, b.sine));
  return hn::IfThenElse(hn::Ge(a.cosine, b.cosine), hn::Set(Lanes(), 1.f), difference);
}
HWY_INLINE Angles minus(Angles a, Angles b) {
  const V sine = hn::Sub(hn::Mul(a.sine, b.cosine), hn::Mul(a.cosine, b.sine));
  return {minusCosine(a, b), hn::IfThenZeroElse(hn::Ge(a.cosine, b.cosine), sine)};
}

template <class Integer>
HWY_INLINE V loadFixed(const Integer* from, float unit) {
  const Lanes d;
  const hn::Rebind<int32_t, Lanes> di;
  const auto loaded = hn::Load(hn::Rebind<Integer, Lanes>(), from);
  return hn::Mul(hn::ConvertTo(d, hn::PromoteTo(di, loaded)), hn::Set(d, unit));
}
HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
  return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
}

// weights: what is expected of each of the node's clusters; returns their sum.
HWY_INLINE double weigh(const EmitterTreeNode& node, Vec3f p, Vec3f n, float* weights) {
  const Lanes d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.f);
  const bool sided = n != Vec3f{};
  for (size_t i = 0; i < EmitterTreeNode::kWidth; i += hn::Lanes(d)) {
    const V x = hn::Sub(hn::Load(d, node.x + i), hn::Set(d, p.x));
    const V y = hn::Sub(hn::Load(d, node.y + i), hn::Set(d, p.y));
    const V z = hn::Sub(hn::Load(d, node.z + i), hn::Set(d, p.z));
    const V radius = hn::Load(d, node.radius + i), radius2 = hn::Mul(radius, radius);
    const V intensity = hn::Load(d, node.intensity + i);
    const V d2 = dot(x, y, z, x, y, z);
    const auto inside = hn::Le(d2, radius2);
    const V inverse2 = hn::Div(one, hn::Max(hn::Max(d2, radius2), hn::Set(d, 1e-30f)));
    const V inverse = hn::Sqrt(inverse2);
    const V sinBox = hn::Min(hn::Mul(radius, inverse), one);
    const Angles box{sineOf(sinBox), sinBox};
    V far = one;
    {
      const V cosO = loadFixed(node.cosThetaO + i, 1 / 127.f);
      const V cosE = loadFixed(node.cosThetaE + i, 1 / 127.f);
      const V along = hn::Neg(hn::Mul(
          dot(loadFixed(node.axisX + i, 1 / 32767.f), loadFixed(node.axisY + i, 1 / 32767.f),
              loadFixed(node.axisZ + i, 1 / 32767.f), x, y, z),
          inverse));
      const V least = hn::Set(d, kLeastCosine);
      const V leaving = minusCosine(minus({along, sineOf(along)}, {cosO, sineOf(cosO)}), box);
      const V sent =
          hn::IfThenZeroElse(hn::Le(leaving, hn::Sub(cosE, least)), hn::Max(leaving, least));
      far = hn::IfThenElse(hn::Gt(cosO, hn::Set(d, -0.999f)), sent, one);
    }
    if (sided) {
      const V along =
          hn::Mul(dot(hn::Set(d, n.x), hn::Set(d, n.y), hn::Set(d, n.z), x, y, z), inverse);
      far = hn::Mul(far, hn::Max(zero, minusCosine({along, sineOf(along)}, box)));
    }
    hn::Store(hn::Mul(hn::Mul(intensity, inverse2), hn::IfThenElse(inside, one, far)), d,
              weights + i);
  }
  double sum = 0;
  for (int i = 0; i < EmitterTreeNode::kWidth; ++i) sum += static_cast<double>(weights[i]);
  return sum;
}

EmitterTreeChoice sample(const EmitterTreeNode* nodes, Vec3f p, Vec3f n, double u) {
  HWY_ALIGN float weights[EmitterTreeNode::kWidth];
  double probability = 1;
  for (uint32_t node = 0;;) {
    const double sum = weigh(nodes[node], p, n, weights);
    if (!(sum > 0)) return {};
    // The last with a weight catches what rounding leaves over.
    double target = u * sum, weight = 0;
    int chosen = 0;
    for (int i = 0; i < EmitterTreeNode::kWidth; ++i) {
      const double w = static_cast<double>(weights[i]);
      if (!(w > 0)) continue;
      target -= weight;
      chosen = i, weight = w;
      if (target < w) break;
    }
    u = std::clamp(target / weight, 0.0, 0x1.fffffffffffffp-1);
    probability *= weight / sum;
    const uint32_t next = nodes[node].next[chosen];
    if (next & EmitterTreeNode::kLeafBit)
      return {next & ~EmitterTreeNode::kLeafBit, static_cast<float>(probability)};
    node = next;
  }
}

float probability(const EmitterTreeNode* nodes, Vec3f p, Vec3f n, uint64_t slots) {
  HWY_ALIGN float weights[EmitterTreeNode::kWidth];
  double result = 1;
  uint32_t node = 0;
  for (int bits = static_cast<int>(std::bit_width(slots)) - 1; bits > 0;) {
    bits -= EmitterTreeNode::kBits;
    const auto slot = (slots >> bits) & (EmitterTreeNode::kWidth - 1);
    const double sum = weigh(nodes[node], p, n, weights);
    if (!(weights[slot] > 0)) return 0;
    result *= static_cast<double>(weights[slot]) / sum;
    node = nodes[node].next[slot];
  }
  return static_cast<float>(result);
}

}  // namespace HWY_NAMESPACE
}  // namespace lobelia
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lobelia {
namespace {
HWY_EXPORT(sample);
HWY_EXPORT(probability);
}  // namespace

EmitterTreeChoice sampleEmitterTree(const EmitterTreeNode* nodes, Vec3f p, Vec3f n, double u) {
  return HWY_DYNAMIC_DISPATCH(sample)(nodes, p, n, u);
}
float emitterTreeProbability(const EmitterTreeNode* nodes, Vec3f p, Vec3f n, uint64_t slots) {
  return HWY_DYNAMIC_DISPATCH(probability)(nodes, p, n, slots);
}

}  // namespace lobelia
#endif
