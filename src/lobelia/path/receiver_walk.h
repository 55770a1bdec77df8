// One eye path with its branches: the inner loop of the eye pass (path/receivers.h).
#pragma once

#include "lobelia/base/random.h"
#include "lobelia/bsdf/bsdf.h"
#include "lobelia/path/direct_light.h"
#include "lobelia/path/receivers.h"

namespace lobelia {

// No path is longer, whatever the settings: ReceiverPoint::depth has 8 bits. Paths that end here
// are counted in "paths_cut".
inline constexpr int kMaxEyeDepth = 200;

// What one pixel's sample adds to the film.
struct EyeSample {
  Rgb direct, indirect;
  Rgb specular;      // the part of `indirect` that came over specular connections
  bool hit = false;  // the fields below are of the first surface
  Rgb albedo;
  Vec3f normal;
  float depth = 0;
  float weight = 0;         // of the film sample
  std::vector<Rgb> groups;  // direct + indirect by light group; empty when not asked for
};

struct EyeCounts {
  uint64_t pathRays = 0, shadowRays = 0, specularConnections = 0, nearReceivers = 0, cut = 0,
           nonFinite = 0;
};

// A ray on its way, with what must be known of its start.
struct EyeSegment {
  enum class Kind : uint8_t {
    eye,       // from the camera, so far only through sharp lobes
    receiver,  // by the rough lobes of a receiver
    chain,     // by sharp lobes, some way behind a receiver
  };
  Ray ray;
  Kind kind = Kind::eye;
  bool direct = true;       // light found straight at its end is "direct"
  bool connection = false;  // ... or belongs to a specular connection
  int depth = 0;            // edges between the camera and its start
  Rgb throughput;           // factor to the pixel's value
  float etaScale = 1;       // undoes refraction's change of radiance, for Russian roulette
  // For the weight against next-event estimation at its start; pdf 0: there was none.
  LightQuery origin;
  float pdf = 0;
  float nearDistance = 0;  // of the receiver at its start
};

class EyeWalk {
 public:
  // byGroup: fill EyeSample::groups?
  EyeWalk(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
          const EyeSettings& settings, uint64_t seed, bool byGroup = false);

  // Pixel (x, y) of the full film; `pixel` is its index in the data window. Receivers are appended.
  EyeSample trace(int x, int y, uint32_t pixel, Receivers* receivers, EyeCounts* counts) const;

 private:
  struct State;  // of one call
  struct Vertex;
  void step(EyeSegment segment, State* state) const;
  // hit: null when the ray escaped.
  void addEmission(const EyeSegment& segment, const SurfacePoint* hit, Rgb radiance,
                   State* state) const;
  // Adds to the layers that the segment's flags name. Clears State::arrived, light by group, which
  // times `factor` is `light`.
  void addLight(const EyeSegment& segment, Rgb light, Rgb factor, State* state) const;
  void receive(const EyeSegment& segment, const Vertex& vertex, State* state) const;
  void receiveNear(EyeSegment segment, const Vertex& vertex, State* state) const;
  void extend(const EyeSegment& segment, const Vertex& vertex, State* state) const;
  Rgb nextEvent(const Vertex& vertex, LobeSet set, int sampleCount, State* state) const;
  void record(const EyeSegment& segment, const Vertex& vertex, float nearDistance,
              State* state) const;
  // Queues what sample(bsdf, set) finds; kind and the flags are the caller's.
  void scatter(const EyeSegment& from, const Vertex& vertex, LobeSet set, EyeSegment next,
               State* state) const;
  // Factor to the pixel's value relative to a sample's full weight.
  float importance(const EyeSegment& segment) const;
  bool mayEnd(int edges) const { return settings_.maxDepth < 0 || edges <= settings_.maxDepth; }

  const Tracer& tracer_;
  const EmitterSampler& emitters_;
  const Camera& camera_;
  const EyeSettings& settings_;
  uint64_t seed_;
  bool byGroup_;
};

}  // namespace lobelia
