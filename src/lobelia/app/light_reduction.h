// What a gather strategy makes of a set of lights before receivers gather them: --gather mrcs puts
// few lights in the place of many.
#pragma once

#include "lobelia/app/band_plan.h"
#include "lobelia/gather/mrcs.h"

namespace lobelia::app {

// Of all sets; plain, as checkpoints keep it. [0]: lights of emitters, [1]: of bounces.
struct ReductionReport {
  uint64_t sets = 0;
  uint64_t columns = 0, rows = 0, sketch = 0;  // columns: sum over the sets
  double squaredError[2] = {};                 // relative, sum over the sets
  // Predicted relative error of the mean over the sets, which are independent.
  double error(int part) const;
};

// Throws UsageError where --sketch is not as it must be.
void requireSketch(const RenderOptions& options);
// Lights of a set that are left, at most.
size_t mostColumns(const RenderOptions& options);
// The same for every run of the program. When cancelled, what it returns is of no use and the
// report stays as it was.
LightParts reduceParts(const Tracer& tracer, const EmitterSampler& emitters, const Camera& camera,
                       const BandPlan& plan, int set, LightParts parts,
                       const RenderOptions& options, ReductionReport* report, Context& context);

}  // namespace lobelia::app
