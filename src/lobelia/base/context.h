// What every stage is given besides its input and settings: log, progress, cancellation, counters
// and the seed. No globals.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace lobelia {

enum class Severity { debug, info, warning, error };

// Receives messages and progress; the application implements it. Called from any thread.
class Listener {
 public:
  virtual ~Listener() = default;
  virtual void message(Severity severity, std::string_view text) = 0;
  // fraction in [0,1] of the stage done. Called at most some times a second.
  virtual void progress(std::string_view stage, double fraction) = 0;
};

// Seconds by stage and counters by name; what --stats writes. Thread-safe, not for inner loops:
// count locally and add once per batch.
class Statistics {
 public:
  void addSeconds(std::string_view stage, double seconds);
  void addCount(std::string_view name, uint64_t n);
  void setValue(std::string_view name, double value);  // overwrites
  double seconds(std::string_view stage) const;
  uint64_t count(std::string_view name) const;
  double value(std::string_view name) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, double, std::less<>> seconds_, values_;
  std::map<std::string, uint64_t, std::less<>> counts_;
};

// Throws out of a stage when cancelled; caught once, in the application.
struct Cancelled {};

class Context {
 public:
  explicit Context(Listener* listener = nullptr) : listener_(listener) {}
  uint64_t seed = 0;
  Statistics statistics;

  void debug(std::string_view text) const { log(Severity::debug, text); }
  void info(std::string_view text) const { log(Severity::info, text); }
  void warning(std::string_view text) const { log(Severity::warning, text); }
  void progress(std::string_view stage, double fraction) const {
    if (listener_) listener_->progress(stage, fraction);
  }
  // Set from a signal handler or a time limit; stages look at it between batches and return what
  // they have.
  void cancel() { cancelled_.store(true, std::memory_order_relaxed); }
  bool cancelled() const { return cancelled_.load(std::memory_order_relaxed); }

 private:
  void log(Severity severity, std::string_view text) const {
    if (listener_) listener_->message(severity, text);
  }
  Listener* listener_;
  std::atomic<bool> cancelled_{false};
};

// Adds the seconds from its construction to its destruction to a stage.
class StageTimer {
 public:
  StageTimer(Context& context, std::string stage);
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  Context& context_;
  std::string stage_;
  int64_t start_;
};

int64_t nanosecondsNow();  // monotonic

}  // namespace lobelia
