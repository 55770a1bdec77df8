// A subdivided mesh as chunks of a store file: only what subdivision added is kept of it; the scene
// has the rest.
#pragma once

#include <string>

#include "lobelia/relight/sample_mesh.h"
#include "lobelia/store/store.h"

namespace lobelia::relight {

void addMesh(const SampleMesh& mesh, store::Writer* writer);
// unsplit: what the mesh was made of. Throws InputError, which names the file.
SampleMesh readMesh(const store::Reader& reader, const std::string& file,
                    const SampleMesh& unsplit);

}  // namespace lobelia::relight
