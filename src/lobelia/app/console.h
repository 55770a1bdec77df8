// The terminal: messages, progress with the time left, all on standard error. No control codes
// when that is not a terminal.
#pragma once

#include <mutex>
#include <string>

#include "lobelia/base/context.h"

namespace lobelia::app {

enum class Verbosity { quiet, normal, verbose };

class Console : public Listener {
 public:
  explicit Console(Verbosity verbosity);
  ~Console() override;
  void message(Severity severity, std::string_view text) override;
  void progress(std::string_view stage, double fraction) override;

 private:
  void clearLine();
  Verbosity verbosity_;
  bool terminal_;
  std::mutex mutex_;
  std::string stage_;
  int64_t stageStart_ = 0, lastShown_ = 0;
  int lastTenth_ = -1;
  bool lineShown_ = false;
};

}  // namespace lobelia::app
