// Embree alone: loops over prepared rays that do nothing else. What the program makes of Embree's
// speed is judged by these (`lobelia bench rates`). One thread; callers run several.
#pragma once

#include "lobelia/trace/tracer.h"

namespace lobelia {

struct TracedRay {
  Ray ray;
  bool shadow = false;  // asks whether there is a hit, not for the nearest
};

class BareRays {
 public:
  BareRays(const Scene& scene, Context& context);  // keeps no reference to the context
  ~BareRays();
  BareRays(const BareRays&) = delete;
  BareRays& operator=(const BareRays&) = delete;

  // Number of active lanes that nothing blocks.
  uint64_t visible(std::span<const ShadowPacket> packets, bool coherent) const;
  // Number of rays that hit something, each traced alone.
  uint64_t hits(std::span<const TracedRay> rays) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobelia
