// `teapot`, `teapot-32` to `teapot-512`: a glossy teapot in the light of an environment, after the
// Teapot scenes of [P002], where the number is the Phong exponent. Body and lid are surfaces of
// revolution, spout and handle sweeps, all of our own measure; --meshes takes other teapots.
#include "lobelia/builtin/teapot.h"

#include <cmath>

#include "lobelia/builtin/hall_light.h"
#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"
#include "lobelia/io/mesh_io.h"

namespace lobelia::builtin {

Mesh teapot(const Fineness& fine) {
  const int around = fine(120, 12);
  const Mesh body =
      revolve(smoothCurve({{0, 0.0f},       {0.30f, 0},       {0.36f, 0.01f},  {0.375f, 0.035f},
                           {0.42f, 0.075f}, {0.54f, 0.17f},   {0.61f, 0.30f},  {0.605f, 0.44f},
                           {0.54f, 0.58f},  {0.45f, 0.67f},   {0.405f, 0.70f}, {0.40f, 0.725f},
                           {0.38f, 0.73f},  {0.365f, 0.715f}, {0.36f, 0.68f},  {0.45f, 0.58f},
                           {0.53f, 0.44f},  {0.53f, 0.30f},   {0.42f, 0.13f},  {0, 0.07f}}),
              fine(84, 20), around);
  const Mesh lid = revolve(smoothCurve({{0, 0.66f},
                                        {0.34f, 0.665f},
                                        {0.355f, 0.70f},
                                        {0.385f, 0.735f},
                                        {0.375f, 0.752f},
                                        {0.30f, 0.795f},
                                        {0.18f, 0.835f},
                                        {0.075f, 0.855f},
                                        {0.05f, 0.875f},
                                        {0.055f, 0.90f},
                                        {0.10f, 0.94f},
                                        {0.105f, 0.985f},
                                        {0.06f, 1.02f},
                                        {0, 1.025f}}),
                           fine(56, 14), around);
  const std::vector<Vec2f> circleProfile = ellipse(1, 1, fine(44, 8));
  // The spout: out and back again inside, so that its mouth is open.
  const Curve middle = smoothCurve3({{0.46f, 0.22f, 0},
                                     {0.66f, 0.26f, 0},
                                     {0.80f, 0.42f, 0},
                                     {0.88f, 0.60f, 0},
                                     {1.00f, 0.715f, 0}});
  const auto radius = [](float t) {
    const float s = std::min(2 * t, 2 - 2 * t);  // place along the spout, 1 at its mouth
    const float outside = 0.155f - 0.11f * std::pow(s, 0.75f) + 0.012f * sqr(sqr(s));
    return t <= 0.5f ? outside : outside * (0.80f + 0.2f * std::max(0.f, 1 - 12 * (1 - s)));
  };
  const int along = fine(64, 10);
  Mesh spout;
  for (int i = 0; i <= 2 * along; ++i) {
    const float t = fraction(i, 2 * along), s = std::min(2 * t, 2 - 2 * t);
    const Vec3f c = middle(s), tangent = normalize(middle(std::min(s + 1e-3f, 1.f)) -
                                                   middle(std::max(s - 1e-3f, 0.f)));
    const Vec3f side{0, 0, 1}, up = cross(tangent, side);
    // The mouth is cut level.
    const Vec3f tilt = lerp(up, normalize(Vec3f(1, -0.1f, 0)), 0.8f * sqr(sqr(s)));
    for (const Vec2f p : circleProfile)
      spout.positions.push_back(c + (side * p.x + tilt * p.y) * radius(t));
    spout.positions.push_back(spout.positions[spout.positions.size() - circleProfile.size()]);
  }
  spout.uvs.resize(spout.positions.size());
  for (size_t i = 0; i < spout.uvs.size(); ++i) {
    const size_t row = circleProfile.size() + 1;
    spout.uvs[i] = {fraction(static_cast<int>(i % row), static_cast<int>(row - 1)),
                    fraction(static_cast<int>(i / row), 2 * along)};
  }
  addGrid(spout, 0, 2 * along, static_cast<int>(circleProfile.size()));
  spout = creased(std::move(spout), 70);

  SweepOptions handleOptions;
  handleOptions.sideHint = {0, 0, 1};
  handleOptions.scale = [](float t) { return 1 + 0.45f * sqr(sqr(2 * t - 1)); };
  const Mesh handle = sweep(ellipse(0.055f, 0.042f, fine(36, 8)),
                            smoothCurve3({{-0.50f, 0.60f, 0},
                                          {-0.70f, 0.655f, 0},
                                          {-0.90f, 0.60f, 0},
                                          {-0.955f, 0.46f, 0},
                                          {-0.86f, 0.30f, 0},
                                          {-0.70f, 0.20f, 0},
                                          {-0.52f, 0.17f, 0}}),
                            fine(96, 12), handleOptions);
  return merged({body, lid, spout, handle});
}

namespace {

class TeapotScene : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make(float exponent) {
    const MaterialHandle glaze =
        add(phong(Rgb(0.16f, 0.045f, 0.03f), Rgb(0.60f, 0.50f, 0.42f), exponent), "teapot");
    const MaterialHandle table =
        add(phong(Rgb(0.16f, 0.15f, 0.14f), Rgb(0.40f), exponent), "table");
    const Fineness fine = [this](int atDetailOne, int least) {
      return segments(atDetailOne, least);
    };
    place(add(teapot(fine), "teapot"), rotation({0, 1, 0}, 22), glaze, "teapot");
    place(add(roundSlab(1.55f, 0.10f, 0.03f, segments(6, 1), segments(60, 4)), "table"),
          translation({0, -0.10, 0}), table, "table");
    addHallLight(*this, 80);
    addCamera("front", {0.35, 1.55, 3.1}, {0, 0.40, 0}, 40, 800, 600);
    scene().integrator = "path";
    scene().maxDepth = 10;
    return take();
  }
};

}  // namespace

Scene makeTeapot(float detail, float exponent) { return TeapotScene(detail).make(exponent); }

}  // namespace lobelia::builtin
