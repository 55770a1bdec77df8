// The loop over blocks of vertices by which transfer is made: as many at a time as keep all threads
// busy, taken in their order. A few from all over the mesh, pilots, are made before all others:
// they tell what the rest will need.
#pragma once

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include "lobelia/base/context.h"
#include "lobelia/base/parallel.h"

namespace lobelia::transfer {

inline size_t blocksTogether() {
  return std::max<size_t>(8 * static_cast<size_t>(threadCount()), 1);
}

template <class Made>
class BlockLoop {
 public:
  // stage: that of progress. pilotCount: at most blockCount; 0: none.
  BlockLoop(const char* stage, size_t blockCount, size_t pilotCount, Context& context)
      : stage_(stage), blockCount_(blockCount), pilotCount_(pilotCount), context_(context) {}

  // make(block) -> Made, by any thread. take(Made), block by block. check(waiting, madeCount), when
  // pilots are made and again whenever blocks are taken: waiting (std::span<const Made>): pilots
  // that are not taken yet. Throws Cancelled when the context is.
  template <class Make, class Take, class Check>
  void run(const Make& make, const Take& take, const Check& check) {
    std::vector<size_t> open;
    for (size_t i = 0; i < pilotCount_; ++i) open.push_back(pilotAt(i));
    std::vector<Made> pilots = made(open, make);
    if (pilotCount_ > 0) check(std::span<const Made>(pilots), pilotCount_);
    size_t used = 0;  // pilots
    const size_t together = blocksTogether();
    for (size_t first = 0; first < blockCount_; first += together) {
      const size_t end = std::min(first + together, blockCount_);
      open.clear();
      for (size_t b = first, p = used; b < end; ++b)
        if (isPilot(p, b))
          ++p;
        else
          open.push_back(b);
      std::vector<Made> others = made(open, make);
      for (size_t b = first, i = 0; b < end; ++b)
        take(std::move(isPilot(used, b) ? pilots[used++] : others[i++]));
      check(std::span<const Made>(pilots).subspan(used), end + pilotCount_ - used);
    }
  }

 private:
  size_t pilotAt(size_t i) const { return i * blockCount_ / pilotCount_; }
  bool isPilot(size_t i, size_t block) const { return i < pilotCount_ && pilotAt(i) == block; }

  template <class Make>
  std::vector<Made> made(const std::vector<size_t>& blocks, const Make& make) {
    std::vector<Made> out(blocks.size());
    parallelFor(out.size(), 1, [&](size_t i) {
      if (context_.cancelled()) return;
      out[i] = make(blocks[i]);
      context_.progress(stage_, static_cast<double>(++done_) / static_cast<double>(blockCount_));
    });
    if (context_.cancelled()) throw Cancelled{};
    return out;
  }

  const char* stage_;
  size_t blockCount_, pilotCount_;
  Context& context_;
  std::atomic<size_t> done_{0};
};

}  // namespace lobelia::transfer
