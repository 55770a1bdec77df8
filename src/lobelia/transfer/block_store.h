// What blocks of a precomputation have given so far: rays in memory, or all of it in a work folder,
// from which a run that was stopped goes on, and which spares the memory for rays.
#pragma once

#include <atomic>

#include "lobelia/transfer/gather_block.h"
#include "lobelia/transfer/work_folder.h"

namespace lobelia::transfer {

class BlockStore {
 public:
  // Throws as WorkFolder does.
  BlockStore(const TransferSettings& settings, const Scene& scene, Context& context);

  std::optional<relight::SampleMesh> mesh(const Scene& scene) const;
  void putMesh(const relight::SampleMesh& mesh);
  // Before blocks are asked for. columns: of rows of slices.
  void setSize(size_t blocks, size_t columns);
  // From any thread, for different blocks. None: it has to be made. rows: vertices of the block;
  // diffuse: sides of which there are diffuse lobes.
  std::optional<BlockPass> find(size_t pass, size_t block, size_t rows, size_t diffuse);
  void put(size_t pass, size_t block, const BlockPass& made);
  // From memory, or from the folder into *read.
  const BlockRays& rays(size_t block, BlockRays* read);
  void putRays(size_t block, BlockRays rays);

  uint64_t rayBytes() const { return rayBytes_; }          // in memory, of all blocks
  uint64_t mostRayBytes() const { return mostRayBytes_; }  // of one block, wherever it is kept
  size_t resumed() const { return resumed_; }              // blocks that were there
  void finish();                                           // nothing is needed any more

 private:
  void noteRayBytes(uint64_t bytes);

  const int classCount_;
  std::optional<WorkFolder> folder_;
  size_t columns_ = 0;
  std::vector<BlockRays> inMemory_;
  std::atomic<uint64_t> rayBytes_{0}, mostRayBytes_{0};
  std::atomic<size_t> resumed_{0};
};

}  // namespace lobelia::transfer
