// Embree's callbacks for errors, memory and progress.
#include "lobelia/trace/device.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "lobelia/base/parallel.h"

namespace lobelia::embree {
namespace {

constexpr int64_t kReportInterval = 200'000'000;  // nanoseconds

const char* name(RTCError code) {
  switch (code) {
    case RTC_ERROR_INVALID_ARGUMENT:
      return "invalid argument";
    case RTC_ERROR_INVALID_OPERATION:
      return "invalid operation";
    case RTC_ERROR_OUT_OF_MEMORY:
      return "out of memory";
    case RTC_ERROR_UNSUPPORTED_CPU:
      return "unsupported CPU";
    case RTC_ERROR_CANCELLED:
      return "cancelled";
    default:
      return "unknown error";
  }
}

}  // namespace

// Embree uses the process' oneTBB; its own arena gets as many slots as our loops have threads.
Device::Device(Context& context) : context_(&context) {
  const std::string settings = fmt::format("threads={},set_affinity=0", threadCount());
  device_ = rtcNewDevice(settings.c_str());
  if (!device_) {
    throw RuntimeError(fmt::format("Embree cannot start: {}", name(rtcGetDeviceError(nullptr))));
  }
  rtcSetDeviceErrorFunction(device_, onError, this);
  rtcSetDeviceMemoryMonitorFunction(device_, onMemory, this);
}

Device::~Device() { rtcReleaseDevice(device_); }

void Device::check() {
  const std::lock_guard<std::mutex> lock(mutex_);
  const RTCError error = std::exchange(error_, RTC_ERROR_NONE);
  const std::string message = std::exchange(message_, {});
  if (cancelled()) throw Cancelled{};
  if (error == RTC_ERROR_NONE) return;
  throw RuntimeError(
      fmt::format("Embree: {}{}{}", name(error), message.empty() ? "" : ": ", message));
}

void Device::watchBuild(RTCScene scene) {
  rtcSetSceneProgressMonitorFunction(scene, onProgress, this);
}

bool Device::cancelled() const {
  const Context* const context = context_.load();
  return context && context->cancelled();
}

void Device::onError(void* self, RTCError code, const char* text) {
  Device& device = *static_cast<Device*>(self);
  const std::lock_guard<std::mutex> lock(device.mutex_);
  if (device.error_ != RTC_ERROR_NONE) return;
  device.error_ = code;
  device.message_ = text ? text : "";
}

// Embree lets an allocation fail when this returns false before it; freeing must never fail.
bool Device::onMemory(void* self, ssize_t bytes, bool post) {
  Device& device = *static_cast<Device*>(self);
  device.bytes_ += bytes;
  return bytes <= 0 || post || !device.cancelled();
}

bool Device::onProgress(void* self, double fraction) {
  Device& device = *static_cast<Device*>(self);
  const Context* const context = device.context_.load();
  if (!context) return true;
  const int64_t now = nanosecondsNow();
  int64_t last = device.lastReport_.load();
  if (now - last > kReportInterval && device.lastReport_.compare_exchange_strong(last, now)) {
    context->progress("accel", std::clamp(fraction, 0., 1.));
  }
  return !context->cancelled();
}

}  // namespace lobelia::embree
