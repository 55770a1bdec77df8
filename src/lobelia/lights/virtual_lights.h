// Virtual light records [P000 section 3]. Small, plain, in arrays by class.
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

// Lights of one class are sorted by depth: depthEnds[d] is the number of lights with depth <= d,
// where depth is the number of edges between the emitter and the light (0: on the emitter itself).
struct VirtualLights {
  std::string model;  // "vpl", "glossy"
  std::vector<OmniLight> omni;
  std::vector<DirectionalLight> directional;
  std::vector<DiffuseLight> diffuse;
  std::vector<GlossyLight> glossy;
  std::vector<uint32_t> diffuseDepthEnds, glossyDepthEnds;
  // Light groups (LightGroups): their names, and the group of every light as an index into them;
  // parallel to the lights, for diffuse lights in their tag. Empty: all lights are of group 0.
  std::vector<std::string> groups;
  std::vector<uint16_t> omniGroups, directionalGroups, glossyGroups;
  uint64_t sceneHash = 0;
  uint64_t seed = 0;
  uint64_t particles = 0;  // emitted
  // How they were made (LightSettings): what a renderer that uses them must agree with.
  int maxDepth = -1;
  float specularLimit = 0;
  bool direct = false;  // emitters themselves are among them
  size_t size() const { return omni.size() + directional.size() + diffuse.size() + glossy.size(); }
};

uint32_t encodeOctahedral(Vec3f unit);
Vec3f decodeOctahedral(uint32_t code);

}  // namespace lobelia
