// A memo of expensive values for the process: computed on first use, never removed, so that
// references stay valid. Threads may ask together.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>

namespace lobelia {

template <class Key, class Value>
class Memo {
 public:
  // The value of a key, made by compute() when it is new. slot: any hash of the key. One memo per
  // pair of types: the last few values of each thread are found without the lock.
  template <class F>
  const Value& find(const Key& key, size_t slot, const F& compute) {
    struct Recent {
      Key key{};
      const Value* value = nullptr;
    };
    static constexpr size_t kRecentCount = 32;
    thread_local std::array<Recent, kRecentCount> recent;
    Recent& r = recent[slot % kRecentCount];
    if (r.value == nullptr || r.key != key) r = {key, &shared(key, compute)};
    return *r.value;
  }

 private:
  template <class F>
  const Value& shared(const Key& key, const F& compute) {
    {
      const std::lock_guard lock(mutex_);
      if (const auto at = values_.find(key); at != values_.end()) return *at->second;
    }
    // Outside of the lock: two threads may do the same work, with the same result.
    auto value = std::make_unique<const Value>(compute());
    const std::lock_guard lock(mutex_);
    return *values_.emplace(key, std::move(value)).first->second;
  }

  std::mutex mutex_;
  std::map<Key, std::unique_ptr<const Value>> values_;
};

}  // namespace lobelia
