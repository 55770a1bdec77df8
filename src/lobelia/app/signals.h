// SIGINT and SIGTERM cancel the context; what there is gets written, then the program ends with
// the contract's code. A second signal ends it at once.
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/base/error.h"

namespace lobelia::app {

class SignalGuard {
 public:
  explicit SignalGuard(Context& context);
  ~SignalGuard();
  // Signals cancel this context from now on: at once when one came already.
  void watch(Context& context);
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;
};

// done, or interrupted/terminated when a signal came.
ExitCode signalExitCode();

}  // namespace lobelia::app
