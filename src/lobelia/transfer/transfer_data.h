// What `lobelia precompute --method vmf` makes and the interactive renderer reads [P002].
//
// Light is taken apart by bounce: pass 0 is light straight from infinity, pass j has j reflections
// at other surfaces before the last one. A surface's reflection is taken apart into its diffuse and
// its glossy lobes:
//
//  - What the diffuse lobes receive does not depend on the eye and is kept for each vertex
//    (`diffuse`), by the octant of the sphere from which it comes: eight lobes, whose sum the paper
//    has as one, for every direction. Where surfaces are diffuse behind as well, eight more.
//  - What the glossy lobes receive is kept for each vertex and direction to the eye (`glossy`).
//    Pass 0 has one class, and stores only where something is in the way: elsewhere the transfer is
//    the material's own lobe. Its r is that of the visible part. Passes after it have classCount
//    classes of paths with glossy reflections alone, and one more, the last, of all with a diffuse
//    one; nothing is stored where there is none.
#pragma once

#include <array>
#include <string>

#include "lobelia/base/error.h"
#include "lobelia/transfer/diffuse_sides.h"
#include "lobelia/transfer/geodesic_grid.h"
#include "lobelia/transfer/slice_rows.h"
#include "lobelia/transfer/transfer_mesh.h"

namespace lobelia::transfer {

inline constexpr int kMostClasses = 5;
inline constexpr size_t kOctants = 8;
// By the signs of x, y and z (bit set: negative).
inline uint32_t octantOf(Vec3f d) {
  return (d.x < 0 ? 1u : 0u) | (d.y < 0 ? 2u : 0u) | (d.z < 0 ? 4u : 0u);
}
using DiffuseLobes = std::array<SliceRecord, kOctants>;

struct TransferPass {
  std::vector<SliceRows> glossy;  // by class
  // By number of TransferData::diffuseSides; empty where nothing has diffuse lobes.
  std::vector<DiffuseLobes> diffuse;
};

struct TransferData {
  int directionLevel = 3;  // of the grid of directions to the eye
  // Glossy classes of paths by the material of the surface that the first ray from the vertex
  // meets; 1: all in one.
  int classCount = 1;
  TransferMesh mesh;
  DiffuseSides diffuseSides;
  std::vector<TransferPass> passes;  // at least one
  // What the glossy lobes reflect where nothing is in the way, for vertices whose material has no
  // table (materials with textures, anisotropic ones): share is the albedo itself. A row for each
  // vertex, empty for others.
  SliceRows reflection;

  size_t recordCount() const;  // of slices
  size_t byteCount() const;    // of what is looked up
};

// The class of a material: by its number among the scene's.
inline int classOf(MaterialHandle material, int classCount) {
  return classCount <= 1 ? 0 : static_cast<int>(material.index % static_cast<uint32_t>(classCount));
}

// Of all that the data depends on (surfaceHash()): geometry and materials with their textures.
// Emitters and cameras may change.
uint64_t transferHash(const Scene& scene);

void save(const TransferData& data, const Scene& scene, const std::string& file);
// Throws InputError: of another scene, damaged, another version, or another kind of file.
TransferData load(const std::string& file, const Scene& scene);
inline constexpr const char* kTransferKind = "vmf-transfer";  // store::kindOf() of such a file

}  // namespace lobelia::transfer
