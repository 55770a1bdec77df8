// `hall`: a concert hall of curved metal sails around a forecourt, in sun and sky, in the spirit of
// the Disney Hall of [P003]. As there, the metal has no diffuse part: what it sends on, diffuse
// virtual lights cannot carry. The architecture is our own.
//
// Metres; y is up, the forecourt y = 0, the viewer at +z.
#include <fmt/format.h>

#include <cmath>

#include "lobelia/builtin/makers.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/noise.h"
#include "lobelia/builtin/scene_builder.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"
#include "lobelia/builtin/sweep.h"
#include "lobelia/builtin/textures.h"
#include "lobelia/io/mesh_io.h"
#include "lobelia/io/sky.h"

namespace lobelia::builtin {
namespace {

// A sheet between a curve on the ground and a curve in the air, bulging to its left (seen along
// the curve, from above) in between.
struct Sail {
  std::vector<Vec3f> foot, top;
  float bulge;
};

const std::vector<Sail> kSails{
    // The large pair that opens to the entrance.
    {{{-16, 0, -6}, {-11, 0, 0}, {-5, 0, 2}, {-2.5f, 0, 0}},
     {{-19, 13, -8}, {-13, 19, 3}, {-6, 23, 6}, {-3, 19, 1}},
     2.2f},
    {{{2.5f, 0, 0}, {6, 0, 3}, {12, 0, 3}, {17, 0, -3}},
     {{3, 15, 1}, {7, 18, 7}, {14, 14, 7}, {21, 18, -4}},
     1.8f},
    // Behind it, higher, sails that lean inwards and out.
    {{{-9, 0, -8}, {-4, 0, -4}, {2, 0, -4}, {6, 0, -8}},
     {{-13, 26, -12}, {-5, 31, -2}, {1, 25, -1}, {4, 29, -7}},
     -1.5f},
    {{{4, 0, -9}, {9, 0, -4}, {14, 0, -6}, {18, 0, -12}},
     {{3, 27, -9}, {10, 29, 0}, {17, 22, -4}, {23, 26, -14}},
     1.6f},
    {{{-22, 0, -14}, {-17, 0, -9}, {-12, 0, -9}, {-8, 0, -13}},
     {{-26, 19, -16}, {-19, 25, -5}, {-12, 22, -7}, {-7, 28, -13}},
     1.2f},
    // Low ones beside the stairs, and wings that close the court.
    {{{-24, 0, 4}, {-21, 0, 10}, {-15, 0, 11}, {-11, 0, 7}},
     {{-27, 8, 3}, {-23, 11, 13}, {-15, 7, 13}, {-10, 9.5f, 7}},
     1.0f},
    {{{13, 0, 8}, {16, 0, 12}, {21, 0, 12}, {25, 0, 6}},
     {{12, 7, 8}, {16, 9, 15}, {23, 12, 14}, {29, 8, 5}},
     1.2f},
    {{{24, 0, -4}, {26, 0, 2}, {30, 0, 4}, {35, 0, 2}},
     {{23, 15, -4}, {26, 12, 5}, {32, 16, 6}, {39, 13, 1}},
     1.4f},
    {{{-36, 0, 1}, {-32, 0, 5}, {-28, 0, 4}, {-25, 0, -1}},
     {{-40, 12, 0}, {-33, 16, 8}, {-28, 13, 6}, {-23, 17, -2}},
     1.2f},
};

class Hall : SceneBuilder {
 public:
  using SceneBuilder::SceneBuilder;

  Scene make() {
    addGround();
    addSails();
    addEntrance();
    addPlanters();
    addCamera("court", {-9, 1.75, 40}, {0.5, 11.0, 0}, 64, 800, 600);
    addCamera("sails", {12, 1.7, 19}, {-4, 9.5, 0}, 58, 800, 600);
    // A clear morning; the sun stands behind the viewer's left.
    io::applySky(scene(), "2.5,-0.55,0.62,0.60");
    scene().integrator = "path";
    scene().maxDepth = 10;
    return take();
  }

 private:
  void addGround() {
    Tiles pattern;
    pattern.color = {0.52f, 0.47f, 0.41f}, pattern.grout = {0.25f, 0.23f, 0.21f};
    pattern.columns = pattern.rows = 4;
    pattern.toneSpread = 0.10f;
    const MaterialHandle stone =
        add(diffuse(addBitmap(tiles(pattern, 256).color, {18, 18}, "paving")), "paving");
    place(add(io::unitRectangle(), "ground"), rotation({1, 0, 0}, -90) * scaling(Vec3d(90)), stone,
          "ground");
    // Stairs that widen towards the court.
    const MaterialHandle step = add(diffuse(Rgb(0.50f, 0.46f, 0.41f)), "steps");
    for (int i = 0; i < 7; ++i) {
      const double half = 5.2 - 0.35 * i, depth = 3.6 - 0.4 * i;
      const auto size = Vec3f(static_cast<float>(half), 0.085f, static_cast<float>(depth));
      place(add(roundedBox(size, 0.02f, segments(2, 1)), fmt::format("step {}", i + 1)),
            translation({0, 0.085 + 0.17 * i, 4.2}), step, fmt::format("step {}", i + 1));
    }
  }

