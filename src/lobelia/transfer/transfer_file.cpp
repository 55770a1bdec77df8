// Transfer on disk, as chunks of a store file. What is read is checked before anything uses it: a
// checksum proves that the file is what was written, not that what was written makes sense.
#include <fmt/format.h>

#include "lobelia/relight/mesh_chunks.h"
#include "lobelia/scene/surface_hash.h"
#include "lobelia/transfer/slice_chunks.h"

namespace lobelia::transfer {
namespace {

constexpr uint32_t kVersion = 1;
constexpr uint32_t kMostPasses = 65;

struct Head {
  uint32_t directionLevel, classCount, passCount, hasReflection;
};

void requireSound(const Head& head, const std::string& file) {
  const bool good = head.directionLevel <= 5 && head.classCount >= 1 &&
                    head.classCount <= static_cast<uint32_t>(kMostClasses) && head.passCount >= 1 &&
                    head.passCount <= kMostPasses && head.hasReflection <= 1;
  if (!good)
    throw InputError({file},
                     "its directions, classes or passes are out of range; make it again with "
                     "`lobelia precompute --method vmf`");
}

}  // namespace

size_t TransferData::recordCount() const {
  size_t count = 0;
  for (const TransferPass& pass : passes)
    for (const SliceRows& rows : pass.glossy) count += rows.recordCount();
  return count;
}

size_t TransferData::byteCount() const {
  size_t bytes = reflection.byteCount();
  for (const TransferPass& pass : passes) {
    bytes += pass.diffuse.size() * sizeof(DiffuseLobes);
    for (const SliceRows& rows : pass.glossy) bytes += rows.byteCount();
  }
  return bytes;
}

uint64_t transferHash(const Scene& scene) { return surfaceHash(scene); }

void save(const TransferData& data, const Scene& scene, const std::string& file) {
  store::Writer writer(kTransferKind, kVersion, transferHash(scene));
  const bool reflection = data.reflection.rowCount() > 0;
  const Head head{static_cast<uint32_t>(data.directionLevel),
                  static_cast<uint32_t>(data.classCount), static_cast<uint32_t>(data.passes.size()),
                  reflection ? 1u : 0u};
  writer.add("head", std::span(&head, 1));
  relight::addMesh(data.mesh.mesh, &writer);
  for (size_t j = 0; j < data.passes.size(); ++j)
    addPass(data.passes[j].glossy, data.passes[j].diffuse, fmt::format("p{}", j), &writer);
  if (reflection) addRows(data.reflection, "own", &writer);
  writer.save(file);
}

TransferData load(const std::string& file, const Scene& scene) {
  const store::Reader reader(file, kTransferKind, kVersion);
  if (reader.sceneHash() != transferHash(scene)) {
    throw InputError({file},
                     "this transfer is of another scene (or shapes, materials or textures were "
                     "changed since); make it again with `lobelia precompute --method vmf`");
  }
  const auto heads = reader.get<Head>("head");
  if (heads.size() != 1) throw InputError({file}, "it has no head; make it again");
  const Head head = heads[0];
  requireSound(head, file);
  TransferData data;
  data.directionLevel = static_cast<int>(head.directionLevel);
  data.classCount = static_cast<int>(head.classCount);
  data.mesh.mesh = relight::readMesh(reader, file, splitMesh(scene));
  data.mesh.vertices = transferVertices(scene, data.mesh.mesh);
  const size_t rows = data.mesh.vertices.size();
  const size_t columns = GeodesicGrid(data.directionLevel).count();
  for (uint32_t j = 0; j < head.passCount; ++j)
    data.passes.push_back(readPass(reader, file, fmt::format("p{}", j),
                                   j == 0 ? 1 : head.classCount + 1, rows, columns));
  // Whoever looks a vertex up finds a row, also where somebody has taken them out of the file.
  data.reflection =
      head.hasReflection != 0
          ? readRows(reader, file, "own", rows, columns)
          : SliceRows(columns, std::vector<uint64_t>(rows * ((columns + 63) / 64)), {});
  return data;
}

}  // namespace lobelia::transfer
