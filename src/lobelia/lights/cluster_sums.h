// What a cluster of point lights adds up to, and the virtual spherical Gaussian light of it.
//
// All sums are additive: of texels of a map and its coarser levels, of members of a cluster, of
// children of a node [P001 supplement, section 3]. Powers are kept in colour, directions and places
// are weighted by luminance.
//
// Deviations: means of Gaussians are exact (lobes::meanResultant) unless the paper's, Toksvig's,
// are asked for; of diffuse light the normals are kept, not lobes: the paper's lobe of one is a
// Gaussian of sharpness 2, whose mean by Toksvig, 2/3, is exactly that of a cosine lobe; the whole
// covariance of the places is kept, where the paper has its trace.
#pragma once

#include <span>

#include "lobelia/lights/light_point.h"
#include "lobelia/lights/virtual_lights.h"

namespace lobelia {

struct ClusterSums {
  double weight = 0;                           // luminance of the power
  Vec3d place{};                               // weight * p
  double square[6] = {};                       // weight * p pᵀ: xx, yy, zz, xy, xz, yz
  Vec3d side{};                                // weight * n
  Vec3d diffuse{}, glossy{};                   // powers, W
  double diffuseWeight = 0, glossyWeight = 0;  // their luminances
  Vec3d normal{};                              // diffuseWeight * n
  Vec3d axis{};                                // glossyWeight * mean resultant * axis

  static ClusterSums of(const LightPoint& point, bool toksvig);
  ClusterSums& operator+=(const ClusterSums& o);
  ClusterSums& operator*=(double factor);
  // Without places to send shadow rays to; weight > 0.
  GaussianLight light(bool toksvig) const;
};

// Sums of `points` chosen by index, and the light of them with its places; seed: of the drawn ones.
// Group and depth are the first point's. At least one of them must have power.
GaussianLight clusterLight(std::span<const LightPoint> points, std::span<const uint32_t> members,
                           bool toksvig, uint64_t seed);
// Sets the places of a light from points that stand for it: the one nearest to the mean, others by
// power.
void choosePlaces(std::span<const LightPoint> points, std::span<const uint32_t> members,
                  uint64_t seed, GaussianLight* light);

// Makes the places vary by at least this (trace), in the plane across the normal.
void widen(float leastVariance, GaussianLight* light);

// Which points belong together: cluster k has order[ends[k - 1], ends[k]).
struct Clusters {
  std::vector<uint32_t> order, ends;
};
std::vector<GaussianLight> clusterLights(std::span<const LightPoint> points,
                                         const Clusters& clusters, bool toksvig, uint64_t seed);

}  // namespace lobelia
