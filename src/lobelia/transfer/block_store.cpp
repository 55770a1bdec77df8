#include "lobelia/transfer/block_store.h"

#include <fmt/format.h>

#include <utility>

#include "lobelia/base/random.h"
#include "lobelia/relight/mesh_chunks.h"
#include "lobelia/transfer/slice_chunks.h"

namespace lobelia::transfer {
namespace {

// Of all that blocks depend on. The number of bounces is not of it: a run with more of them goes on
// where one with fewer has stopped.
uint64_t hashOf(const TransferSettings& s, const Scene& scene) {
  uint64_t hash = transferHash(scene);
  for (const int v : {s.directionLevel, s.rayLevel, s.maskLevel, s.subdivision, s.classCount})
    hash = hashCombine(hash, static_cast<uint64_t>(v));
  hash = hashCombine(hash, s.mostVertices);
  return hashCombine(hash, static_cast<uint64_t>(std::lround(double{s.maskTolerance} * 1e9)));
}

std::string nameOf(size_t pass, size_t block) { return fmt::format("pass{}-{:05}", pass, block); }
std::string raysName(size_t block) { return fmt::format("rays-{:05}", block); }

}  // namespace

BlockStore::BlockStore(const TransferSettings& settings, const Scene& scene, Context& context)
    : classCount_(settings.classCount) {
  if (!settings.workFolder.empty())
    folder_.emplace(settings.workFolder, hashOf(settings, scene), context);
}

std::optional<relight::SampleMesh> BlockStore::mesh(const Scene& scene) const {
  if (!folder_) return {};
  const auto reader = folder_->find("mesh");
  if (!reader) return {};
  return relight::readMesh(*reader, folder_->fileOf("mesh"), splitMesh(scene));
}

void BlockStore::putMesh(const relight::SampleMesh& mesh) {
  if (!folder_) return;
  store::Writer writer = folder_->writer();
  relight::addMesh(mesh, &writer);
  folder_->put("mesh", writer);
}

void BlockStore::setSize(size_t blocks, size_t columns) {
  columns_ = columns;
  if (!folder_) inMemory_.resize(blocks);
}

std::optional<BlockPass> BlockStore::find(size_t pass, size_t block, size_t rows, size_t diffuse) {
  if (!folder_) return {};
  const std::string name = nameOf(pass, block);
  const auto reader = folder_->find(name);
  if (!reader || (pass == 0 && !folder_->find(raysName(block)))) return {};
  const size_t classes = pass == 0 ? 1 : static_cast<size_t>(classCount_) + 1;
  const std::string file = folder_->fileOf(name);
  TransferPass read = readPass(*reader, file, "p", {classes, rows, columns_, diffuse});
  if (read.diffuse.size() != diffuse) return {};
  BlockPass out{std::move(read.glossy), std::move(read.diffuse), {}};
  if (pass == 0) out.reflection = readRows(*reader, file, "own", rows, columns_);
  ++resumed_;
  return out;
}

void BlockStore::put(size_t pass, size_t block, const BlockPass& made) {
  if (!folder_) return;
  store::Writer writer = folder_->writer();
  addPass(made.glossy, made.diffuse, "p", &writer);
  if (pass == 0) addRows(made.reflection, "own", &writer);
  folder_->put(nameOf(pass, block), writer);
}

const BlockRays& BlockStore::rays(size_t block, BlockRays* read) {
  if (!folder_) return inMemory_[block];
  const auto reader = folder_->find(raysName(block));
  if (!reader)
    throw RuntimeError(
        fmt::format("{} is gone or damaged; run again", folder_->fileOf(raysName(block))));
  BlockRays& rays = *read;
  const auto first = reader->get<uint64_t>("first");
  rays.first = first.empty() ? 0 : first[0];
  rays.blocked = reader->get<uint64_t>("blocked");
  rays.hitStart = reader->get<uint32_t>("hit-starts");
  rays.hits = reader->get<RayHit>("hits");
  rays.sliceStart = reader->get<uint32_t>("slice-starts");
  rays.slices = reader->get<SeeingSlice>("slices");
  rays.diffuseWeight = reader->get<float>("diffuse");
  noteRayBytes(rays.byteCount());
  return rays;
}

void BlockStore::noteRayBytes(uint64_t bytes) {
  for (uint64_t most = mostRayBytes_; bytes > most;)
    if (mostRayBytes_.compare_exchange_weak(most, bytes)) break;
}

void BlockStore::putRays(size_t block, BlockRays rays) {
  const uint64_t bytes = rays.byteCount();
  noteRayBytes(bytes);
  if (!folder_) {
    // Grown without being known beforehand.
    rays.hits.shrink_to_fit(), rays.blocked.shrink_to_fit(), rays.slices.shrink_to_fit();
    rayBytes_ += bytes;
    inMemory_[block] = std::move(rays);
    return;
  }
  store::Writer writer = folder_->writer();
  const uint64_t first = rays.first;
  writer.add("first", std::span<const uint64_t>(&first, 1));
  writer.add("blocked", std::span(std::as_const(rays.blocked)));
  writer.add("hit-starts", std::span(std::as_const(rays.hitStart)));
  writer.add("hits", std::span(std::as_const(rays.hits)));
  writer.add("slice-starts", std::span(std::as_const(rays.sliceStart)));
  writer.add("slices", std::span(std::as_const(rays.slices)));
  writer.add("diffuse", std::span(std::as_const(rays.diffuseWeight)));
  folder_->put(raysName(block), writer);
}

void BlockStore::finish() {
  if (folder_) folder_->remove();
}

}  // namespace lobelia::transfer
