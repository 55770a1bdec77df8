// Emitters in the scene, each of which lights a frame by places of its own: point-like ones by one,
// area emitters by a few [P004 section 4.2, "local lighting"].
//
// The path tracer draws one emitter among all; here every emitter is asked, so that light of points
// is free of noise and that of areas has that of a few places only. The price is a ray for each
// place: a scene with hundreds of emitters takes as many.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "lobelia/path/finite_lights.h"

namespace lobelia::relight {

// Is it one of these?
inline bool isLocal(EmitterType type) { return type == EmitterType::area || isPointLike(type); }

class LocalSources {
 public:
  // Keeps a reference to the scene, as it is now.
  explicit LocalSources(const Scene& scene);

  size_t count() const { return sources_.size(); }
  bool isPoint(size_t source) const { return sources_[source].point; }
  bool hasAreas() const { return areaCount_ > 0; }
  // Light from a place of the source (u: which, of no meaning for points) towards p; value is
  // divided by the density. Empty where nothing comes.
  std::optional<LightSample> sample(size_t source, Vec3f p, Vec2f u) const;

 private:
  struct Source {
    bool point = false;
    uint32_t light = 0;      // of lights_, the first
    std::vector<float> end;  // share of the area up to and with each triangle; empty: one light
  };
  void addArea(const Scene& scene, uint32_t instance, std::span<const float> shares);

  FiniteLights lights_;
  std::vector<Source> sources_;
  size_t areaCount_ = 0;
};

}  // namespace lobelia::relight
