#include "lobelia/app/receiver_sample.h"

namespace lobelia::app {
namespace {

int firstSample(const BandPlan& plan, int set) {
  int sample = 0;
  while (plan.set(sample) < set) ++sample;
  return sample;
}

}  // namespace

gather::RowPixels choosePixelSample(const Camera& camera, const BandPlan& plan, size_t pixels,
                                    uint64_t seed) {
  return gather::chooseRowPixels(camera.cropX1 - camera.cropX0, camera.cropY1 - camera.cropY0,
                                 plan.eye.pixels, pixels, seed);
}

Receivers traceSample(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                      const BandPlan& plan, int set, const PixelSet& pixels, Context& context) {
  Film shape;  // without layers: the receivers' own emission is of no interest
  shape.fullWidth = camera.width, shape.fullHeight = camera.height;
  shape.x0 = camera.cropX0, shape.y0 = camera.cropY0;
  shape.width = camera.cropX1 - camera.cropX0;
  shape.height = camera.cropY1 - camera.cropY0;
  EyeSettings eye = plan.eye;
  eye.sample = firstSample(plan, set);
  eye.pixels = pixels;
  eye.directSamples = 0;
  return traceReceivers(tracer, emitters, camera, eye, 0, shape.height, shape, context);
}

}  // namespace lobelia::app
