// A sitting hare, its flanks carved with spirals.
#include <cmath>

#include "lobelia/builtin/creatures.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/sculpture.h"

namespace lobelia::builtin {
namespace {

// A spiral of `turns` about a point of an ellipsoid's side (x > 0), as a raised cord.
void addSpiral(Sculpture& s, Vec3f centre, Vec3f radii, float reach, float turns, float cord) {
  std::vector<Vec3f> points;
  constexpr int kPoints = 40;
  for (int i = 0; i <= kPoints; ++i) {
    const float f = fraction(i, kPoints), r = reach * (1 - 0.94f * f),
                angle = kTwoPi * turns * f - 1.2f;
    const float y = r * std::cos(angle), z = r * std::sin(angle);
    points.push_back(centre +
                     Vec3f(radii.x * std::sqrt(1 - y * y - z * z), radii.y * y, radii.z * z));
  }
  s.chain(points, {0.3f * cord, cord, cord, 1.3f * cord}, 2, 0.012f);
}

}  // namespace

Mesh hareStatue(int cells) {
  Sculpture s;
  s.ellipsoid({0, 0.44f, -0.16f}, {0.33f, 0.40f, 0.47f}, 0, {-20, 0, 0});  // body
  s.ellipsoid({0, 0.54f, 0.14f}, {0.25f, 0.34f, 0.24f}, 0.12f);            // chest
  s.cone({0, 0.70f, 0.16f}, {0, 0.90f, 0.24f}, 0.19f, 0.15f, 0.12f);       // neck
  s.ellipsoid({0, 0.97f, 0.30f}, {0.175f, 0.18f, 0.24f}, 0.06f, {15, 0, 0});
  s.ellipsoid({0, 0.90f, 0.46f}, {0.115f, 0.10f, 0.11f}, 0.07f);       // muzzle
  s.ellipsoid({0, 0.945f, 0.560f}, {0.035f, 0.024f, 0.022f}, 0.015f);  // nose
  s.cone({0, 0.92f, 0.565f}, {0, 0.86f, 0.555f}, 0.008f, 0.008f, 0.01f).carved = true;
  s.ball({0, 0.26f, -0.64f}, 0.13f, 0.04f);  // tail
  const size_t first = s.partCount();
  const Vec3f haunch{0.20f, 0.30f, -0.24f}, haunchSize{0.20f, 0.29f, 0.32f};
  s.ellipsoid(haunch, haunchSize, 0.04f);
  s.ellipsoid({0.24f, 0.06f, 0.06f}, {0.09f, 0.07f, 0.29f}, 0.04f);  // hind foot
  s.cone({0.14f, 0.50f, 0.24f}, {0.12f, 0.09f, 0.36f}, 0.10f, 0.062f, 0.06f);
  s.ellipsoid({0.12f, 0.05f, 0.41f}, {0.072f, 0.055f, 0.12f}, 0.03f);  // paw
  for (int i = -1; i <= 1; ++i) {                                      // toes
    const float x = 0.035f * static_cast<float>(i);
    s.cone({0.12f + x, 0.06f, 0.44f}, {0.12f + x, 0.035f, 0.52f}, 0.028f, 0.024f, 0.012f);
    s.cone({0.24f + x * 1.3f, 0.07f, 0.27f}, {0.24f + x * 1.3f, 0.04f, 0.36f}, 0.034f, 0.028f,
           0.012f);
  }
  s.ellipsoid({0.085f, 0.88f, 0.42f}, {0.085f, 0.075f, 0.09f}, 0.04f);  // cheek
  s.ball({0.150f, 1.015f, 0.385f}, 0.042f, 0.02f).carved = true;
  s.ball({0.140f, 1.012f, 0.378f}, 0.042f, 0.006f);  // eye
  s.ball({0.176f, 1.018f, 0.400f}, 0.012f, 0.006f).carved = true;
  s.cone({0.10f, 1.075f, 0.44f}, {0.155f, 1.055f, 0.33f}, 0.016f, 0.016f, 0.03f);
  s.ellipsoid({0.115f, 1.40f, 0.09f}, {0.085f, 0.34f, 0.05f}, 0.05f, {-14, 12, -7});  // ear
  s.ellipsoid({0.120f, 1.42f, 0.132f}, {0.052f, 0.27f, 0.036f}, 0.02f, {-14, 12, -7}).carved = true;
  for (int i = 0; i < 3; ++i) {  // whiskers
    const float y = 0.02f * static_cast<float>(i);
    s.chain({{0.08f, 0.88f + y, 0.51f},
             {0.16f, 0.88f + y * 1.8f, 0.50f},
             {0.23f, 0.86f + y * 3, 0.44f}},
            {0.012f, 0.010f, 0.004f}, 3, 0.008f);
  }
  addSpiral(s, haunch, haunchSize, 0.86f, 3.0f, 0.016f);
  addSpiral(s, {0, 0.54f, 0.14f}, {0.255f, 0.345f, 0.245f}, 0.42f, 2.2f, 0.011f);
  s.mirror(first, 0);
  s.standOn(0);
  return s.mesh(cells);
}

}  // namespace lobelia::builtin
