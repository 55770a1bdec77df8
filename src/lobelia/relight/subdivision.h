// Subdividing triangles where visibility between their vertices is not what interpolation says.
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/relight/light_samples.h"
#include "lobelia/relight/sample_mesh.h"
#include "lobelia/trace/tracer.h"

namespace lobelia::relight {

// Halves edges up to `rounds` times. samples: in the order of a light tree's leaves; 512 of them
// are looked at. bothSides: by instance (VisibilityData). Adds the counts "vertices_added" and
// "subdivision_rays". No more vertices are added than there are, or `allowed`, if that is more:
// what needs it most, with a warning. Throws Cancelled with the context.
SampleMesh subdivided(const Tracer& tracer, SampleMesh mesh, const LightSamples& samples,
                      std::span<const uint8_t> bothSides, int rounds, Context& context,
                      size_t allowed = 20000);

}  // namespace lobelia::relight
