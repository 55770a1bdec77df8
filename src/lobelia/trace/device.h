// An Embree device that remembers its first error, counts its memory and can be cancelled; private
// to the room.
#pragma once

#include <atomic>
#include <mutex>
#include <string>

#include "lobelia/trace/embree_api.h"

namespace lobelia::embree {

class Device {
 public:
  // Watches the context while building; stopWatching() ends that (the context may die first).
  explicit Device(Context& context);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  operator RTCDevice() const { return device_; }  // NOLINT: handed to Embree's functions
  // Throws Cancelled when the context is, or RuntimeError with Embree's message when something
  // went wrong since the last check.
  void check();
  void watchBuild(RTCScene scene);
  void stopWatching() { context_.store(nullptr); }
  int64_t bytes() const { return bytes_.load(); }

 private:
  static void onError(void* self, RTCError code, const char* text);
  static bool onMemory(void* self, ssize_t bytes, bool post);
  static bool onProgress(void* self, double fraction);
  bool cancelled() const;

  RTCDevice device_ = nullptr;
  std::atomic<Context*> context_;
  std::atomic<int64_t> bytes_{0};
  std::atomic<int64_t> lastReport_{0};
  std::mutex mutex_;
  RTCError error_ = RTC_ERROR_NONE;
  std::string message_;
};

}  // namespace lobelia::embree
