// Bounds of pairs of nodes against all pairs of their items, in double precision.
#include "lobelia/gather/node_bounds.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>

#include "gather/oracle.h"
#include "lobelia/base/parallel.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

using namespace gather;
using namespace test;
using trees::BoundItem;
using trees::BoundNode;

// How alike the items of a node are: sizes over the distance, angles, largest ratio of sharpness.
struct Level {
  const char* name;
  float size, angle, ratio;
};
constexpr Level kDeep{"deep", 0.02f, 0.0524f, 1.69f}, kMiddle{"middle", 0.1f, 0.209f, 9.f},
    kTop{"top", 0.35f, 0.698f, 100.f}, kMeeting{"meeting", 1.5f, 3.f, 1000.f};

Vec3f near(Vec3f axis, float angle, Rng* rng) {
  const Frame frame = frameFromNormal(axis);
  const float a = angle * std::sqrt(rng->next1D()), phi = kTwoPi * rng->next1D();
  return frame.toWorld({std::sin(a) * std::cos(phi), std::sin(a) * std::sin(phi), std::cos(a)});
}

double gaussianIn(const BoundItem::Gaussian& g, Vec3d w) {
  return double{g.amplitude} *
         std::exp(-0.5 * double{g.sharpness} * lengthSquared(toDouble(g.axis) - w));
}

constexpr int kItems = 3, kConeSamples = 5;

// Of saturated ones, mostly.
Rgb randomHue(Rng* rng) {
  const Rgb c = randomColor(rng);
  return c * c * c;
}

// Two clusters of items, lights of one class and receivers of one kind.
struct Clusters {
  LightClass lightClass = LightClass::diffuse;
  bool glossy = false;
  std::array<BoundItem, kItems> receivers, lights;  // without their colours
  std::array<Rgb, kItems> receiverColors, lightColors;
  uint64_t seed = 0;
  BoundNode p, q;

  static double lobe(const BoundItem& item, Vec3d w) {
    const double c = dot(toDouble(item.n), w);
    double sum = double{item.cosine} * std::max(c, 0.0);
    if (c > 0 || lengthSquared(item.n) == 0)
      for (int i = 0; i < item.gaussianCount; ++i) sum += gaussianIn(item.gaussians[i], w);
    return sum;
  }
  // Mean over directions to the sphere times its solid angle over its disc's area.
  static double sphere(const BoundItem& x, const BoundItem& y, Rng* rng) {
    const Vec3d d = toDouble(y.p) - toDouble(x.p);
    const double sine = double{y.radius} / length(d);
    if (sine >= 1) return 0;  // inside: no bound is asked for
    const double cosine = std::sqrt(1 - sine * sine);
    const Frame frame = frameFromNormal(toFloat(normalize(d)));
    double sum = 0;
    for (int i = 0; i < kConeSamples; ++i) {
      const double c = 1 - (1 - cosine) * double{rng->next1D()};
      const float s = static_cast<float>(std::sqrt(1 - c * c)), phi = kTwoPi * rng->next1D();
      const Vec3d w = normalize(
          toDouble(frame.toWorld({s * std::cos(phi), s * std::sin(phi), static_cast<float>(c)})));
      sum += lobe(y, Vec3d(0.0) - w) * lobe(x, w) / kConeSamples;
    }
    return sum * 2 / (1 + cosine) / lengthSquared(d);
  }
  double light(const BoundItem& x, const BoundItem& y, Rng* rng) const {
    if (lightClass == LightClass::spherical) return sphere(x, y, rng);
    if (lightClass == LightClass::directional)
      return double{y.cosine} * lobe(x, normalize(toDouble(y.gaussians[0].axis)));
    const Vec3d d = toDouble(y.p) - toDouble(x.p);
    const Vec3d w = normalize(d);
    const double leaving =
        lightClass == LightClass::omni ? double{y.cosine} : lobe(y, Vec3d(0.0) - w);
    return leaving * lobe(x, w) / lengthSquared(d);
  }
  double light(size_t x) const {
    Rng rng(seed, x);
    double sum = 0;
    for (size_t y = 0; y < kItems; ++y)
      sum += light(receivers[x], lights[y], &rng) *
             double{luminance(receiverColors[x] * lightColors[y])};
    return sum;
  }
  BoundItem light(uint32_t i) const {
    BoundItem item = lights[i];
    scale(luminance(lightColors[i]), &item);
    return item;
  }
  BoundItem receiver(uint32_t i) const {
    BoundItem item = receivers[i];
    const Rgb color = receiverColors[i];
    scale(maxComponent(color), &item);
    item.mean = luminance(color) / maxComponent(color);
    item.least = minComponent(color) / maxComponent(color);
    return item;
  }
  void merge() {
    const auto x = [&](uint32_t i) { return leafOf(receiver(i), i); };
    const auto y = [&](uint32_t i) { return leafOf(light(i), i); };
    p = mergedReceivers(mergedReceivers(x(0), x(1)), x(2));
    q = mergedLights(mergedLights(y(0), y(1)), y(2));
  }

 private:
  static void scale(float by, BoundItem* item) {
    item->cosine *= by;
    for (BoundItem::Gaussian& g : item->gaussians) g.amplitude *= by;
  }
};

void addGaussian(Vec3f axis, float sharpness, float amplitude, BoundItem* item) {
  item->gaussians[item->gaussianCount++] = {axis, sharpness, amplitude};
}

// Items about `centre`, turned more or less to where the others are.
std::array<BoundItem, kItems> randomItems(const Level& most, Vec3f centre, Vec3f towards,
                                          bool gaussian, int gaussians, Rng* rng) {
  std::array<BoundItem, kItems> items;
  const Level level{"", most.size * rng->next1D(), most.angle * rng->next1D(),
                    std::pow(most.ratio, rng->next1D())};
  const Vec3f normal = near(towards, 1.3f, rng);
  const float sharpness = std::pow(300.f, rng->next1D());
  const Vec3f axis = near(towards, 1.f / std::sqrt(sharpness) + 0.5f * level.angle, rng);
  for (BoundItem& item : items) {
    item.p = centre + randomPoint(rng, 0.577f * level.size);
    item.n = near(normal, level.angle, rng);
    const float amount = 0.2f + rng->next1D();
    if (!gaussian) {
      item.cosine = amount;
      continue;
    }
    for (int i = 0; i < gaussians; ++i) {
      const float k = sharpness * std::pow(level.ratio, rng->next1D() - 0.5f);
      addGaussian(near(axis, level.angle, rng), k, amount / lobes::integral(k), &item);
    }
  }
  return items;
}

Clusters randomClusters(const Level& level, LightClass lightClass, bool glossy, bool colored,
                        Rng* rng) {
  Clusters c;
  c.seed = rng->nextUint();
  c.lightClass = lightClass;
  c.glossy = glossy;
  const Vec3f w = randomDirection(rng);
  const int gaussians = 1 + static_cast<int>(2 * rng->next1D());
  c.receivers = randomItems(level, {}, w, glossy, gaussians, rng);
  c.lights = randomItems(level, w, -w, lightClass == LightClass::glossy, 1, rng);
  if (lightClass == LightClass::omni)
    for (BoundItem& item : c.lights) item.n = {};
  if (lightClass == LightClass::directional) {
    for (BoundItem& item : c.lights) {
      item.n = item.p = {};
      addGaussian(near(w, level.angle, rng), 1, item.cosine, &item);
    }
  }
  if (lightClass == LightClass::spherical) {
    const bool sided = rng->next1D() < 0.7f;
    const float radius = level.size * rng->next1D();
    const std::array<BoundItem, kItems> gaussianToo =
        randomItems(level, w, -w, true, sided ? gaussians - 1 : gaussians, rng);
    for (size_t i = 0; i < kItems; ++i) {
      BoundItem& item = c.lights[i];
      item.radius = radius * (0.5f + rng->next1D());
      item.gaussianCount = gaussianToo[i].gaussianCount;
      std::copy_n(gaussianToo[i].gaussians, 2, item.gaussians);
      if (!sided) item.n = {}, item.cosine = 0;
    }
  }
  c.receiverColors.fill(Rgb(1.f)), c.lightColors.fill(Rgb(1.f));
  for (size_t i = 0; colored && i < kItems; ++i)
    c.receiverColors[i] = randomHue(rng), c.lightColors[i] = randomHue(rng);
  c.merge();
  return c;
}

struct Pairing {
  const char* name;
  LightClass lightClass;
  bool glossy;
  // What the median of upper bound over largest value may be, by level (deep, middle, top).
  float median[3];
};

void PrintTo(const Pairing& pairing, std::ostream* out) { *out << pairing.name; }

class NodeBounds : public testing::TestWithParam<Pairing> {
 protected:
  static Clusters draw(const Level& level, size_t i, bool colored = false) {
    Rng rng(i, static_cast<uint64_t>(level.size * 1000));
    return randomClusters(level, GetParam().lightClass, GetParam().glossy, colored, &rng);
  }
  static PairBounds bound(const Clusters& c, BoundForm form) {
    return boundPair({&c.p, &c.q}, c.lightClass, c.glossy, form);
  }
  // Middle of bound over largest value where that is at least 1 % of the product of both sides'
  // powers (0.01 % of cosine lobes).
  float medianOverLargest(const Level& level, BoundForm form) const {
    std::vector<double> ratios;
    for (size_t i = 0; i < 6000; ++i) {
      const Clusters c = draw(level, i);
      double largest = 0;
      for (size_t x = 0; x < kItems; ++x) largest = std::max(largest, c.light(x));
      const auto power = [](const BoundNode& node) {
        return double{node.energy} + kPi * double{node.cosine};
      };
      const bool cosines = !c.glossy && c.lightClass != LightClass::glossy;
      if (largest < (cosines ? 1e-4 : 1e-2) * power(c.p) * power(c.q)) continue;
      ratios.push_back(double{bound(c, form).upper} / largest);
    }
    EXPECT_GT(ratios.size(), 1000u) << level.name;
    std::nth_element(ratios.begin(), ratios.begin() + static_cast<long>(ratios.size() / 2),
                     ratios.end());
    return static_cast<float>(ratios[ratios.size() / 2]);
  }
};

