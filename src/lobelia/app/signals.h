// SIGINT and SIGTERM cancel the context; what there is gets written, then the program ends with
// the contract's code. A second signal ends it at once.
#pragma once

#include "lobelia/base/context.h"
#include "lobelia/base/error.h"

namespace lobelia::app {

// A file that grows past the limit of a process (ulimit -f) fails like any other write instead of
// ending the program at once, temporary files and all.
void survivableFileLimits();

// Guards nest: signals cancel the innermost one's context, and the outer one's when that is gone.
class SignalGuard {
 public:
  explicit SignalGuard(Context& context);
  ~SignalGuard();
  SignalGuard(const SignalGuard&) = delete;
  SignalGuard& operator=(const SignalGuard&) = delete;

 private:
  Context* const outer_;
};

// done, or interrupted/terminated when a signal came.
ExitCode signalExitCode();

}  // namespace lobelia::app
