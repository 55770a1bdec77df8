#include "lobelia/builtin/solids.h"

#include <cmath>
#include <map>

#include "lobelia/builtin/mesh_edit.h"
#include "lobelia/builtin/shapes.h"

namespace lobelia::builtin {
namespace {

float signedPower(float v, float exponent) {
  return std::copysign(std::pow(std::abs(v), exponent), v);
}

}  // namespace

Mesh loft(const std::vector<Ring>& rings, bool startCap, bool endCap, float creaseDegrees) {
  Mesh mesh;
  const size_t corners = rings.front().outline.size();
  for (const Ring& ring : rings)
    for (size_t j = 0; j <= corners; ++j) {
      const Vec2f p = ring.outline[j % corners];
      mesh.positions.push_back({p.x, ring.height, -p.y});
    }
  addGrid(mesh, 0, static_cast<int>(rings.size()) - 1, static_cast<int>(corners));
  const auto addCap = [&](const Ring& ring, bool up) {
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    for (const Vec2f p : ring.outline) mesh.positions.push_back({p.x, ring.height, -p.y});
    for (const Vec3u t : triangulate(ring.outline))
      mesh.triangles.push_back(up ? Vec3u(base + t.x, base + t.y, base + t.z)
                                  : Vec3u(base + t.x, base + t.z, base + t.y));
  };
  if (startCap) addCap(rings.front(), false);
  if (endCap) addCap(rings.back(), true);
  return withProjectedUvs(creased(std::move(mesh), creaseDegrees));
}

Mesh extrude(const Polygon& polygon, float height, float bevel, int bevelSegments) {
  // From the lower face outwards, up and inwards again: (inset, height).
  std::vector<Vec2f> edge;
  const int n = bevel > 0 ? bevelSegments : 0;
  for (int i = 0; i <= n; ++i) {
    const float a = n > 0 ? kPi / 2 * fraction(i, n) : kPi / 2;
    edge.push_back({bevel * (1 - std::sin(a)), bevel * (1 - std::cos(a))});
  }
  std::vector<Ring> rings;
  const auto add = [&](float in, float y) {
    rings.push_back({in > 0 ? inset(polygon, in) : polygon, y});
  };
  for (int i = 0; i <= n; ++i) add(edge[static_cast<size_t>(i)].x, edge[static_cast<size_t>(i)].y);
  for (int i = n; i >= 0; --i)
    add(edge[static_cast<size_t>(i)].x, height - edge[static_cast<size_t>(i)].y);
  return loft(rings, true, true);
}

Mesh lathe(const std::vector<Vec2f>& profile, int segments, float creaseDegrees) {
  float total = 0;
  std::vector<float> at{0};
  for (size_t i = 1; i < profile.size(); ++i)
    at.push_back(total +=
                 std::hypot(profile[i].x - profile[i - 1].x, profile[i].y - profile[i - 1].y));
  Mesh mesh;
  for (size_t i = 0; i < profile.size(); ++i)
    for (int j = 0; j <= segments; ++j) {
      const Vec2f c = circle(j, segments);
      mesh.positions.push_back({profile[i].x * c.x, profile[i].y, -profile[i].x * c.y});
      mesh.uvs.push_back({fraction(j, segments), at[i] / total});
    }
  addGrid(mesh, 0, static_cast<int>(profile.size()) - 1, segments);
  return creased(std::move(mesh),
                 std::max(creaseDegrees, 1.1f * 360 / static_cast<float>(segments)));
}

namespace {

// From the middle below to the edge of the top.
std::vector<Vec2f> cylinderProfile(float radius, float height, float bevel, int bevelSegments) {
  std::vector<Vec2f> profile{{0, 0}};
  for (int i = 0; i <= bevelSegments; ++i) {
    const float a = kPi / 2 * fraction(i, bevelSegments);
    profile.push_back({radius - bevel * (1 - std::sin(a)), bevel * (1 - std::cos(a))});
  }
  for (int i = bevelSegments; i >= 0; --i) {
    const Vec2f p = profile[static_cast<size_t>(1 + i)];
    profile.push_back({p.x, height - p.y});
  }
  return profile;
}

// Between rings of 6 (k - 1) and 6 k points, whose first ones are `inner` and `outer`: each sixth
// has one triangle more that stands on the outer ring.
void addRing(Mesh* mesh, uint32_t inner, uint32_t outer, uint32_t k) {
  const uint32_t innerCount = 6 * (k - 1), outerCount = 6 * k;
  const auto in = [&](uint32_t i) { return inner + (innerCount > 0 ? i % innerCount : 0); };
  const auto out = [&](uint32_t i) { return outer + i % outerCount; };
  for (uint32_t sixth = 0; sixth < 6; ++sixth)
    for (uint32_t i = 0; i < k; ++i) {
      const uint32_t o = sixth * k + i, n = sixth * (k - 1) + i;
      mesh->triangles.push_back({in(n), out(o), out(o + 1)});
      if (i + 1 < k) mesh->triangles.push_back({in(n), out(o + 1), in(n + 1)});
    }
}

// Facing up at this height.
Mesh discOfRings(float radius, float height, int rings) {
  constexpr float kCrowding = 1.3f;
  Mesh mesh;
  mesh.positions.push_back({0, height, 0});
  for (int k = 1; k <= rings; ++k) {
    const float r = k == rings ? radius : radius * std::pow(fraction(k, rings), kCrowding);
    const uint32_t outer = static_cast<uint32_t>(mesh.positions.size());
    const uint32_t ring = static_cast<uint32_t>(k), inner = k == 1 ? 0 : outer - 6 * (ring - 1);
    for (int j = 0; j < 6 * k; ++j) {
      const Vec2f c = circle(j, 6 * k);
      mesh.positions.push_back({r * c.x, height, -r * c.y});
    }
    addRing(&mesh, inner, outer, ring);
  }
  for (const Vec3f p : mesh.positions)
    mesh.uvs.push_back(Vec2f(p.x + radius, p.z + radius) * (0.5f / radius));
  return creased(std::move(mesh), 180);
}

}  // namespace

Mesh cylinder(float radius, float height, float bevel, int bevelSegments, int segments) {
  std::vector<Vec2f> profile = cylinderProfile(radius, height, bevel, bevelSegments);
  profile.push_back({0, height});
  return lathe(profile, segments);
}

Mesh roundSlab(float radius, float height, float bevel, int bevelSegments, int rings) {
  const std::vector<Vec2f> profile = cylinderProfile(radius, height, bevel, bevelSegments);
  return merged({lathe(profile, 6 * rings), discOfRings(profile.back().x, height, rings)});
}

Mesh ball(float radius, int rows, int segments) {
  return revolve(
      [radius](float t) {
        return Vec2f(t <= 0 || t >= 1 ? 0 : std::sin(kPi * t), -std::cos(kPi * t)) * radius;
      },
      rows, segments);
}

Mesh disc(float radius, int segments, float inner) {
  return lathe({{radius, 0}, {inner, 0}}, segments);
}

Mesh superellipsoid(Vec3f halfExtent, float north, float east, int rows, int segments) {
  Mesh mesh;
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j <= segments; ++j) {
      const float latitude = kPi * (fraction(i, rows) - 0.5f);
      const bool pole = i == 0 || i == rows;
      const float ring = pole ? 0.f : std::pow(std::cos(latitude), north);
      const Vec2f c = circle(j, segments);
      mesh.positions.push_back(halfExtent * Vec3f(ring * signedPower(c.x, east),
                                                  pole ? std::copysign(1.f, latitude)
                                                       : signedPower(std::sin(latitude), north),
                                                  -ring * signedPower(c.y, east)));
      mesh.uvs.push_back({fraction(j, segments), fraction(i, rows)});
    }
  addGrid(mesh, 0, rows, segments);
  return creased(std::move(mesh), 180);
}