  // Both sides of a sheet and its rim; uv of 1 is one panel.
  Mesh sheet(const Sail& sail) const {
    const Curve foot = smoothCurve3(sail.foot), top = smoothCurve3(sail.top);
    const auto middle = [&](float u, float v) {
      const Vec3f along = foot(std::min(u + 0.01f, 1.f)) - foot(std::max(u - 0.01f, 0.f));
      const Vec3f out = normalize(cross(along, Vec3f(0, 1, 0)));
      // Steeper at the foot: the sheet leans out as it rises.
      const float lean = std::pow(v, 1.35f);
      const Vec3f a = foot(u), b = top(u);
      return Vec3f(a.x + (b.x - a.x) * lean, b.y * v, a.z + (b.z - a.z) * lean) +
             out * (-sail.bulge * std::sin(kPi * v));
    };
    const int columns = segments(37, 6), rows = segments(16, 4);
    constexpr float kHalf = 0.09f;
    Mesh mesh;
    for (const float side : {1.f, -1.f}) {
      const size_t base = mesh.positions.size();
      for (int i = 0; i <= rows; ++i)
        for (int j = 0; j <= columns; ++j) {
          const float u = fraction(j, columns), v = fraction(i, rows);
          const float e = 1e-3f, u0 = std::max(u - e, 0.f), u1 = std::min(u + e, 1.f),
                      v0 = std::max(v - e, 0.f), v1 = std::min(v + e, 1.f);
          const Vec3f n =
              normalize(cross(middle(u1, v) - middle(u0, v), middle(u, v1) - middle(u, v0)));
          addVertex(mesh, middle(u, v) + n * (side * kHalf), n * side, {7 * u, 7 * v});
        }
      const size_t first = mesh.triangles.size();
      addGrid(mesh, base, rows, columns);
      if (side < 0)
        for (size_t t = first; t < mesh.triangles.size(); ++t)
          std::swap(mesh.triangles[t].y, mesh.triangles[t].z);
    }
    addRim(mesh, rows, columns);
    return mesh;
  }

  // Strips between the two sides along the edges that can be seen.
  static void addRim(Mesh& mesh, int rows, int columns) {
    const auto vertex = [&](int side, int i, int j) {
      return static_cast<uint32_t>((side * (rows + 1) + i) * (columns + 1) + j);
    };
    const auto strip = [&](int count, const auto& at) {
      for (int k = 0; k < count; ++k) {
        const uint32_t corners[4] = {at(0, k), at(1, k), at(1, k + 1), at(0, k + 1)};
        const auto base = static_cast<uint32_t>(mesh.positions.size());
        const Vec3f n = normalize(cross(mesh.positions[corners[1]] - mesh.positions[corners[0]],
                                        mesh.positions[corners[3]] - mesh.positions[corners[0]]));
        for (const uint32_t c : corners) {
          const Vec3f p = mesh.positions[c];
          const Vec2f uv = mesh.uvs[c];
          addVertex(mesh, p, n, uv);
        }
        mesh.triangles.push_back({base, base + 1, base + 2});
        mesh.triangles.push_back({base, base + 2, base + 3});
      }
    };
    strip(columns, [&](int side, int k) { return vertex(1 - side, rows, k); });
    strip(rows, [&](int side, int k) { return vertex(side, k, 0); });
    strip(rows, [&](int side, int k) { return vertex(1 - side, k, columns); });
  }

  void addSails() {
    // Brushed steel in panels: their roughness differs a little, seams are rough.
    const Image roughness = dataImage(512, 512, [](Vec2f uv) {
      constexpr int kPanels = 8;
      const int row = static_cast<int>(uv.y * kPanels);
      const float x = uv.x * kPanels * 0.5f + 0.5f * static_cast<float>(row % 2),
                  y = uv.y * kPanels;
      const int column = static_cast<int>(std::floor(x)) % (kPanels / 2);
      const float fx = x - std::floor(x), fy = y - std::floor(y);
      const bool seam = std::min(fx, 1 - fx) < 0.012f || std::min(fy, 1 - fy) < 0.024f;
      return seam ? 0.55f : 0.16f + 0.10f * cellRandom(column, row, 77);
    });
    const TextureHandle texture = addBitmap(roughness, {1, 1}, "panel-roughness");
    const MaterialHandle steel = add(metal(kSteel, texture), "brushed steel");
    const MaterialHandle bright = add(metal(kAluminium, 0.10f), "polished steel");
    for (size_t i = 0; i < kSails.size(); ++i) {
      const std::string name = fmt::format("sail {}", i + 1);
      // One of the inner sails is polished, as a part of the model was.
      place(add(sheet(kSails[i]), name), Mat4(), i == 2 ? bright : steel, name);
    }
  }

