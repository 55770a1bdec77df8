// Places on the scene's surfaces, evenly spread by area [P004 section 4.1].
//
// Deviation: instead of repulsion, which would have to follow surfaces over edges, more random
// places than are wanted are drawn, and those that lie closest to others are taken away one by one
// (weighted sample elimination [Yuksel15]; its weights and radius). Places whose normals point
// apart do not see each other, so that thin bodies keep both of their sides. Where much area is in
// little space, as in foliage, the radius is smaller (PointGrid::uncrowded()): the work stays in
// proportion to the samples, and they are less even.
#include <cmath>
#include <queue>

#include "lobelia/base/error.h"
#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/relight/light_samples.h"
#include "lobelia/relight/point_grid.h"
#include "lobelia/relight/visibility_data.h"
#include "lobelia/scene/shading.h"

namespace lobelia::relight {
namespace {

constexpr uint64_t kStream = 0x73757266;  // of the surfaces' random numbers
// Cosine of the angle between normals beyond which places do not see each other. Both sides of a
// right angle do: samples would gather along edges.
constexpr float kApart = -0.5f;
constexpr size_t kCandidates = 5;  // for every sample wanted [Yuksel15 section 3]

// Triangles of all instances with the area they add; both sides of those that scatter behind.
struct AreaTable {
  struct Face {
    uint32_t instance, triangle;
    bool both;
  };
  std::vector<Face> faces;
  std::vector<double> end;  // sum of areas up to and with each face
  double total() const { return end.empty() ? 0 : end.back(); }
};

AreaTable areas(const Scene& scene) {
  AreaTable table;
  double sum = 0;
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    const Mesh& mesh = scene[instance.mesh];
    const bool both = scattersBehind(scene, instance.material);
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      Vec3f p[3];
      for (int k = 0; k < 3; ++k)
        p[k] = instance.toWorld.point(mesh.positions[mesh.triangles[t][k]]);
      const double area = 0.5 * static_cast<double>(length(cross(p[1] - p[0], p[2] - p[0])));
      if (!(area > 0) || !std::isfinite(area)) continue;
      sum += both ? 2 * area : area;
      table.faces.push_back({i, t, both});
      table.end.push_back(sum);
    }
  }
  return table;
}

struct Places {
  std::vector<Vec3f> p, n;
};

// One in each of `count` equal parts of the area.
Places drawn(const Scene& scene, const AreaTable& table, size_t count, uint64_t seed) {
  Places places{std::vector<Vec3f>(count), std::vector<Vec3f>(count)};
  parallelFor(count, 1024, [&](size_t i) {
    Sampler random(hashCombine(seed, kStream), i, 0);
    const double at = (static_cast<double>(i) + static_cast<double>(random.next1D())) *
                      table.total() / static_cast<double>(count);
    const auto end = std::upper_bound(table.end.begin(), table.end.end() - 1, at);
    const AreaTable::Face& face = table.faces[static_cast<size_t>(end - table.end.begin())];
    const Vec2f b = sampleTriangleUniform(random.next2D());
    const SurfacePoint point = surfacePoint(scene, {0, b.x, b.y, face.instance, face.triangle});
    const bool behind = face.both && random.next1D() < 0.5f;
    places.n[i] = behind ? -point.ng : point.ng;
    places.p[i] = point.p + places.n[i] * point.error;
  });
  return places;
}

// Takes places away until `count` are left; returns those left, ascending.
std::vector<uint32_t> eliminated(const Places& places, double area, size_t count) {
  const double spread = std::sqrt(area / static_cast<double>(count) / (2 * std::sqrt(3.0)));
  const float reach = PointGrid::uncrowded(places.p, static_cast<float>(2 * spread));
  const PointGrid grid(places.p, reach);
  const auto weight = [&](uint32_t i, uint32_t j) {
    if (i == j || dot(places.n[i], places.n[j]) < kApart) return 0.f;
    const float close = 1 - length(places.p[i] - places.p[j]) / reach;
    return sqr(sqr(sqr(std::max(0.f, close))));
  };
  const size_t total = places.p.size();
  std::vector<float> weights(total);
  parallelFor(total, 256, [&](size_t i) {
    grid.near(places.p[i], [&](uint32_t j) { weights[i] += weight(static_cast<uint32_t>(i), j); });
  });
  // Weights only fall; an entry that says more than its place now has is put back.
  std::priority_queue<std::pair<float, uint32_t>> heaviest;
  for (uint32_t i = 0; i < total; ++i) heaviest.emplace(weights[i], i);
  std::vector<uint8_t> gone(total, 0);
  for (size_t left = total; left > count;) {
    const float claimed = heaviest.top().first;
    const uint32_t i = heaviest.top().second;
    heaviest.pop();
    if (claimed > weights[i]) {
      heaviest.emplace(weights[i], i);
      continue;
    }
    gone[i] = 1, --left;
    grid.near(places.p[i], [&](uint32_t j) {
      if (gone[j] == 0) weights[j] -= weight(i, j);
    });
  }
  std::vector<uint32_t> kept;
  for (uint32_t i = 0; i < total; ++i)
    if (gone[i] == 0) kept.push_back(i);
  return kept;
}

}  // namespace

LightSamples surfaceSamples(const Scene& scene, size_t count, uint64_t seed) {
  requireSampleCount(count);
  const AreaTable table = areas(scene);
  if (!(table.total() > 0))
    throw InputError({scene.file}, "the scene has no surfaces to take light samples on");
  const Places places = drawn(scene, table, kCandidates * count, seed);
  LightSamples samples;
  samples.kind = LightSamples::Kind::surfaces;
  for (const uint32_t i : eliminated(places, table.total(), count)) {
    samples.p.push_back(places.p[i]);
    samples.n.push_back(places.n[i]);
  }
  samples.measure.assign(count, static_cast<float>(table.total() / static_cast<double>(count)));
  return samples;
}

}  // namespace lobelia::relight
