// What `lobelia precompute --method cuts` makes and the interactive renderer reads [P004].
//
// A vertex's visibility is kept where it can matter: at samples in front of one of the faces around
// it (for surfaces, at those that face it, too), and everywhere where a material scatters behind
// its surface. Elsewhere a cut says anything: whoever reads it must drop light from behind the
// geometric normal of the triangle that is lit.
#pragma once

#include <string>

#include "lobelia/relight/light_samples.h"
#include "lobelia/relight/sample_mesh.h"
#include "lobelia/relight/sample_tree.h"
#include "lobelia/relight/visibility_cut.h"

namespace lobelia::relight {

struct VisibilityData {
  LightSamples samples;  // in the order of the tree's leaves
  SampleTree tree;
  CutSet cuts;  // of the vertices of mesh; plain visibility, without a geometry term
  SampleMesh mesh;
  // By instance: is its visibility known on both sides (1), or in front alone (0)?
  std::vector<uint8_t> bothSides;
};

// Does the material scatter light that arrives from behind the surface (two-sided, transmitting)?
bool scattersBehind(const Scene& scene, MaterialHandle material);
// The same by instance, 0 or 1: VertexFaces wants it so.
std::vector<uint8_t> bothSidesOf(const Scene& scene);
// Does it let light through?
bool transmits(const Scene& scene, MaterialHandle material);

// Of all that the data depends on: meshes' places, normals and triangles, instances, and where
// masks let rays pass. Other properties of materials, emitters and cameras may change.
uint64_t geometryHash(const Scene& scene);

// Throws InputError, at `where`, when a material has come to scatter on both sides where only the
// front is known.
void requireKnownSides(const VisibilityData& data, const Scene& scene, const Location& where);

void save(const VisibilityData& data, const Scene& scene, const std::string& file);
// Throws InputError: of other geometry, damaged, another version; or a material that has come to
// scatter on both sides where only the front is known.
VisibilityData load(const std::string& file, const Scene& scene);

}  // namespace lobelia::relight
