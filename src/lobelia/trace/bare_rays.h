// Embree alone: loops over prepared rays that do nothing else. What the program makes of Embree's
// speed is judged by these (`lobelia bench rates`). One thread; callers run several.
#pragma once

#include <vector>

#include "lobelia/trace/tracer.h"

namespace lobelia {

struct TracedRay {
  Ray ray;
  bool shadow = false;  // asks whether there is a hit, not for the nearest
};

// Rays as they were asked for: alone or in packets.
struct TracedRays {
  struct Query {
    uint32_t index;  // into rays, or into packets
    bool packet, shadow;
  };
  std::vector<TracedRay> rays;  // all, those of packets lane by lane
  std::vector<ShadowPacket> packets;
  std::vector<Query> queries;
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
  // The same rays in the packets that they were asked for in.
  uint64_t hits(const TracedRays& rays) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lobelia