// 10^5 pairs of nodes of every colour, of which a quarter meet and face every way.
TEST_P(NodeBounds, HoldEverywhere) {
  std::atomic<size_t> outside{0}, looser{0}, lit{0};
  parallelFor(100000, 256, [&](size_t i) {
    const Level level = std::array{kDeep, kMiddle, kTop, kMeeting}[i % 4];
    const Clusters c = draw(level, i, true);
    const PairBounds tight = bound(c, BoundForm::tight), wide = bound(c, BoundForm::corrected);
    for (size_t x = 0; x < kItems; ++x) {
      const double value = c.light(x);
      const double least = value + 1e-35, most = value - 1e-35;  // what floats do not hold
      if (!(most <= double{tight.upper} && least >= double{tight.lower})) ++outside;
      if (!(most <= double{wide.upper} && least >= double{wide.lower})) ++outside;
      if (value > 0) ++lit;
    }
    if (!std::isfinite(tight.value)) ++outside;
    if (tight.upper > wide.upper * 1.0001f || tight.lower < wide.lower * 0.9999f) ++looser;
  });
  EXPECT_EQ(outside, 0u);
  EXPECT_EQ(looser, 0u);
  EXPECT_GT(lit, 30000u);
}

TEST_P(NodeBounds, SayMuchOfNodesThatAreAlike) {
  const Level* levels[] = {&kDeep, &kMiddle, &kTop};
  for (int i = 0; i < 3; ++i) {
    const float tight = medianOverLargest(*levels[i], BoundForm::tight);
    const float corrected = medianOverLargest(*levels[i], BoundForm::corrected);
    EXPECT_LT(tight, GetParam().median[i]) << levels[i]->name;
    EXPECT_GE(corrected, tight);
    EXPECT_GE(tight, 1.f);
  }
}

TEST_P(NodeBounds, RegistersAreAsScalarCode) {
  constexpr size_t kCount = 1003;
  std::vector<Clusters> clusters;
  std::vector<NodePair> pairs;
  for (size_t i = 0; i < kCount; ++i) clusters.push_back(draw(i % 2 ? kMiddle : kTop, i));
  for (const Clusters& c : clusters) pairs.push_back({&c.p, &c.q});
  std::vector<PairBounds> bounds(kCount);
  boundPairs(pairs, GetParam().lightClass, GetParam().glossy, BoundForm::tight, bounds.data());
  for (size_t i = 0; i < kCount; ++i) {
    const PairBounds one = bound(clusters[i], BoundForm::tight);
    EXPECT_NEAR(bounds[i].value, one.value, 1e-4f * one.value + 1e-20f) << i;
    EXPECT_NEAR(bounds[i].upper, one.upper, 1e-4f * one.upper + 1e-20f) << i;
    EXPECT_NEAR(bounds[i].lower, one.lower, 1e-4f * one.lower + 1e-20f) << i;
  }
}

// Of single items the bounds and the representatives' value are the value itself.
TEST_P(NodeBounds, OfSingleItemsAreTheirValue) {
  if (GetParam().lightClass == LightClass::spherical) return;  // whose value is an integral
  for (size_t i = 0; i < 200; ++i) {
    const Clusters c = draw(kTop, i);
    if (c.receivers[0].gaussianCount > 1) continue;
    const BoundNode p = leafOf(c.receivers[0], 0), q = leafOf(c.lights[0], 0);
    Rng unused(0);
    const float value = static_cast<float>(c.light(c.receivers[0], c.lights[0], &unused));
    const PairBounds b = boundPair({&p, &q}, c.lightClass, c.glossy, BoundForm::tight);
    EXPECT_LE(b.lower, value) << i;
    EXPECT_GE(b.upper, value) << i;
    EXPECT_NEAR(b.value, value, 0.05f * value + 1e-3f) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Pairings, NodeBounds,
    testing::Values(Pairing{"dd", LightClass::diffuse, false, {1.11f, 1.5f, 2.9f}},
                    Pairing{"ds", LightClass::diffuse, true, {1.33f, 2.4f, 9}},
                    Pairing{"sd", LightClass::glossy, false, {1.39f, 2.4f, 8}},
                    Pairing{"ss", LightClass::glossy, true, {1.6f, 3.2f, 25}},
                    Pairing{"omni_d", LightClass::omni, false, {1.11f, 1.5f, 2.9f}},
                    Pairing{"omni_s", LightClass::omni, true, {1.33f, 2.4f, 9}},
                    Pairing{"directional_d", LightClass::directional, false, {1.11f, 1.5f, 2.9f}},
                    Pairing{"directional_s", LightClass::directional, true, {1.33f, 2.4f, 9}},
                    Pairing{"spherical_d", LightClass::spherical, false, {5, 10, 50}},
                    Pairing{"spherical_s", LightClass::spherical, true, {5, 10, 80}}),
    [](const auto& pairing) { return std::string(pairing.param.name); });

}  // namespace
}  // namespace lobelia
