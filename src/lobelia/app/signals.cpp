#include "lobelia/app/signals.h"

#include <unistd.h>

#include <csignal>

namespace lobelia::app {
namespace {

// A handler can reach nothing but statics.
std::atomic<Context*> activeContext{nullptr};
std::atomic<int> receivedSignal{0};

void onSignal(int signal) {
  if (receivedSignal.exchange(signal) != 0) _exit(128 + signal);
  if (Context* context = activeContext.load()) context->cancel();
}

void install(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

void survivableFileLimits() { std::signal(SIGXFSZ, SIG_IGN); }

SignalGuard::SignalGuard(Context& context) : outer_(activeContext.load()) {
  if (!outer_) receivedSignal = 0;
  activeContext = &context;
  if (!outer_) {
    install(onSignal);
  } else if (receivedSignal.load() != 0) {
    context.cancel();
  }
}

SignalGuard::~SignalGuard() {
  if (!outer_) install(SIG_DFL);
  activeContext = outer_;
  if (outer_ && receivedSignal.load() != 0) outer_->cancel();
}

ExitCode signalExitCode() {
  switch (receivedSignal.load()) {
    case SIGINT:
      return ExitCode::interrupted;
    case SIGTERM:
      return ExitCode::terminated;
    default:
      return ExitCode::done;
  }
}

}  // namespace lobelia::app
