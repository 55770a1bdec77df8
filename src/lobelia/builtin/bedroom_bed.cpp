// The bed of the bedroom: its frame, a cover that hangs over the edges, pillows.
#include <cmath>

#include "lobelia/builtin/bedroom.h"
#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/noise.h"
#include "lobelia/builtin/shapes.h"
#include "lobelia/builtin/solids.h"

namespace lobelia::builtin {
namespace {

// Every vertex moved along its normal by folds of cloth, about `height` high and 1 / `scale` wide.
Mesh wrinkled(Mesh mesh, float height, float scale, uint64_t seed) {
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const Vec3f p = mesh.positions[i];
    mesh.positions[i] += mesh.normals[i] * (height * fbm(p * scale, 4, seed));
  }
  return creased(std::move(mesh), 180);
}

}  // namespace

void Bedroom::addBed() {
  const float middle = (kBedHead + kBedFoot) / 2, half = (kBedFoot - kBedHead) / 2;
  for (const float s : {-1.f, 1.f})
    put(block({0.014f, 0.085f, half - 0.03f}), {kBedX + s * (kBedHalf + 0.004f), 0.27f, middle},
        wood_, s < 0 ? "left rail" : "right rail");
  // Head and foot: boards with a bow on top.
  const auto board = [&](float height, float bow, const char* name, float z) {
    const float w = kBedHalf + 0.05f;
    Polygon outline{{-w, 0}, {w, 0}};
    constexpr int kBow = 24;
    for (int i = 0; i <= kBow; ++i) {
      const float t = fraction(i, kBow);
      outline.push_back({w * (1 - 2 * t), height + bow * std::sin(kPi * t)});
    }
    place(add(extrude(outline, 0.036f, 0.006f, 2), name),
          moving({kBedX, 0.10f, z}) * rotation({1, 0, 0}, 90), wood_, name);
  };
  board(0.85f, 0.14f, "head board", kBedHead - 0.045f);
  board(0.42f, 0.08f, "foot board", kBedFoot + 0.010f);
  const MeshHandle post = add(block({0.034f, 0.5f, 0.034f}, 0.010f), "post");
  for (int i = 0; i < 4; ++i) {
    const bool isHead = i < 2;
    const double high = isHead ? 1.02 : 0.58,
                 x = static_cast<double>(kBedX) +
                     (i % 2 == 0 ? -1 : 1) * (static_cast<double>(kBedHalf) + 0.086);
    const double z =
        isHead ? static_cast<double>(kBedHead) - 0.027 : static_cast<double>(kBedFoot) + 0.028;
    place(post, translation({x, high / 2, z}) * scaling({1, high, 1}), wood_,
          "post " + std::to_string(i + 1));
  }
  put(withProjectedUvs(roundedBox({kBedHalf - 0.02f, 0.10f, half - 0.025f}, 0.06f, segments(5, 2))),
      {kBedX, kBedTop - 0.105f, middle}, sheet_, "mattress");
}

// The cover lies over the mattress from below the pillows to the foot and hangs down at both sides;
// its upper end is turned back.
void Bedroom::addCover() {
  const int across = segments(130, 16), along = segments(105, 12);
  const float top = kBedTop + 0.035f, edge = kBedHalf + 0.03f, bend = 0.07f, hang = 0.24f;
  const float head = -1.13f, foot = kBedFoot - 0.012f;
  const float flat = edge - bend, arc = 0.5f * kPi * bend, half = flat + arc + hang;
  Mesh mesh;
  for (int i = 0; i <= along; ++i)
    for (int j = 0; j <= across; ++j) {
      const float s = half * (2 * fraction(j, across) - 1), a = std::abs(s);
      const float side = std::copysign(1.f, s);
      Vec3f p{s, top, lerp(foot, head, fraction(i, along))};
      if (a > flat + arc) {
        p.x = side * edge, p.y = top - bend - (a - flat - arc);
        // What hangs falls in folds.
        const float down = (a - flat - arc) / hang;
        p.x +=
            side * down * (0.030f + 0.028f * std::sin(21 * p.z + 2 * fbm(Vec3f(p.z, s, 0), 2, 3)));
      } else if (a > flat) {
        const float angle = (a - flat) / bend;
        p.x = side * (flat + bend * std::sin(angle)), p.y = top - bend * (1 - std::cos(angle));
      }
      mesh.positions.push_back(p);
      mesh.uvs.push_back({fraction(j, across), fraction(i, along)});
    }
  addGrid(mesh, 0, along, across);
  put(wrinkled(creased(std::move(mesh), 180), 0.030f, 3.2f, 8), {kBedX, 0, 0}, cover_, "cover");
  put(wrinkled(superellipsoid({edge - 0.03f, 0.040f, 0.15f}, 0.8f, 0.25f, segments(30, 8),
                              segments(130, 16)),
               0.022f, 5, 12),
      {kBedX, top + 0.042f, head + 0.13f}, sheet_, "cover, turned back");
}

void Bedroom::addPillows() {
  const Mesh pillow =
      superellipsoid({0.35f, 0.105f, 0.235f}, 0.95f, 0.42f, segments(50, 10), segments(84, 16));
  const struct {
    float x, y, z;
    double lean, turn;
    MaterialHandle material;
    const char* name;
  } places[] = {{-0.40f, 0.125f, -1.50f, 24, 4, sheet_, "left pillow"},
                {0.38f, 0.125f, -1.50f, 22, -5, sheet_, "right pillow"},
                {-0.02f, 0.255f, -1.395f, 52, 8, blanket_, "cushion"}};
  uint64_t seed = 20;
  for (const auto& p : places) {
    const bool isCushion = p.material == blanket_;
    Mesh mesh = wrinkled(isCushion ? transformed(pillow, scaling({0.66, 0.80, 0.95})) : pillow,
                         0.020f, 7, seed++);
    place(add(std::move(mesh), p.name),
          moving({kBedX + p.x, kBedTop + p.y, p.z}) * rotation({0, 1, 0}, p.turn) *
              rotation({1, 0, 0}, p.lean),
          p.material, p.name);
  }
}

}  // namespace lobelia::builtin
