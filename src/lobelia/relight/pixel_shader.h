// Reflected light of one pixel: its lobes summed over the light that its three vertices see
// [P004 eq. 5].
//
// Broad lobes take the nodes of the light cut; glossy ones take finer nodes within their reach
// (fine_light.h); mirrors show the environment itself, dimmed by the visibility of the sample in
// the mirror direction. Light from behind the geometric normal is dropped, and so are lobes that
// transmit: visibility is known in front of surfaces.
#pragma once

#include "lobelia/path/emitter_sampling.h"
#include "lobelia/relight/pixel_kernels.h"
#include "lobelia/relight/tile_rays.h"
#include "lobelia/relight/vertex_cache.h"

namespace lobelia::relight {

struct PixelCounts {
  uint64_t evaluations = 0;  // of lobes for directions
  uint64_t fineChunks = 0;   // shaded
};

// For one thread.
class PixelShader {
 public:
  // Keeps references. lookup: of the light samples. refined: off, all lobes take the light cut.
  void begin(const FrameLight& light, const EmitterSampler& emitters, const DirectionLookup& lookup,
             bool refined, VertexCache* vertices);
  Rgb reflected(const Bsdf& bsdf, Vec3f wo, const PixelPlace& place);

  PixelCounts counts;

 private:
  Rgb lobeSum(const LobeQuery& query);
  Rgb refinedSum(const LobeQuery& query, const FineUnits& units, float radius);
  Rgb mirrored(const LobeQuery& query);
  bool isLit(const FineUnits& units, uint32_t unit) const;
  void appendFine(const FineUnits& units, uint32_t unit);
  void excludeNodes(uint32_t begin, uint32_t end);

  const FrameLight* light_ = nullptr;
  const EmitterSampler* emitters_ = nullptr;
  const DirectionLookup* lookup_ = nullptr;
  bool refined_ = true;
  VertexCache* vertices_ = nullptr;

  // Of the pixel.
  PixelPlace place_{};
  Vec3f normal_;
  DirectedLight coarse_, fine_;
  std::vector<uint16_t> masks_;     // by chunk of coarse_
  std::vector<uint32_t> position_;  // by chunk of the cut: in coarse_, or kAbsent
  std::vector<uint32_t> units_;
};

}  // namespace lobelia::relight
