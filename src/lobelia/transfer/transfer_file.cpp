// Transfer on disk, as chunks of a store file. What is read is checked before anything uses it: a
// checksum proves that the file is what was written, not that what was written makes sense.
#include <fmt/format.h>

#include "lobelia/relight/mesh_chunks.h"
#include "lobelia/scene/surface_hash.h"
#include "lobelia/transfer/slice_chunks.h"
#include "lobelia/transfer/transfer_summary.h"

namespace lobelia::transfer {
namespace {

constexpr uint32_t kVersion = 2;  // 1: diffuse light in front alone, no buried vertices
constexpr uint32_t kMostPasses = 65;

struct Head {
  uint32_t directionLevel, classCount, passCount, hasReflection;
};

Head readHead(const store::Reader& reader, const std::string& file) {
  const auto heads = reader.get<Head>("head");
  if (heads.size() != 1) throw InputError({file}, "it has no head; make it again");
  const Head head = heads[0];
  const bool good = head.directionLevel <= 5 && head.classCount >= 1 &&
                    head.classCount <= static_cast<uint32_t>(kMostClasses) && head.passCount >= 1 &&
                    head.passCount <= kMostPasses && head.hasReflection <= 1;
  if (!good)
    throw InputError({file},
                     "its directions, classes or passes are out of range; make it again with "
                     "`lobelia precompute --method vmf`");
  return head;
}

// All but the mesh, of so many vertices.
void readPasses(const store::Reader& reader, const std::string& file, const Head& head, size_t rows,
                TransferData* data) {
  data->directionLevel = static_cast<int>(head.directionLevel);
  data->classCount = static_cast<int>(head.classCount);
  const size_t columns = GeodesicGrid(data->directionLevel).count();
  data->diffuseSides = readDiffuseSides(reader, file, rows);
  for (uint32_t j = 0; j < head.passCount; ++j)
    data->passes.push_back(readPass(reader, file, fmt::format("p{}", j),
                                    {.classes = j == 0 ? 1 : head.classCount + 1,
                                     .rows = rows,
                                     .columns = columns,
                                     .diffuse = data->diffuseSides.front(rows)}));
  // Whoever looks a vertex up finds a row, also where somebody has taken them out of the file.
  data->reflection =
      head.hasReflection != 0
          ? readRows(reader, file, "own", rows, columns)
          : SliceRows(columns, std::vector<uint64_t>(rows * ((columns + 63) / 64)), {});
}

}  // namespace

size_t TransferData::recordCount() const {
  size_t count = 0;
  for (const TransferPass& pass : passes)
    for (const SliceRows& rows : pass.glossy) count += rows.recordCount();
  return count;
}

size_t TransferData::byteCount() const {
  size_t bytes = reflection.byteCount() + diffuseSides.byteCount();
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
  addDiffuseSides(data.diffuseSides, &writer);
  writer.add("buried", std::span(data.mesh.buried.data(), data.mesh.buried.size()));
  for (size_t j = 0; j < data.passes.size(); ++j)
    addPass(data.passes[j].glossy, data.passes[j].diffuse, fmt::format("p{}", j), &writer);
  if (reflection) addRows(data.reflection, "own", &writer);
  writer.save(file);
}

TransferData load(const std::string& file, const Scene& scene) {
  const store::Reader reader(file, kTransferKind, kVersion);
  if (reader.sceneHash() != transferHash(scene)) {
    throw InputError({file},
                     "this transfer is of another scene, or of the scene with another --detail, "
                     "--meshes, --variant, --time or -D, or shapes, materials or textures were "
                     "changed since; give what it was made with, or make it again with `lobelia "
                     "precompute --method vmf`");
  }
  const Head head = readHead(reader, file);
  TransferData data;
  data.mesh.mesh = relight::readMesh(reader, file, splitMesh(scene));
  data.mesh.vertices = transferVertices(scene, data.mesh.mesh);
  data.mesh.buried = reader.get<uint8_t>("buried");
  if (!data.mesh.buried.empty() && data.mesh.buried.size() != data.mesh.vertices.size())
    throw InputError({file}, fmt::format("'buried' has {} rows for {} vertices; make it again with "
                                         "`lobelia precompute --method vmf`",
                                         data.mesh.buried.size(), data.mesh.vertices.size()));
  readPasses(reader, file, head, data.mesh.vertices.size(), &data);
  return data;
}

TransferSummary summaryOf(const std::string& file) {
  const store::Reader reader(file, kTransferKind, kVersion);
  const Head head = readHead(reader, file);
  const size_t vertices = reader.get<Vec3f>("positions").size();
  TransferData data;
  readPasses(reader, file, head, vertices, &data);
  return {reader.sceneHash(), data.reflection.columnCount(),
          data.passes.size(), static_cast<size_t>(data.classCount),
          vertices,           data.recordCount(),
          data.byteCount()};
}

}  // namespace lobelia::transfer
