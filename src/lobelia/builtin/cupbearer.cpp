// A cupbearer in a long dress, after what the statue of [P004 figure 9] stands for: folds on folds,
// a free cloth, limbs away from the body, so that shadows have many scales. Metres.
#include "lobelia/builtin/cupbearer.h"

#include <cmath>

#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/noise.h"
#include "lobelia/builtin/sculpture.h"

namespace lobelia::builtin {
namespace {

// A fold's own random number, 0 to 1.
float chance(int fold, int which) { return cellRandom(fold, which, 11); }

// A point of the body's outline: half axes of an ellipse around (x, y, z).
struct Girth {
  Vec3f centre;
  float halfX, halfZ;
  Vec3f at(float angle, float out) const {
    return centre + Vec3f(std::sin(angle) * (halfX + out), 0, std::cos(angle) * (halfZ + out));
  }
};

// The weight is on the right leg (-x); the left knee comes forward.
const Girth kBelt{{0.005f, 1.13f, 0.005f}, 0.118f, 0.092f},
    kHips{{-0.015f, 0.94f, 0}, 0.172f, 0.128f}, kThighs{{0, 0.72f, 0.02f}, 0.178f, 0.145f},
    kKnees{{0.01f, 0.46f, 0.02f}, 0.165f, 0.145f}, kShins{{0.01f, 0.24f, 0}, 0.185f, 0.165f},
    kHem{{0.01f, 0.03f, 0}, 0.235f, 0.215f}, kRibs{{0, 1.24f, -0.005f}, 0.135f, 0.095f};

// The body under the cloth, without hollows.
void addBody(Sculpture& s) {
  const Girth girths[] = {kHem, kShins, kKnees, kThighs, kHips, kBelt, kRibs};
  constexpr int kSteps = 3;
  constexpr float kUnder = 0.020f;  // folds' middles are further out
  for (size_t i = 0; i + 1 < std::size(girths); ++i)
    for (int k = 0; k <= kSteps; ++k) {
      const float t = fraction(k, kSteps);
      const Girth &a = girths[i], &b = girths[i + 1];
      s.ellipsoid(lerp(a.centre, b.centre, t),
                  {lerp(a.halfX, b.halfX, t) - kUnder, 0.09f, lerp(a.halfZ, b.halfZ, t) - kUnder},
                  0.02f);
    }
}

void addDress(Sculpture& s) {
  s.chain({{0.075f, 0.92f, 0.03f}, {0.085f, 0.56f, 0.135f}, {0.09f, 0.10f, 0.07f}},
          {0.10f, 0.078f, 0.06f}, 5, 0.03f);  // the free leg
  constexpr int kFolds = 34;
  for (int i = 0; i < kFolds; ++i) {
    const float turn = kTwoPi * (fraction(i, kFolds) + 0.016f * (chance(i, 0) - 0.5f));
    // Over the free thigh the cloth is stretched: folds are shallow there.
    const float thigh = std::exp(-sqr((turn - 0.55f) / 0.35f));
    const float out = 0.012f * (chance(i, 1) - 0.6f), width = 0.017f + 0.012f * chance(i, 2);
    const float drift = 0.16f * std::sin(turn + 0.7f);
    s.chain({kBelt.at(turn, -0.01f), kHips.at(turn, out), kThighs.at(turn + 0.3f * drift, out),
             kKnees.at(turn + 0.6f * drift, out - 0.01f * thigh),
             kShins.at(turn + drift, 1.5f * out), kHem.at(turn + drift, 2 * out)},
            {0.006f, 0.6f * width, width * (1 - 0.6f * thigh), width, 1.15f * width, 1.3f * width},
            3, 0.012f);
  }
}

// A second layer that hangs over the belt and ends in a zigzag above the knees.
void addOverfold(Sculpture& s) {
  constexpr int kFolds = 30;
  for (int i = 0; i < kFolds; ++i) {
    const float turn = kTwoPi * (fraction(i, kFolds) + 0.02f * (chance(i, 3) - 0.5f));
    const float low = 0.81f + 0.012f * (i % 2 == 0 ? 1.f : -1.f) + 0.05f * std::sin(3 * turn);
    const float ridge = i % 2 == 0 ? 0.010f : 0.f;
    Girth end = kHips;
    end.centre.y = low;
    s.chain({kBelt.at(turn, 0.004f), kHips.at(turn, 0.016f + ridge),
             end.at(turn + 0.05f, 0.030f + 2 * ridge)},
            {0.012f, 0.020f, 0.021f + 0.006f * chance(i, 4)}, 4, 0.012f);
  }
  constexpr int kCord = 40;
  for (int i = 0; i < kCord; ++i) {  // the belt, a twisted cord
    const float a = kTwoPi * fraction(i, kCord), b = a + kTwoPi * 1.4f / kCord;
    s.cone(kBelt.at(a, 0.018f) - Vec3f(0, 0.009f, 0), kBelt.at(b, 0.018f) + Vec3f(0, 0.009f, 0),
           0.0085f, 0.0085f, 0.003f);
  }
}

void addChest(Sculpture& s) {
  s.ellipsoid({0, 1.27f, -0.005f}, {0.142f, 0.17f, 0.098f}, 0.03f);
  s.chain({{-0.165f, 1.405f, -0.01f}, {0, 1.43f, -0.015f}, {0.165f, 1.405f, -0.01f}},
          {0.055f, 0.06f, 0.055f}, 4, 0.03f);
  const size_t first = s.partCount();
  s.ball({0.068f, 1.275f, 0.068f}, 0.056f, 0.03f);
  for (int i = 0; i < 5; ++i) {  // the dress hangs between the shoulders
    const float f = static_cast<float>(i);
    s.chain({{0.135f - 0.012f * f, 1.435f, 0.03f},
             {0.095f - 0.012f * f, 1.345f - 0.014f * f, 0.098f},
             {0.040f - 0.004f * f, 1.285f - 0.026f * f, 0.112f},
             {0, 1.265f - 0.029f * f, 0.108f}},
            {0.009f, 0.009f, 0.008f, 0.008f}, 5, 0.012f);
  }
  for (int i = 0; i < 6; ++i) {  // and falls from the breast to the belt
    const float turn = 0.12f + 0.26f * static_cast<float>(i);
    const Girth under{{0, 1.21f, 0}, 0.128f, 0.105f};
    s.chain({under.at(turn, 0.004f), kBelt.at(turn - 0.03f, 0.006f)}, {0.009f, 0.012f}, 3, 0.014f);
  }
  s.ball({0.150f, 1.455f, 0.005f}, 0.021f, 0.01f);  // brooch
  s.mirror(first, 0);
}

// From the left shoulder across to the right hip, round the back, and hanging from the left arm.
void addMantle(Sculpture& s) {
  for (int i = 0; i < 6; ++i) {
    const float f = static_cast<float>(i) - 2.5f, d = 0.026f * f;
    s.chain({{0.13f + 0.3f * d, 1.44f, -0.07f},
             {0.135f + 0.5f * d, 1.465f, 0.02f},
             {0.085f + 0.6f * d, 1.34f + 0.6f * d, 0.125f},
             {-0.035f, 1.16f + d, 0.142f + 0.004f * f},
             {-0.155f, 1.02f + d, 0.105f},
             {-0.205f, 0.97f + 1.1f * d, 0},
             {-0.13f, 1.02f + 1.1f * d, -0.13f},
             {0.05f, 1.14f + d, -0.15f},
             {0.13f + 0.3f * d, 1.34f + d, -0.11f}},
            {0.013f, 0.016f, 0.018f, 0.017f, 0.019f, 0.018f, 0.016f}, 3, 0.012f);
  }
  for (int i = 0; i < 7; ++i) {  // the free end
    const float f = static_cast<float>(i);
    const float low = 0.50f + 0.05f * std::sin(2.3f * f);
    s.chain({{0.245f, 1.16f, -0.05f + 0.026f * f},
             {0.275f + 0.008f * (i % 2 == 0 ? 1.f : -1.f), 1.0f, -0.07f + 0.030f * f},
             {0.285f + 0.014f * (i % 2 == 0 ? 1.f : -1.f), 0.75f, -0.085f + 0.034f * f},
             {0.29f + 0.018f * (i % 2 == 0 ? 1.f : -1.f), low, -0.09f + 0.036f * f}},
            {0.016f, 0.018f, 0.019f, 0.020f}, 3, 0.012f);
  }
}

void addHand(Sculpture& s, Vec3f wrist, Vec3f palm, Vec3f fingers, Vec3f across) {
  s.cone(wrist, palm, 0.026f, 0.032f, 0.02f);
  for (int i = 0; i < 4; ++i) {
    const Vec3f side = across * (0.017f * (static_cast<float>(i) - 1.5f));
    s.chain({palm + side, palm + side + fingers * 0.045f,
             palm + side + fingers * 0.06f + (palm - wrist) * 0.45f},
            {0.012f, 0.0105f, 0.008f}, 3, 0.008f);
  }
  s.cone(palm - across * 0.03f, palm - across * 0.045f + fingers * 0.045f, 0.012f, 0.009f, 0.012f);
}

void addArms(Sculpture& s) {
  // The right one lifts the cup.
  s.chain({{-0.175f, 1.40f, -0.01f}, {-0.335f, 1.31f, 0.03f}, {-0.36f, 1.53f, 0.15f}},
          {0.055f, 0.044f, 0.028f}, 6, 0.03f);
  addHand(s, {-0.36f, 1.53f, 0.15f}, {-0.36f, 1.60f, 0.165f}, {0.25f, 0.35f, 0.9f},
          {0.9f, 0, -0.4f});
  const Vec3f cup{-0.345f, 1.655f, 0.20f};
  s.cone(cup - Vec3f(0, 0.055f, 0), cup - Vec3f(0, 0.01f, 0), 0.024f, 0.012f, 0.008f);
  s.ellipsoid(cup + Vec3f(0, 0.035f, 0), {0.072f, 0.045f, 0.072f}, 0.012f);
  s.ellipsoid(cup + Vec3f(0, 0.070f, 0), {0.057f, 0.048f, 0.057f}, 0.003f).carved = true;
  // The left one carries the jug.
  s.chain({{0.175f, 1.40f, -0.01f}, {0.235f, 1.16f, -0.02f}, {0.21f, 1.10f, 0.20f}},
          {0.055f, 0.045f, 0.027f}, 6, 0.03f);
  addHand(s, {0.21f, 1.10f, 0.20f}, {0.205f, 1.095f, 0.26f}, {-0.3f, -0.5f, 0.7f},
          {0.9f, 0, 0.35f});
  const Vec3f jug{0.19f, 1.0f, 0.30f};
  s.ellipsoid(jug, {0.066f, 0.085f, 0.066f}, 0.01f);
  s.cone(jug - Vec3f(0, 0.09f, 0), jug - Vec3f(0, 0.08f, 0), 0.034f, 0.03f, 0.01f);
  s.chain({jug + Vec3f(0, 0.06f, 0), jug + Vec3f(0, 0.12f, 0), jug + Vec3f(0, 0.155f, 0.01f)},
          {0.035f, 0.024f, 0.040f}, 4, 0.02f);
  s.ball(jug + Vec3f(0, 0.185f, 0.014f), 0.027f, 0.004f).carved = true;
  s.chain({jug + Vec3f(-0.05f, 0.04f, 0.02f), jug + Vec3f(-0.095f, 0.10f, 0.03f),
           jug + Vec3f(-0.04f, 0.155f, 0.012f)},
          {0.010f, 0.009f, 0.010f}, 6, 0.008f);
}

// Its middle at `at`, the chin 0.11 lower.
void addHead(Sculpture& s, Vec3f at) {
  s.cone({0, 1.40f, -0.015f}, at + Vec3f(0, -0.06f, -0.02f), 0.050f, 0.046f, 0.04f);
  s.ellipsoid(at + Vec3f(0, 0.025f, -0.018f), {0.076f, 0.088f, 0.094f}, 0.03f);
  s.ellipsoid(at + Vec3f(0, -0.032f, 0.022f), {0.058f, 0.076f, 0.062f}, 0.03f);
  s.ball(at + Vec3f(0, -0.094f, 0.058f), 0.018f, 0.03f);
  s.chain({at + Vec3f(0, 0.012f, 0.084f), at + Vec3f(0, -0.020f, 0.098f),
           at + Vec3f(0, -0.032f, 0.099f)},
          {0.009f, 0.0095f, 0.0115f}, 3, 0.014f);                                  // nose
  s.ellipsoid(at + Vec3f(0, -0.058f, 0.080f), {0.020f, 0.0060f, 0.011f}, 0.004f);  // lips
  s.ellipsoid(at + Vec3f(0, -0.069f, 0.078f), {0.017f, 0.0065f, 0.011f}, 0.004f);
  const size_t first = s.partCount();
  s.ellipsoid(at + Vec3f(0.030f, 0.004f, 0.071f), {0.018f, 0.011f, 0.016f}, 0.012f).carved = true;
  s.ellipsoid(at + Vec3f(0.029f, 0.003f, 0.0515f), {0.015f, 0.0095f, 0.0125f}, 0.004f);  // eye
  s.chain({at + Vec3f(0.012f, 0.017f, 0.074f), at + Vec3f(0.032f, 0.023f, 0.063f),
           at + Vec3f(0.054f, 0.013f, 0.044f)},
          {0.006f, 0.0065f, 0.004f}, 3, 0.012f);  // brow
  s.ellipsoid(at + Vec3f(0.075f, -0.015f, -0.005f), {0.009f, 0.026f, 0.016f}, 0.008f);
  for (int i = 0; i < 8; ++i) {  // locks from the parting to the knot
    const float a = 0.20f * static_cast<float>(i), c = std::cos(a), wave = i % 2 == 0 ? 1.f : -1.f;
    s.chain({at + Vec3f(0.006f, 0.112f - 0.012f * a, 0.055f - 0.035f * static_cast<float>(i)),
             at + Vec3f(0.052f + 0.004f * wave, 0.090f, 0.055f - 0.025f * static_cast<float>(i)),
             at + Vec3f(0.083f, 0.040f + 0.006f * wave, 0.020f - 0.014f * static_cast<float>(i)),
             at + Vec3f(0.078f, 0.015f * c, -0.055f - 0.003f * static_cast<float>(i)),
             at + Vec3f(0.020f, 0.005f + 0.02f * c, -0.115f)},
            {0.013f, 0.016f, 0.017f, 0.015f, 0.012f}, 4, 0.005f);
  }
  s.mirror(first, 0);
  for (int i = 0; i < 6; ++i) {  // the knot
    const float a = kTwoPi * fraction(i, 6), b = a + 2.2f;
    const Vec3f middle = at + Vec3f(0, 0.025f, -0.135f);
    s.chain({middle + Vec3f(0.042f * std::cos(a), 0.042f * std::sin(a), 0.005f),
             middle + Vec3f(0.036f * std::cos(0.5f * (a + b)), 0.036f * std::sin(0.5f * (a + b)),
                            -0.028f),
             middle + Vec3f(0.012f * std::cos(b), 0.012f * std::sin(b), -0.045f)},
            {0.015f, 0.017f, 0.012f}, 4, 0.005f);
  }
}

void addFeet(Sculpture& s) {
  for (const float x : {-0.075f, 0.115f}) {
    const float z = x < 0 ? 0.10f : 0.14f;
    s.cone({x, 0.05f, z}, {x * 1.1f, 0.032f, z + 0.115f}, 0.042f, 0.030f, 0.03f);
    for (int i = 0; i < 5; ++i) {
      const float side = (static_cast<float>(i) - 2) * 0.017f * (x < 0 ? -1.f : 1.f);
      const float big = i == 0 ? 0.015f : 0.0115f;
      s.cone({x * 1.1f + side, 0.026f, z + 0.11f},
             {x * 1.15f + 1.1f * side, 0.014f, z + 0.16f - 0.007f * static_cast<float>(i)}, 0.014f,
             big, 0.008f);
    }
  }
}

}  // namespace

Mesh cupbearer(int cells) {
  Sculpture body, head;
  addBody(body);
  addChest(body);
  addDress(body);
  addOverfold(body);
  addArms(body);
  addMantle(body);
  addFeet(body);
  body.standOn(0);
  // The head is set in, as statues' often are: its features need smaller triangles.
  addHead(head, {-0.01f, 1.575f, 0.01f});
  // Normals of the faces: in narrow creases the distance's gradient looks into the other fold.
  return creased(merged({largestPart(body.mesh(cells)), largestPart(head.mesh(cells * 2 / 5))}),
                 -1);
}

}  // namespace lobelia::builtin
