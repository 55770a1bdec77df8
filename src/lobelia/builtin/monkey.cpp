// The head of a monkey.
#include <cmath>

#include "lobelia/builtin/creatures.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/sculpture.h"

namespace lobelia::builtin {
namespace {

// Locks of hair from the crown down the back and the sides of the skull.
void addHair(Sculpture& s, Vec3f centre, Vec3f radii) {
  constexpr int kLocks = 34;
  for (int i = 0; i < kLocks; ++i) {
    const float azimuth = kTwoPi * (fraction(i, kLocks) + 0.5f / kLocks);
    // Short over the forehead, long behind.
    const float front = 0.5f + 0.5f * std::sin(azimuth);
    const float end = 1.95f - 1.22f * std::pow(front, 0.7f);
    std::vector<Vec3f> points;
    for (int k = 0; k <= 6; ++k) {
      const float polar = 0.03f + (end - 0.03f) * fraction(k, 6);
      const float turn = azimuth + 0.10f * std::sin(5 * polar + static_cast<float>(i));
      const Vec3f d{std::sin(polar) * std::cos(turn), std::cos(polar),
                    std::sin(polar) * std::sin(turn)};
      points.push_back(centre + Vec3f(d.x * radii.x, d.y * radii.y, d.z * radii.z) * 1.005f);
    }
    s.chain(points, {0.02f, 0.055f, 0.06f, 0.05f, 0.012f}, 3, 0.02f);
  }
}

}  // namespace

Mesh monkeyHead(int cells) {
  Sculpture s;
  const Vec3f skull{0, 1.00f, -0.06f}, size{0.60f, 0.60f, 0.62f};
  s.ellipsoid(skull, size, 0);
  addHair(s, skull, size);
  s.ellipsoid({0, 0.98f, 0.30f}, {0.50f, 0.42f, 0.28f}, 0.10f);         // the mask of the face
  s.ellipsoid({0, 0.50f, 0.40f}, {0.40f, 0.32f, 0.34f}, 0.12f);         // muzzle
  s.ellipsoid({0, 0.36f, 0.24f}, {0.34f, 0.28f, 0.30f}, 0.14f);         // chin
  s.cone({0, 0.92f, 0.54f}, {0, 0.72f, 0.70f}, 0.07f, 0.09f, 0.10f);    // bridge of the nose
  s.cone({0, 0.34f, -0.10f}, {0, 0.10f, -0.16f}, 0.34f, 0.40f, 0.10f);  // neck
  s.ellipsoid({0, 0.06f, -0.16f}, {0.50f, 0.10f, 0.46f}, 0.04f);        // plinth
  s.ellipsoid({0, 0.00f, -0.16f}, {0.58f, 0.07f, 0.54f}, 0.02f);
  const size_t first = s.partCount();
  s.ellipsoid({0.30f, 0.72f, 0.36f}, {0.20f, 0.20f, 0.18f}, 0.10f);  // cheek
  s.chain(
      {{0.05f, 1.13f, 0.60f}, {0.24f, 1.22f, 0.58f}, {0.44f, 1.12f, 0.44f}, {0.50f, 0.94f, 0.32f}},
      {0.07f, 0.095f, 0.08f, 0.04f}, 5, 0.08f);                  // brow
  s.ball({0.23f, 0.99f, 0.60f}, 0.155f, 0.06f).carved = true;    // socket
  s.ball({0.23f, 0.98f, 0.50f}, 0.135f, 0.015f);                 // eye
  s.ball({0.235f, 0.98f, 0.645f}, 0.040f, 0.01f).carved = true;  // pupil
  s.chain({{0.11f, 0.92f, 0.605f}, {0.23f, 0.868f, 0.625f}, {0.36f, 0.915f, 0.545f}},
          {0.012f, 0.022f, 0.012f}, 5, 0.03f);                       // lower lid
  s.ellipsoid({0.09f, 0.66f, 0.73f}, {0.08f, 0.06f, 0.06f}, 0.04f);  // nostril
  s.ellipsoid({0.085f, 0.645f, 0.785f}, {0.034f, 0.026f, 0.04f}, 0.02f, {0, 0, 30}).carved = true;
  s.ellipsoid({0.80f, 1.02f, -0.12f}, {0.34f, 0.38f, 0.10f}, 0.08f, {0, -22, 8});  // ear
  s.ellipsoid({0.84f, 1.03f, -0.04f}, {0.25f, 0.28f, 0.085f}, 0.04f, {0, -22, 8}).carved = true;
  s.ellipsoid({0.74f, 0.97f, -0.06f}, {0.12f, 0.17f, 0.06f}, 0.05f, {0, -22, 12});
  s.chain({{0, 0.47f, 0.745f}, {0.16f, 0.45f, 0.71f}, {0.30f, 0.50f, 0.56f}, {0.35f, 0.57f, 0.44f}},
          {0.024f, 0.022f, 0.018f, 0.008f}, 6, 0.02f);
  s.mirror(first, 0);
  s.standOn(0);
  return s.mesh(cells);
}

}  // namespace lobelia::builtin
