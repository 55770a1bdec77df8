// Parallel loops over oneTBB. Each index is done exactly once, by any thread: what a loop body
// writes must depend on its index alone, so that results do not depend on the number of threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace lobelia {

// Calls f(begin, end) over disjoint ranges that cover [0, count), each at most `grain` long and
// starting at a multiple of it.
void parallelRanges(size_t count, size_t grain, const std::function<void(size_t, size_t)>& f);

// Calls f(i) for every i in [0, count); grain: how many in a row one thread takes.
template <class F>
void parallelFor(size_t count, size_t grain, const F& f) {
  parallelRanges(count, grain, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) f(i);
  });
}

// Ascending.
void parallelSort(std::vector<uint64_t>* keys);

int threadCount();  // threads that loops use
// Limits the threads of every loop until destroyed; 0 keeps the machine's number.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_;
};

}  // namespace lobelia
