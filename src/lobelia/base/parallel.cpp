// Parallel loops over oneTBB.
#include "lobelia/base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace lobelia {

void parallelRanges(size_t count, size_t grain, const std::function<void(size_t, size_t)>& f) {
  grain = std::max<size_t>(grain, 1);
  const size_t blocks = count / grain + (count % grain != 0 ? 1 : 0);
  if (blocks == 0) return;
  // Isolated: a thread that waits for an inner loop takes part in that loop only. Otherwise it
  // could start another piece of the outer loop while it holds a lock or builds a static table.
  const auto loop = [&] {
    tbb::this_task_arena::isolate([&] {
      tbb::parallel_for(tbb::blocked_range<size_t>(0, blocks, 1),
                        [&](const tbb::blocked_range<size_t>& range) {
                          for (size_t b = range.begin(); b != range.end(); ++b) {
                            f(b * grain, std::min(count, (b + 1) * grain));
                          }
                        });
    });
  };
  // The default arena has as many slots as the machine has cores; a limit above that (--threads 5
  // on two cores) needs an arena of its own.
  if (threadCount() > tbb::this_task_arena::max_concurrency()) {
    tbb::task_arena(threadCount()).execute(loop);
  } else {
    loop();
  }
}

void parallelSort(std::vector<uint64_t>* keys) {
  tbb::this_task_arena::isolate([&] { tbb::parallel_sort(keys->begin(), keys->end()); });
}

int threadCount() {
  return static_cast<int>(
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

ThreadLimit::ThreadLimit(int threads) : control_(nullptr) {
  if (threads > 0) {
    control_ = new tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                       static_cast<size_t>(threads));
  }
}

ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

}  // namespace lobelia