  void addEntrance() {
    const MaterialHandle dark = add(metal(kSteel, 0.25f), "frames");
    Material pane = coated(Rgb(0.02f, 0.025f, 0.03f), 0.05f);
    const MaterialHandle glassFront = add(pane, "glass front");
    place(add(roundedBox({4.6f, 5.2f, 0.2f}, 0.02f, segments(2, 1)), "front"),
          translation({0, 5.2, -1.6}), glassFront, "front");
    const MeshHandle post = add(roundedBox({0.07f, 5.2f, 0.12f}, 0.02f, segments(2, 1)), "post"),
                     beam = add(roundedBox({4.6f, 0.07f, 0.12f}, 0.02f, segments(2, 1)), "beam");
    for (int i = 0; i <= 8; ++i)
      place(post, translation({-4.6 + 1.15 * i, 5.2, -1.35}), dark, fmt::format("post {}", i + 1));
    for (int i = 0; i < 5; ++i)
      place(beam, translation({0, 1.3 + 2.3 * i, -1.35}), dark, fmt::format("beam {}", i + 1));
    // A curved canopy over the doors.
    const std::vector<Vec2f> section = rounded(rectangle(1.6f, 0.09f), 0.08f, 3);
    SweepOptions options;
    options.sideHint = {0, 0, 1};
    place(
        add(sweep(section,
                  smoothCurve3(
                      {{-5.6f, 4.3f, 1.2f}, {-2, 4.9f, 1.5f}, {2, 4.9f, 1.5f}, {5.6f, 4.3f, 1.2f}}),
                  segments(40, 8), options),
            "canopy"),
        Mat4(), dark, "canopy");
    // The base of the building between the sails.
    const MaterialHandle stone = add(diffuse(Rgb(0.46f, 0.40f, 0.33f)), "limestone");
    place(add(roundedBox({22, 4.5f, 6}, 0.05f, segments(2, 1)), "base"), translation({0, 4.5, -14}),
          stone, "base");
    place(add(roundedBox({11, 8.5f, 4}, 0.05f, segments(2, 1)), "stage house"),
          translation({-1, 8.5, -16}), stone, "stage house");
  }

  // Round planters with clipped trees, and benches.
  void addPlanters() {
    const MaterialHandle stone = add(diffuse(Rgb(0.42f, 0.38f, 0.33f)), "planter");
    const MaterialHandle leaves = add(diffuse(Rgb(0.055f, 0.13f, 0.035f)), "leaves");
    const MaterialHandle bark = add(diffuse(Rgb(0.12f, 0.08f, 0.05f)), "bark");
    const MeshHandle pot = add(cylinder(1.2f, 0.55f, 0.06f, 2, segments(32, 8)), "planter");
    const MeshHandle trunk = add(cylinder(0.12f, 2.2f, 0.01f, 1, segments(12, 5)), "trunk");
    const MeshHandle crown = add(
        icosphere(
            std::max(1, static_cast<int>(std::lround(3 + std::log2(detail())))),
            [](Vec3f d) { return 1.0f + 0.22f * noise(d * 3.1f, 8) + 0.12f * noise(d * 8.f, 9); }),
        "crown");
    const Vec3d places[] = {{-13, 0, 17}, {-6.5, 0, 13}, {7.5, 0, 13.5}, {15, 0, 19}};
    for (size_t i = 0; i < 4; ++i) {
      const Vec3d at = places[i];
      const auto name = [&](const char* what) { return fmt::format("{} {}", what, i + 1); };
      place(pot, translation(at), stone, name("planter"));
      place(trunk, translation(at + Vec3d(0, 0.5, 0)), bark, name("trunk"));
      place(crown,
            translation(at + Vec3d(0, 3.3, 0)) *
                rotation({0, 1, 0}, 70.0 * static_cast<double>(i)) * scaling({1.35, 1.2, 1.35}),
            leaves, name("crown"));
    }
  }
};

}  // namespace

Scene makeHall(float detail) { return Hall(detail).make(); }

}  // namespace lobelia::builtin
