// A spherical light, unpacked for the kernels: the BSDF of its surface, seen from where its power
// came, and its disc.
#pragma once

#include "lobelia/bsdf/bsdf.h"
#include "lobelia/lights/spherical_coverage.h"
#include "lobelia/lights/virtual_lights.h"

namespace lobelia::gather {

// Gaussians by which directions are drawn; the value is the exact BSDF's.
inline constexpr int kSphereGaussians = 2;

struct PreparedSphere {
  Frame disc;  // n: geometric normal on the lit side
  float radius = 0, squaredRadius = 0;
  bool whole = true;  // the whole disc lies on the surface: all weights are 1
  std::array<float, kDiscCellCount> weights;  // cellWeights()

  // Rough lobes that act for power from `wi`. A lobe's factor takes the cosine to the shading
  // normal for the cosine to the geometric one: the radiance that leaves along w is
  //   power / area * sum over lobes of factor * f(w, wi) |cos(wi, n)|.
  struct LightLobe {
    Lobe lobe;
    Frame frame;
    Vec3f wi;  // in the frame
    float factor;
  };
  int lobeCount = 0;
  LightLobe lobes[kMaxLobes];

  // Of the cosine-like rest (radiance per power and area), and of the largest Gaussians: luminances
  // (diffuse, amplitude) and their colours.
  struct Gaussian {
    Vec3f axis;
    float sharpness, amplitude;
    Rgb color{};
  };
  float diffuse = 0;
  Rgb diffuseColor{};
  int gaussianCount = 0;
  Gaussian gaussians[kSphereGaussians];
  float sharpest = 0;  // of the lobes, across their thinner axis
  int halfLobe = -1;   // strongest of those that are drawn by their half vector (drawnByHalfVector)
  float random[3];     // in [0,1)
  bool transmits = false;
};

// Nothing where no rough lobe scatters the power.
void prepareSphere(const Scene& scene, const SphericalLight& light, float specularLimit,
                   PreparedSphere* sphere);

// Radiance that leaves the light's surface along w per unit of power and area, exactly; scalar twin
// of what the kernel does.
Rgb leavingRadiance(const PreparedSphere& sphere, Vec3f w);

// What directions are drawn by, of a BSDF for light from (or towards) w.
struct SamplingLobes {
  float diffuse = 0;   // luminance of the cosine-like part, per steradian
  Rgb diffuseColor{};  // the part itself
  int gaussianCount = 0;
  PreparedSphere::Gaussian gaussians[kSphereGaussians];  // strongest first
  float sharpest = 0;                                    // see PreparedSphere
  int halfLobe = -1;                                     // index into the BSDF's lobes
};
SamplingLobes samplingLobes(const Bsdf& bsdf, Vec3f w);

// Reflection by micro-normals of slopes that are Gaussian or GGX: anisotropic and grazing lobes,
// which no Gaussian of directions fits, are drawn exactly.
inline bool drawnByHalfVector(const Lobe& lobe) {
  return lobe.type == LobeType::ward || lobe.type == LobeType::microfacetReflection;
}

}  // namespace lobelia::gather
