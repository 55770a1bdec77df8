#include "lobelia/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "lobelia/base/random.h"

namespace lobelia {
namespace {

TEST(Parallel, EveryIndexOnceInAlignedRanges) {
  for (size_t count : {size_t{0}, size_t{1}, size_t{7}, size_t{1000}, size_t{4096}}) {
    for (size_t grain : {size_t{0}, size_t{1}, size_t{64}, size_t{5000}}) {
      std::vector<std::atomic<int>> seen(count);
      std::atomic<bool> aligned{true};
      parallelRanges(count, grain, [&](size_t begin, size_t end) {
        const size_t step = std::max<size_t>(grain, 1);
        if (begin % step != 0 || end - begin > step || begin >= end) aligned = false;
        for (size_t i = begin; i < end; ++i) ++seen[i];
      });
      EXPECT_TRUE(aligned);
      for (const auto& s : seen) ASSERT_EQ(s.load(), 1);
    }
  }
}

std::vector<float> computed(int threads) {
  const ThreadLimit limit(threads);
  EXPECT_EQ(threadCount(), threads);
  std::vector<float> out(10000);
  parallelFor(out.size(), 16, [&](size_t i) {
    Sampler sampler(3, i, 0);
    for (int k = 0; k < 20; ++k) out[i] += sampler.next1D();
  });
  return out;
}

TEST(Parallel, SameBitsForAnyNumberOfThreads) {
  const std::vector<float> one = computed(1);
  EXPECT_EQ(one, computed(2));
  EXPECT_EQ(one, computed(5));
}

// --threads 5 runs five threads even on a machine with two cores.
TEST(Parallel, ThreadLimitIsReachedAndKept) {
  for (int threads : {1, 2, 5}) {
    const ThreadLimit limit(threads);
    std::mutex mutex;
    std::set<std::thread::id> ids;
    std::atomic<int> running{0}, most{0};
    // A busy machine may take its time to start the threads: the first pieces wait for them.
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    parallelFor(200, 1, [&](size_t) {
      const int now = ++running;
      for (int m = most; now > m && !most.compare_exchange_weak(m, now);) {
      }
      do {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      } while (most < threads && std::chrono::steady_clock::now() < deadline);
      --running;
      const std::lock_guard lock(mutex);
      ids.insert(std::this_thread::get_id());
    });
    EXPECT_EQ(most.load(), threads);
    EXPECT_LE(ids.size(), static_cast<size_t>(threads));
  }
}

TEST(Parallel, ExceptionsReachTheCaller) {
  EXPECT_THROW(parallelFor(100, 1,
                           [](size_t i) {
                             if (i == 50) throw std::runtime_error("fifty");
                           }),
               std::runtime_error);
}

TEST(Parallel, LoopsNest) {
  std::atomic<int> sum{0};
  const ThreadLimit limit(3);
  parallelFor(10, 1, [&](size_t) { parallelFor(10, 1, [&](size_t) { ++sum; }); });
  EXPECT_EQ(sum.load(), 100);
}

// A thread that waits for an inner loop must not start another piece of the outer one: the piece
// that waits may hold a lock or build a static table.
TEST(Parallel, LoopsInsideLoopsAreIsolated) {
  const ThreadLimit limit(4);
  std::atomic<int> reentered{0};
  static thread_local int depth = 0;
  // Pieces of unequal length: some threads have none left and help with the inner loops, whose
  // owners then wait while there still are pieces of the outer loop.
  parallelFor(128, 1, [&](size_t i) {
    if (++depth > 1) ++reentered;
    const auto nap = [](int microseconds) {
      std::this_thread::sleep_for(std::chrono::microseconds(microseconds));
    };
    if (i < 32) {
      parallelFor(8, 1, [&](size_t j) { nap(j % 2 == 0 ? 20 : 400); });
    } else if (i >= 64) {
      nap(2000);
    }
    --depth;
  });
  EXPECT_EQ(reentered.load(), 0);
}

}  // namespace
}  // namespace lobelia
