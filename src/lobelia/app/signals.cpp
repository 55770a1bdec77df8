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

SignalGuard::SignalGuard(Context& context) {
  activeContext = &context;
  receivedSignal = 0;
  install(onSignal);
}

SignalGuard::~SignalGuard() {
  install(SIG_DFL);
  activeContext = nullptr;
}

void SignalGuard::watch(Context& context) {
  activeContext = &context;
  if (receivedSignal.load() != 0) context.cancel();
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
