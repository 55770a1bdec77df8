// The memory of a precomputation against what it may have: what is there, and what is still to come
// if the rest is like what has been made, so that a scene that cannot fit is refused after its
// first blocks and not after hours.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace lobelia::transfer {

// Bytes.
struct MemoryUse {
  uint64_t mesh = 0;      // vertices, triangles and what is known of each
  uint64_t transfer = 0;  // TransferData::byteCount()
  uint64_t rays = 0;      // of all vertices, where no work folder has them
  uint64_t working = 0;   // blocks that are being made
  uint64_t total() const { return mesh + transfer + rays + working; }
};

// A stage that makes vertices one after the other.
struct VertexProgress {
  std::string stage;
  size_t done = 0, vertices = 0;
  uint64_t later = 0;  // bytes of transfer that later stages need in any case
};

class MemoryBudget {
 public:
  // 0: three quarters of the machine's.
  explicit MemoryBudget(uint64_t bytes);
  uint64_t bytes() const { return bytes_; }
  // now: what is there; added: what of its transfer and rays the stage has made so far. Throws
  // RuntimeError, which says how much would be needed, where that or four fifths of what is to be
  // expected at the stage's end are too much: vertices differ.
  void require(const MemoryUse& now, const MemoryUse& added, const VertexProgress& progress) const;

 private:
  uint64_t bytes_;
};

}  // namespace lobelia::transfer
