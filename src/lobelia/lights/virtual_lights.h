// Virtual light records [P000 section 3; Hasan09 section 3.2]. Small, plain, in arrays by class.
#pragma once

#include <string>
#include <vector>

#include "lobelia/base/vec.h"

namespace lobelia {

// Uniform intensity in all directions, W/sr. Of all but plain points, `emitter` (0xffffffff: none)
// gives the pattern that multiplies it: EmissionPattern::at(); the intensity is its base().
struct OmniLight {
  Vec3f p;
  Rgb intensity;
  uint32_t emitter;
};
// Irradiance on a plane facing it; direction points to where the light comes from. emitter: what
// it stands for (of several environments of a light group, the first), 0xffffffff: unknown.
struct DirectionalLight {
  Vec3f direction;
  Rgb irradiance;
  uint32_t emitter = 0xffffffffu;
};
// Cosine lobe: intensity * max(0, n.w), W/sr. Normal octahedral, 2 x 16 bits (error < 5e-5 rad).
struct DiffuseLight {
  Vec3f p;
  Rgb intensity;
  uint32_t normal;
  uint32_t tag;  // depth in the low 8 bits, group above
};
static_assert(sizeof(DiffuseLight) == 32);
// Spherical-Gaussian lobe clipped at its surface: intensity exp(sharpness (axis.w - 1)) where
// n.w > 0.
struct GlossyLight {
  Vec3f p;
  Vec3f n;
  Vec3f axis;
  Rgb intensity;
  float sharpness;
};
static_assert(sizeof(GlossyLight) == 52);

// Virtual spherical light [Hasan09 section 3.2]: power that arrived at a surface, spread over what
// of it lies within `radius`, to be scattered by the surface's own rough lobes. The surface is
// named by the hit, from which its BSDF is made again (makeBsdf() seen from `arriving`).
struct SphericalLight {
  Vec3f p;
  Rgb power;          // W, per particle
  float radius = 0;   // 0: not chosen yet (chooseRadii())
  uint32_t arriving;  // octahedral: where the power came from, leaving the surface
  uint32_t instance, triangle;
  float b1, b2;
  // Cells of the disc in the tangent plane that lie on the surface (spherical_coverage.h).
  uint32_t coverage[2];
  uint16_t group;
  uint16_t depth;
};
static_assert(sizeof(SphericalLight) == 60);

// How spherical lights are evaluated [Hasan09 section 3.2, 3.3; docs/manual.md].
struct SphereShading {
  // Which directions in the cone of the sphere count: those that meet the disc in the tangent plane
  // (planar), or all, with a cosine at the light for those that pass by the surface (the paper's).
  enum class Indicator : uint8_t { planar, cosine };
  // product: disc, cone or hemisphere, mixed with the product of both ends' Gaussians; paper: cone
  // and both BSDFs by the balance heuristic; cone: as many directions as those, of the cone alone
  // (figure 5 there; for studies).
  enum class Sampling : uint8_t { product, paper, cone };
  Indicator indicator = Indicator::planar;
  Sampling sampling = Sampling::product;
  int maxSamples = 16;  // of a pair whose lobes overlap with a whole hemisphere
  // Which receivers a light reaches: all, or those within `nearField` of its radii, or those beyond
  // (gather/near_field.h).
  enum class Reach : uint8_t { all, nearField, farField };
  Reach reach = Reach::all;
  float nearField = 0;
};

// Virtual spherical Gaussian light [Tokuyoshi15; P001 supplement, section 3]: a cluster of point
// lights with the first moments of what leaves them and the second of where they are.
struct GaussianLight {
  Vec3f mean;                // of the places, by power
  float covariance[6] = {};  // of the places, by power: xx, yy, zz, xy, xz, yz
  // W, what leaves by cosine lobes, whose normals are distributed as a von Mises-Fisher lobe is.
  Rgb diffuse{};
  Vec3f normal{0, 0, 1};
  float normalSharpness = 0;
  Rgb glossy{};  // W, what leaves by the Gaussian, above the surfaces
  Vec3f axis{0, 0, 1};
  float sharpness = 0;
  // Points of the cluster, for shadow rays: the first is the nearest to the mean, the others are
  // drawn by power. Normals octahedral, of the sides that light leaves.
  struct Place {
    Vec3f p;
    uint32_t normal = 0;
  };
  static constexpr int kPlaces = 4;
  Place places[kPlaces];
  float variance() const { return covariance[0] + covariance[1] + covariance[2]; }
  uint16_t group = 0;
  uint16_t depth = 0;
};
static_assert(sizeof(GaussianLight) == 160);

// How VSGLs are evaluated (docs/manual.md).
struct GaussianShading {
  // accurate: cosines at both ends are integrated over the Gaussians, lobes of receivers are
  // widened by them (gather/gaussian-inl.h). The paper's two: diffuse receivers by the product of
  // Gaussians, or by the cosine pulled out of the integral; glossy ones by anisotropic Gaussians
  // [P001 supplement, section 4.2].
  enum class Form : uint8_t { accurate, product, pulled };
  Form form = Form::accurate;
  // Where shadow rays end: at the place nearest to the mean, or at one of the places at random.
  enum class Ends : uint8_t { random, mean };
  Ends ends = Ends::mean;
  // Variance of places across the view: projected of the covariance, or half of its trace.
  bool projected = true;
  float spread = 1;  // factor of the variance; 2 with half of the trace is the paper's equation 3
  // Means of Gaussians by Toksvig's formula, as the paper has them, instead of exact ones.
  bool toksvig = false;
};

// Lights of one class are sorted by depth, and those of a depth, unless an older file has them,
// along a Morton curve: depthEnds[d] is the number of lights with depth <= d, where depth is the
// number of edges between the emitter and the light (0: on the emitter itself).
struct VirtualLights {
  std::string model;  // "vpl", "glossy", "vsl", "vsgl", "richvpl"
  std::vector<OmniLight> omni;
  std::vector<DirectionalLight> directional;
  std::vector<DiffuseLight> diffuse;
  std::vector<GlossyLight> glossy;
  std::vector<SphericalLight> spherical;
  std::vector<GaussianLight> gaussian;
  std::vector<uint32_t> diffuseDepthEnds, glossyDepthEnds, sphericalDepthEnds, gaussianDepthEnds;
  // Light groups (LightGroups): their names, and the group of every light as an index into them;
  // parallel to the lights, for diffuse, spherical and Gaussian lights in them. Empty: all lights
  // are of group 0.
  std::vector<std::string> groups;
  std::vector<uint16_t> omniGroups, directionalGroups, glossyGroups;
  uint64_t sceneHash = 0;
  uint64_t seed = 0;
  uint64_t particles = 0;  // emitted
  // How they were made (LightSettings): what a renderer that uses them must agree with.
  int maxDepth = -1;
  float specularLimit = 0;
  bool direct = false;  // emitters themselves are among them
  // Not kept in files.
  SphereShading sphereShading;
  GaussianShading gaussianShading;
  size_t size() const {
    return omni.size() + directional.size() + diffuse.size() + glossy.size() + spherical.size() +
           gaussian.size();
  }
};

uint32_t encodeOctahedral(Vec3f unit);
Vec3f decodeOctahedral(uint32_t code);

}  // namespace lobelia
