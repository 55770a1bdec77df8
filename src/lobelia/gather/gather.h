// Gather strategies: light of virtual lights at receivers.
#pragma once

#include <span>

#include "lobelia/gather/recorded_cut.h"
#include "lobelia/lights/virtual_lights.h"
#include "lobelia/path/receivers.h"

namespace lobelia {

namespace gather {
class DepthMaps;
class RichRadiance;
}

struct GatherSettings {
  // Upper limit of (light lobe / d^2) x receiver lobes with their cosine, by the largest channel of
  // the product; one factor for all channels. 0: off. Directional lights are not clamped.
  float clamp = 0;
  int maxDepth = -1;  // of whole paths: receiver's depth + 1 + light's depth; -1: no limit
  // Do lights on emitters themselves (depth 0; omni and directional lights are) count? false where
  // the eye pass has added direct light (--direct nee): such lights are left out.
  bool direct = false;
  // Of spherical Gaussian lights, gatherAll() alone: shadow rays of a receiver, to lights chosen by
  // what they would send it (shadow_choice.h); 0: all is visible; below 0: one to every light.
  int shadowRays = -1;
  // Of the same, by gatherAll() alone: shadow maps of the lights in place of rays; null: rays.
  const gather::DepthMaps* depthMaps = nullptr;
  // Only the tiles that hold a receiver of this pixel are gathered (--replay): these get the
  // same bits, others the same or nothing.
  static constexpr uint32_t kAllPixels = 0xffffffffu;
  uint32_t onlyPixel = kAllPixels;
  // What diffuse light i sends out in place of its cosine lobe (rich_radiance.h); null: the lobe.
  const gather::RichRadiance* rich = nullptr;
};

// Is the pixel (or any: kAllPixels) that of a point in [begin, end)?
bool holdsPixel(const Receivers& receivers, size_t begin, size_t end, uint32_t pixel);

// Parts of what is gathered, when asked for. The whole sum is computed all the same, to the same
// bits; parts cost their shading once more, of Lightcuts and its kin, which shade what they trace,
// also its rays.
struct GatherParts {
  // Light's class x receiver's lobes: diffuse (with sheen and diffuse transmission) or glossy.
  static constexpr size_t kTypes = 12;  // [2 * class + lobes], classes in the order of LightClass
  size_t groupCount = 0;                // of VirtualLights::groups; 0: not asked for
  bool byType = false, countRays = false;
  bool recordCuts = false;  // of strategies that have some (--export-trees)
  // Set, not added to, by gatherAll().
  std::vector<Rgb> groups;     // [group * points + point]
  std::vector<Rgb> types;      // [type * points + point]
  std::vector<uint32_t> rays;  // shadow rays of a point
  std::vector<RecordedCut> cuts;
  // Room for so many points.
  void reset(size_t points);
  // What a gather in an order of its own has found: its point i is order[i] of `points`.
  void setOrdered(const GatherParts& from, const std::vector<uint32_t>& order, size_t points);
};

// Adds to radiance[i] the light that receiver point i sends to its pixel (weight included) from all
// lights. Counts "shadow_rays", "node_pairs_shaded" (pairs found visible) and "nonfinite" (pairs
// left out because their value was not finite; the first pixel with one: noteNonFinitePixel());
// books seconds to "visibility" and "shade". When cancelled, a point has its whole sum or nothing
// added. parts: see there; null: none.
void gatherAll(const Tracer& tracer, const Receivers& receivers, const VirtualLights& lights,
               const GatherSettings& settings, std::span<Rgb> radiance, Context& context,
               GatherParts* parts = nullptr);

}  // namespace lobelia
