#include "lobelia/transfer/memory_budget.h"

#include <fmt/format.h>
#include <unistd.h>

#include "lobelia/base/error.h"

namespace lobelia::transfer {
namespace {

constexpr double kSure = 0.8;  // of what is to be expected

uint64_t kilobytes(double bytes) { return static_cast<uint64_t>(bytes / 1024) + 1; }

}  // namespace

MemoryBudget::MemoryBudget(uint64_t bytes) : bytes_(bytes) {
  if (bytes_ == 0)
    bytes_ = static_cast<uint64_t>(sysconf(_SC_PHYS_PAGES)) *
             static_cast<uint64_t>(sysconf(_SC_PAGE_SIZE)) / 4 * 3;
}

void MemoryBudget::require(const MemoryUse& now, const MemoryUse& added,
                           const VertexProgress& progress) const {
  const auto budget = static_cast<double>(bytes_), there = static_cast<double>(now.total());
  const double left = progress.done > 0 ? static_cast<double>(progress.vertices - progress.done) /
                                              static_cast<double>(progress.done)
                                        : 0;
  const double coming = left * static_cast<double>(added.transfer + added.rays);
  const auto later = static_cast<double>(progress.later);
  if (there + kSure * coming + later <= budget) return;
  throw RuntimeError(fmt::format(
      "--memory {}K is too little: {} of {} vertices ({}) have {}K, {}K of them for the mesh, {}K "
      "for transfer, {}K for rays and {}K for blocks in the making; all of them would take about "
      "{}K{}. Give more, or take fewer --directions or --bounces or a coarser mesh "
      "(--max-vertices, "
      "--subdivide){}",
      kilobytes(budget), progress.done, progress.vertices, progress.stage, kilobytes(there),
      kilobytes(static_cast<double>(now.mesh)), kilobytes(static_cast<double>(now.transfer)),
      kilobytes(static_cast<double>(now.rays)), kilobytes(static_cast<double>(now.working)),
      kilobytes(there + coming + later), later > 0 ? " at least" : "",
      now.rays > 0 ? ", or --work, which keeps rays on the disk" : ""));
}

}  // namespace lobelia::transfer
