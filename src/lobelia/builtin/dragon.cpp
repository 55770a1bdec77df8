// A dragon: a scaly body along one curve from tail to neck, with what a dragon needs.
#include <cmath>

#include "lobelia/builtin/creatures.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/sculpture.h"
#include "lobelia/builtin/sweep.h"

namespace lobelia::builtin {
namespace {

// From the tip of the tail to the back of the head, with radii.
const std::vector<Vec3f> kSpine{
    {0.22f, 0.07f, 0.66f},   {0.62f, 0.06f, 0.60f},   {1.00f, 0.08f, 0.32f}, {1.02f, 0.13f, -0.10f},
    {0.76f, 0.24f, -0.20f},  {0.44f, 0.40f, -0.05f},  {0.10f, 0.45f, 0.05f}, {-0.22f, 0.50f, 0.02f},
    {-0.50f, 0.68f, -0.03f}, {-0.58f, 0.94f, -0.01f}, {-0.44f, 1.17f, 0},    {-0.54f, 1.36f, 0}};
const std::vector<float> kRadii{0.012f, 0.04f, 0.065f, 0.09f,  0.125f, 0.19f,
                                0.205f, 0.20f, 0.145f, 0.105f, 0.09f,  0.085f};

void addWings(Sculpture& s, float skin) {
  const size_t first = s.partCount();
  const Vec3f shoulder{-0.12f, 0.60f, 0.10f}, elbow{0.06f, 0.98f, 0.30f},
      wrist{-0.10f, 1.30f, 0.46f};
  const std::vector<Vec3f> tips{
      {0.62f, 1.56f, 0.66f}, {0.86f, 1.18f, 0.60f}, {0.80f, 0.80f, 0.46f}, {0.46f, 0.58f, 0.20f}};
  for (size_t i = 0; i + 1 < tips.size(); ++i) {
    s.sheet(wrist, tips[i], tips[i + 1], skin, 0.01f);
  }
  s.sheet(wrist, tips.back(), shoulder, skin, 0.01f);
  // The skin hangs in arcs between the fingers.
  for (size_t i = 0; i + 1 < tips.size(); ++i) {
    const Vec3f middle = (tips[i] + tips[i + 1]) * 0.5f;
    const float across = length(tips[i] - tips[i + 1]);
    s.ball(middle + normalize(middle - wrist) * (0.28f * across), 0.44f * across, 0.01f).carved =
        true;
  }
  for (const Vec3f tip : tips) {
    const Vec3f middle = (wrist + tip) * 0.5f + Vec3f(0, 0.07f, 0.03f);
    s.chain({wrist, middle, tip}, {0.034f, 0.024f, 0.008f}, 5, 0.02f);
  }
  s.chain({shoulder, elbow, wrist}, {0.085f, 0.055f, 0.042f}, 6, 0.06f);
  s.cone(wrist, wrist + Vec3f(-0.10f, 0.12f, 0.02f), 0.035f, 0.004f, 0.03f);
  s.mirror(first, 2);
}

void addFoot(Sculpture& s, Vec3f ankle, Vec3f ahead) {
  for (int i = -1; i <= 1; ++i) {
    const float angle = 0.5f * static_cast<float>(i);
    const Vec3f out{ahead.x * std::cos(angle) - ahead.z * std::sin(angle), 0,
                    ahead.x * std::sin(angle) + ahead.z * std::cos(angle)};
    Vec3f toe = ankle + out * 0.11f;
    toe.y = 0.045f;
    s.cone(ankle, toe, 0.05f, 0.036f, 0.035f);
    s.cone(toe + Vec3f(0, 0.015f, 0), toe + out * 0.085f - Vec3f(0, 0.03f, 0), 0.026f, 0.004f,
           0.01f);
  }
}

void addLegs(Sculpture& s) {
  const size_t first = s.partCount();
  s.chain(
      {{0.44f, 0.40f, 0.10f}, {0.22f, 0.30f, 0.31f}, {0.46f, 0.15f, 0.34f}, {0.32f, 0.06f, 0.35f}},
      {0.17f, 0.115f, 0.065f, 0.05f}, 6, 0.10f, 18, 0.11f);
  addFoot(s, {0.32f, 0.06f, 0.35f}, normalize(Vec3f(-1, 0, 0.25f)));
  s.chain({{-0.24f, 0.50f, 0.10f},
           {-0.14f, 0.31f, 0.29f},
           {-0.36f, 0.16f, 0.29f},
           {-0.40f, 0.06f, 0.28f}},
          {0.13f, 0.085f, 0.055f, 0.045f}, 6, 0.09f, 18, 0.11f);
  addFoot(s, {-0.40f, 0.06f, 0.28f}, normalize(Vec3f(-1, 0, 0.2f)));
  s.mirror(first, 2);
}

void addSpikes(Sculpture& s) {
  const Curve spine = smoothCurve3(kSpine);
  constexpr int kCount = 44;
  for (int i = 2; i < kCount; ++i) {
    const float t = fraction(i, kCount), at = t * static_cast<float>(kRadii.size() - 1);
    const auto k = static_cast<size_t>(at);
    const float radius = lerp(kRadii[k], kRadii[k + 1], at - static_cast<float>(k));
    const Vec3f p = spine(t), along = normalize(spine(t + 0.005f) - spine(t - 0.005f));
    // Towards the back: up on the body, away from the curve's inside on the neck.
    const Vec3f back = normalize(Vec3f(along.y > 0.6f ? 0.9f : 0.f, 1, 0));
    const Vec3f up = normalize(back - along * dot(back, along));
    const float height = 0.35f * radius + 0.045f;
    s.cone(p + up * (0.9f * radius), p + up * (radius + height) - along * (0.6f * height),
           0.40f * height, 0.004f, 0.02f);
  }
}

void addHead(Sculpture& s) {
  s.ellipsoid({-0.60f, 1.42f, 0}, {0.15f, 0.11f, 0.115f}, 0.07f, {0, 0, 12});
  s.cone({-0.64f, 1.42f, 0}, {-0.92f, 1.36f, 0}, 0.085f, 0.052f, 0.06f);  // snout
  s.cone({-0.60f, 1.34f, 0}, {-0.84f, 1.22f, 0}, 0.055f, 0.030f, 0.03f);  // jaw
  s.chain({{-0.66f, 1.29f, 0}, {-0.80f, 1.27f, 0}, {-0.90f, 1.24f, 0}}, {0.03f, 0.022f, 0.004f}, 4,
          0.01f);                                                         // tongue
  s.cone({-0.82f, 1.20f, 0}, {-0.80f, 1.09f, 0}, 0.024f, 0.004f, 0.03f);  // beard
  s.cone({-0.90f, 1.40f, 0}, {-0.88f, 1.47f, 0}, 0.026f, 0.004f, 0.02f);  // horn on the nose
  const size_t first = s.partCount();
  s.ball({-0.955f, 1.385f, 0.035f}, 0.018f, 0.02f).carved = true;  // nostril
  s.ball({-0.71f, 1.455f, 0.088f}, 0.036f, 0.02f).carved = true;   // eye
  s.ball({-0.705f, 1.452f, 0.080f}, 0.034f, 0.004f);
  s.cone({-0.78f, 1.47f, 0.070f}, {-0.62f, 1.52f, 0.100f}, 0.020f, 0.026f, 0.025f);  // brow
  s.chain({{-0.54f, 1.49f, 0.06f},
           {-0.36f, 1.57f, 0.13f},
           {-0.18f, 1.55f, 0.19f},
           {-0.06f, 1.66f, 0.20f}},
          {0.042f, 0.034f, 0.022f, 0.004f}, 5, 0.03f, 0, 0);  // horn
  for (int i = 0; i < 3; ++i) {                               // fringe of the cheek
    const float f = static_cast<float>(i);
    s.cone({-0.56f, 1.42f - 0.045f * f, 0.09f}, {-0.40f - 0.02f * f, 1.40f - 0.085f * f, 0.17f},
           0.028f, 0.004f, 0.02f);
  }
  for (int i = 0; i < 4; ++i) {  // teeth
    const float f = static_cast<float>(i);
    const Vec3f gum{-0.92f + 0.055f * f, 1.325f + 0.004f * f, 0.030f + 0.007f * f};
    s.cone(gum, gum - Vec3f(0, 0.055f - 0.008f * f, 0), 0.013f, 0.003f, 0.004f);
  }
  s.mirror(first, 2);
}

}  // namespace

Mesh dragonStatue(int cells, float skin) {
  Sculpture s;
  addWings(s, skin);  // first: what is carved from the skin leaves the body alone
  s.chain(kSpine, kRadii, 8, 0.08f, 28, 0.11f);
  addLegs(s);
  addSpikes(s);
  addHead(s);
  s.standOn(0);
  return s.mesh(cells);
}

}  // namespace lobelia::builtin
