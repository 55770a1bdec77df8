// Sums over clusters of point lights and the virtual spherical Gaussian lights of them.
//
// Sums are in double. Of a whole cluster the places are summed as differences from one of its
// points, and their covariance in a second pass about the mean: the difference of large squares
// would leave nothing of the extent of a small cluster far from the origin. Sums that only know
// their squares (levels of a map) have that difference, without what rounding makes of it.
#include "lobelia/lights/cluster_sums.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "lobelia/base/parallel.h"
#include "lobelia/base/random.h"
#include "lobelia/lobes/spherical_gaussian.h"

namespace lobelia {
namespace {

constexpr double kMaxSharpness = 1e7;  // as lobes::lobeOf()

Vec3d toDouble(Vec3f v) { return {double{v.x}, double{v.y}, double{v.z}}; }
Vec3f toFloat(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// Toksvig's pair belongs together, and so do the exact ones: the forward formula of one and the
// backward formula of the other would not give a lone lobe back.
double resultantOf(double sharpness, bool toksvig) {
  return toksvig ? sharpness / (sharpness + 1) : lobes::meanResultant(sharpness);
}
float sharpnessOf(double resultant, bool toksvig) {
  const double r = std::min(resultant, 1.0);
  const double sharpness = toksvig ? r / (1 - r) : lobes::inverseMeanResultant(r);
  return static_cast<float>(std::min(sharpness, kMaxSharpness));
}

// The lobe that a sum of weighted unit vectors, or means of lobes, stands for.
void setLobe(Vec3d sum, double weight, bool toksvig, Vec3f* axis, float* sharpness) {
  const double size = length(sum);
  if (!(size > 0) || !(weight > 0)) return;  // without direction: sharpness 0
  *axis = toFloat(sum / size);
  *sharpness = sharpnessOf(size / weight, toksvig);
}

// Order of GaussianLight::covariance.
constexpr int kRow[6] = {0, 1, 2, 0, 0, 1}, kColumn[6] = {0, 1, 2, 1, 2, 2};

void addSquare(double weight, Vec3d d, double* square) {
  for (int i = 0; i < 6; ++i) square[i] += weight * d[kRow[i]] * d[kColumn[i]];
}

// Covariance from means of squares about the origin. Differences that rounding alone could have
// made are none, and no covariance is larger than the variances allow.
void setCovariance(const double* meanSquare, Vec3d mean, float* covariance) {
  constexpr double kRounding = 16 * 0x1p-53;
  double c[6];
  for (int i = 0; i < 3; ++i) {
    c[i] = meanSquare[i] - mean[i] * mean[i];
    if (c[i] <= kRounding * meanSquare[i]) c[i] = 0;
  }
  for (int i = 3; i < 6; ++i) {
    const double most = std::sqrt(c[kRow[i]] * c[kColumn[i]]);
    c[i] = std::clamp(meanSquare[i] - mean[kRow[i]] * mean[kColumn[i]], -most, most);
  }
  for (int i = 0; i < 6; ++i) covariance[i] = static_cast<float>(c[i]);
}

}  // namespace

ClusterSums ClusterSums::of(const LightPoint& point, bool toksvig) {
  ClusterSums s;
  s.diffuseWeight = double{luminance(point.diffuse)};
  s.glossyWeight = double{luminance(point.glossy)};
  s.weight = s.diffuseWeight + s.glossyWeight;
  const Vec3d p = toDouble(point.p), n = normalize(toDouble(point.n));
  s.place = p * s.weight;
  addSquare(s.weight, p, s.square);
  s.side = n * s.weight;
  s.diffuse = toDouble(point.diffuse);
  s.glossy = toDouble(point.glossy);
  s.normal = n * s.diffuseWeight;
  if (s.glossyWeight > 0)  // axes of unit length in double: in float, sharp lobes would be lost
    s.axis = normalize(toDouble(point.axis)) *
             (s.glossyWeight * resultantOf(double{point.sharpness}, toksvig));
  return s;
}

ClusterSums& ClusterSums::operator+=(const ClusterSums& o) {
  weight += o.weight;
  place += o.place;
  for (int i = 0; i < 6; ++i) square[i] += o.square[i];
  side += o.side;
  diffuse += o.diffuse, glossy += o.glossy;
  diffuseWeight += o.diffuseWeight, glossyWeight += o.glossyWeight;
  normal += o.normal;
  axis += o.axis;
  return *this;
}

ClusterSums& ClusterSums::operator*=(double factor) {
  weight *= factor;
  place *= factor;
  for (double& s : square) s *= factor;
  side *= factor;
  diffuse *= factor, glossy *= factor;
  diffuseWeight *= factor, glossyWeight *= factor;
  normal *= factor;
  axis *= factor;
  return *this;
}

GaussianLight ClusterSums::light(bool toksvig) const {
  assert(weight > 0);
  GaussianLight light;
  const Vec3d mean = place / weight;
  double meanSquare[6];
  for (int i = 0; i < 6; ++i) meanSquare[i] = square[i] / weight;
  light.mean = toFloat(mean);
  setCovariance(meanSquare, mean, light.covariance);
  light.diffuse = toFloat(diffuse), light.glossy = toFloat(glossy);
  // A cluster without diffuse power has a side all the same.
  const bool hasDiffuse = diffuseWeight > 0;
  setLobe(hasDiffuse ? normal : side, hasDiffuse ? diffuseWeight : weight, toksvig, &light.normal,
          &light.normalSharpness);
  // Sides of what is not diffuse count where they spread more: light leaves on all of them.
  light.normalSharpness =
      std::min(light.normalSharpness, sharpnessOf(length(side) / weight, toksvig));
  setLobe(axis, glossyWeight, toksvig, &light.axis, &light.sharpness);
  return light;
}

GaussianLight clusterLight(std::span<const LightPoint> points, std::span<const uint32_t> members,
                           bool toksvig, uint64_t seed) {
  const LightPoint& first = points[members.front()];
  const Vec3d origin = toDouble(first.p);
  ClusterSums sums;
  Vec3d shifted{};
  for (const uint32_t i : members) {
    const ClusterSums one = ClusterSums::of(points[i], toksvig);
    sums += one;
    shifted += (toDouble(points[i].p) - origin) * one.weight;
  }
  const Vec3d mean = shifted / sums.weight;
  double square[6] = {};
  for (const uint32_t i : members)
    addSquare(double{points[i].power()}, toDouble(points[i].p) - origin - mean, square);
  GaussianLight light = sums.light(toksvig);
  light.mean = toFloat(origin + mean);
  for (int i = 0; i < 6; ++i) light.covariance[i] = static_cast<float>(square[i] / sums.weight);
  light.group = first.group, light.depth = first.depth;
  choosePlaces(points, members, seed, &light);
  return light;
}

void choosePlaces(std::span<const LightPoint> points, std::span<const uint32_t> members,
                  uint64_t seed, GaussianLight* light) {
  constexpr int kDrawn = GaussianLight::kPlaces - 1;
  double total = 0;
  uint32_t nearest = members.front();
  float least = std::numeric_limits<float>::infinity();
  for (const uint32_t i : members) {
    if (!(points[i].power() > 0)) continue;
    total += double{points[i].power()};
    const float distance = lengthSquared(points[i].p - light->mean);
    if (distance < least) least = distance, nearest = i;
  }
  uint32_t chosen[GaussianLight::kPlaces] = {nearest, nearest, nearest, nearest};
  Rng random(seed);
  double sum = 0;
  int drawn = 0;
  double next = total * double{random.next1D()} / kDrawn;
  for (const uint32_t i : members) {
    if (!(points[i].power() > 0)) continue;
    sum += double{points[i].power()};
    for (; drawn < kDrawn && next < sum; ++drawn) {
      chosen[1 + drawn] = i;
      next = total * (drawn + 1 + double{random.next1D()}) / kDrawn;
    }
  }
  for (int k = 0; k < GaussianLight::kPlaces; ++k)
    light->places[k] = {points[chosen[k]].p, encodeOctahedral(points[chosen[k]].n)};
}

void widen(float leastVariance, GaussianLight* light) {
  float* c = light->covariance;
  const float missing = leastVariance - light->variance();
  if (!(missing > 0)) return;
  const Vec3f n = light->normal;
  const float half = 0.5f * missing;  // for each of the two directions of the plane
  c[0] += half * (1 - n.x * n.x), c[1] += half * (1 - n.y * n.y), c[2] += half * (1 - n.z * n.z);
  c[3] -= half * n.x * n.y, c[4] -= half * n.x * n.z, c[5] -= half * n.y * n.z;
}

std::vector<GaussianLight> clusterLights(std::span<const LightPoint> points,
                                         const Clusters& clusters, bool toksvig, uint64_t seed) {
  std::vector<GaussianLight> lights(clusters.ends.size());
  parallelFor(lights.size(), 16, [&](size_t k) {
    const size_t begin = k == 0 ? 0 : clusters.ends[k - 1];
    const std::span members(clusters.order.data() + begin, clusters.ends[k] - begin);
    lights[k] = clusterLight(points, members, toksvig, hashCombine(seed, k));
  });
  return lights;
}

}  // namespace lobelia
