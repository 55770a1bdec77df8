// Statistics and stage timers.
#include "lobelia/base/context.h"

#include <chrono>
#include <utility>

namespace lobelia {
namespace {

template <class T>
T& entry(std::map<std::string, T, std::less<>>& map, std::string_view name) {
  const auto it = map.find(name);
  return it != map.end() ? it->second : map.emplace(std::string(name), T{}).first->second;
}

template <class T>
T lookUp(const std::map<std::string, T, std::less<>>& map, std::string_view name) {
  const auto it = map.find(name);
  return it != map.end() ? it->second : T{};
}

}  // namespace

void Statistics::addSeconds(std::string_view stage, double seconds) {
  const std::lock_guard lock(mutex_);
  entry(seconds_, stage) += seconds;
}

void Statistics::addCount(std::string_view name, uint64_t n) {
  const std::lock_guard lock(mutex_);
  entry(counts_, name) += n;
}

void Statistics::setValue(std::string_view name, double value) {
  const std::lock_guard lock(mutex_);
  entry(values_, name) = value;
}

double Statistics::seconds(std::string_view stage) const {
  const std::lock_guard lock(mutex_);
  return lookUp(seconds_, stage);
}

uint64_t Statistics::count(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  return lookUp(counts_, name);
}

double Statistics::value(std::string_view name) const {
  const std::lock_guard lock(mutex_);
  return lookUp(values_, name);
}

StageTimer::StageTimer(Context& context, std::string stage)
    : context_(context), stage_(std::move(stage)), start_(nanosecondsNow()) {}

StageTimer::~StageTimer() {
  context_.statistics.addSeconds(stage_, static_cast<double>(nanosecondsNow() - start_) * 1e-9);
}

int64_t nanosecondsNow() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace lobelia
