#include "lobelia/transfer/block_store.h"

namespace lobelia::transfer {

bool BlockStore::find(int, size_t, BlockPass*) { return false; }
void BlockStore::put(int, size_t, const BlockPass&) {}
BlockRays BlockStore::rays(size_t block) const { return inMemory_[block]; }
void BlockStore::putRays(size_t block, BlockRays rays) { inMemory_[block] = std::move(rays); }

}  // namespace lobelia::transfer
