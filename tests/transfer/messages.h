// What a stage says, for tests, and a way to stop it there.
#pragma once

#include <algorithm>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "lobelia/base/context.h"

namespace lobelia::test {

struct Messages : Listener {
  Messages() = default;
  Messages(const Messages&) = delete;
  void clear() { texts.clear(), warnings = 0; }
  void message(Severity severity, std::string_view text) override {
    const std::lock_guard lock(mutex_);
    texts.emplace_back(text);
    warnings += severity == Severity::warning ? 1 : 0;
  }
  void progress(std::string_view stage, double fraction) override {
    if (onProgress) onProgress(stage, fraction);
  }
  // How many messages have this in them.
  size_t said(std::string_view part) const {
    return static_cast<size_t>(std::ranges::count_if(
        texts, [&](const std::string& t) { return t.find(part) != std::string::npos; }));
  }

  std::vector<std::string> texts;
  size_t warnings = 0;
  std::function<void(std::string_view, double)> onProgress;

 private:
  std::mutex mutex_;
};

}  // namespace lobelia::test