Mesh icosphere(int subdivisions, const std::function<float(Vec3f)>& radius) {
  const float g = 0.5f + 0.5f * std::sqrt(5.f);
  Mesh mesh;
  for (const float s : {1.f, -1.f})
    for (const float r : {g, -g}) {
      mesh.positions.push_back({0, s, r});
      mesh.positions.push_back({s, r, 0});
      mesh.positions.push_back({r, 0, s});
    }
  for (Vec3f& p : mesh.positions) p = normalize(p);
  // Faces: all triples of corners at the distance of neighbours.
  const float edge = 1.1f * 2 / std::sqrt(1 + g * g);
  const auto near = [&](uint32_t a, uint32_t b) {
    return length(mesh.positions[a] - mesh.positions[b]) < edge;
  };
  for (uint32_t a = 0; a < 12; ++a)
    for (uint32_t b = a + 1; b < 12; ++b)
      for (uint32_t c = b + 1; c < 12; ++c)
        if (near(a, b) && near(b, c) && near(c, a)) {
          const Vec3f p = mesh.positions[a], q = mesh.positions[b], r = mesh.positions[c];
          mesh.triangles.push_back(dot(cross(q - p, r - p), p) > 0 ? Vec3u(a, b, c)
                                                                   : Vec3u(a, c, b));
        }
  for (int k = 0; k < subdivisions; ++k) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [it, isNew] =
          middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(mesh.positions.size()));
      if (isNew) mesh.positions.push_back(normalize(mesh.positions[a] + mesh.positions[b]));
      return it->second;
    };
    std::vector<Vec3u> finer;
    for (const Vec3u t : mesh.triangles) {
      const uint32_t a = middle(t.x, t.y), b = middle(t.y, t.z), c = middle(t.z, t.x);
      for (const Vec3u part :
           {Vec3u(t.x, a, c), Vec3u(a, t.y, b), Vec3u(c, b, t.z), Vec3u(a, b, c)})
        finer.push_back(part);
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3f& p : mesh.positions) {
    mesh.uvs.push_back(
        {0.5f + std::atan2(p.z, p.x) / kTwoPi, std::acos(std::clamp(p.y, -1.f, 1.f)) * kInvPi});
    p *= radius(p);
  }
  return creased(std::move(mesh), -1);
}

Mesh heightfield(float sizeX, float sizeZ, int columns, int rows,
                 const std::function<float(Vec2f)>& heightAtUv) {
  Mesh mesh;
  // Rows run against z, so that they are right-handed seen from above.
  for (int i = 0; i <= rows; ++i)
    for (int j = 0; j <= columns; ++j) {
      const Vec2f uv{fraction(j, columns), 1 - fraction(i, rows)};
      mesh.positions.push_back({(uv.x - 0.5f) * sizeX, heightAtUv(uv), (uv.y - 0.5f) * sizeZ});
      mesh.uvs.push_back(uv);
    }
  addGrid(mesh, 0, rows, columns);
  return creased(std::move(mesh), -1);
}

}  // namespace lobelia::builtin
