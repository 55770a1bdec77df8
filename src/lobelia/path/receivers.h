// Eye pass: where the picture needs light (docs/architecture.md, "Receivers").
//
// An eye path runs through sharp lobes until it meets rough ones: that point is a receiver. From a
// receiver one BSDF sample of the rough lobes goes on only if the next surface has sharp lobes; it
// follows them to an emitter (a specular connection) or to a further receiver of the same pixel.
//
// Where virtual lights are too sparse (EyeSettings::nearDistance) the gather leaves out what is
// near a receiver, and the samples of its rough lobes find it: a rough surface that they meet
// nearby is a further receiver.
#pragma once

#include <algorithm>
#include <functional>

#include "lobelia/bsdf/lobe.h"
#include "lobelia/path/path_tracer.h"

namespace lobelia {

// A point that gathers. A surface whose lobes lie in several frames leaves one in each. Its rough
// lobes are lobes[firstLobe, firstLobe + lobeCount).
struct ReceiverPoint {
  Vec3f p;
  Vec3f ng;          // geometric normal, outside
  Frame frame;       // shading frame
  Vec3f baseNormal;  // these two as in Bsdf and its frame; the normal is read where bumpAlpha2 > 0
  float bumpAlpha2 = 0;
  Vec3f wo;            // towards the eye
  Rgb weight;          // factor to the pixel's value: throughput / samples
  float error = 0;     // position error for offsetOrigin
  uint32_t pixel = 0;  // index into the data window
  uint32_t firstLobe = 0;
  uint8_t lobeCount = 0;
  uint8_t depth = 1;       // edges from the camera (Mitsuba's depth of this vertex)
  bool primary = true;     // first receiver of its eye path: its emitter light is "direct"
  float nearDistance = 0;  // lights nearer count by gatheredShare() only
};

// Share of a light on a surface that a receiver at this distance gathers; it finds the rest by its
// own samples. Exactly 0 up to half of nearDistance, 1 from nearDistance (0: all of it) on.
inline float gatheredShare(float distance, float nearDistance) {
  return nearDistance > 0 ? std::clamp(2 * distance / nearDistance - 1, 0.f, 1.f) : 1.f;
}

struct Receivers {
  std::vector<ReceiverPoint> points;  // in tile order: neighbours in the array are near on screen
  std::vector<Lobe> lobes;
};

// The rough lobes of a point as a BSDF: their sum is what the point scatters to its wo.
Bsdf receiverBsdf(const Receivers& receivers, const ReceiverPoint& point);

struct EyeSettings {
  int sample = 0;       // index of the sample of each pixel
  int sampleCount = 1;  // total (for the weight)
  int maxDepth = -1;
  float specularLimit = 0.08f;
  int directSamples = 4;  // emitter samples per receiver (near ones: 1); 0: --direct lights
  // Samples of the rough lobes, per receiver (near ones: 1), for specular connections and what is
  // near.
  int connectionSamples = 4;
  bool hideEmitters = false;
  Component component = Component::all;  // what the layers of light groups hold
  PixelSet pixels;
  // ReceiverPoint::nearDistance of a receiver here; empty: 0.
  std::function<float(Vec3f)> nearDistance;
};

// One sample of every pixel of the rows [y0, y1) of the data window (or of the chosen pixels in
// them). Adds emission, direct light (next-event estimation with MIS) and specular connections to
// film's layers "direct" and "indirect" (and, when present, to "specular", LightGroups::layer() of
// every group, and "cost": rays traced, as a mean over all samples), and returns the receivers
// whose indirect light remains to be gathered.
Receivers traceReceivers(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                         const EyeSettings& settings, int y0, int y1, Film& film, Context& context);

// A sample of this pixel was not finite: sets "first_nonfinite_pixel" to 1 + the smallest pixel of
// all calls, which --replay can show.
void noteNonFinitePixel(uint32_t pixel, Context& context);

}  // namespace lobelia
