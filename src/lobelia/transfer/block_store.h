// What blocks of a precomputation have given so far: in memory, or in a work folder, from which a
// run that was stopped goes on and which spares the memory for rays.
#pragma once

#include <atomic>

#include "lobelia/transfer/gather_block.h"

namespace lobelia::transfer {

class BlockStore {
 public:
  // False: it is not there.
  bool find(int pass, size_t block, BlockPass* out);
  void put(int pass, size_t block, const BlockPass& made);
  BlockRays rays(size_t block) const;
  void putRays(size_t block, BlockRays rays);
  size_t resumed() const { return resumed_; }
  void reserve(size_t blocks) { inMemory_.resize(blocks); }

 private:
  std::vector<BlockRays> inMemory_;
  std::atomic<size_t> resumed_{0};
};

}  // namespace lobelia::transfer
