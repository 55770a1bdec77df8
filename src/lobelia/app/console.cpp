#include "lobelia/app/console.h"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cstdio>

namespace lobelia::app {
namespace {

std::string duration(double seconds) {
  const int64_t s = static_cast<int64_t>(seconds + 0.5);
  if (s >= 3600) return fmt::format("{}h{:02}m", s / 3600, s / 60 % 60);
  if (s >= 60) return fmt::format("{}m{:02}s", s / 60, s % 60);
  return fmt::format("{}s", s);
}

}  // namespace

Console::Console(Verbosity verbosity)
    : verbosity_(verbosity), terminal_(isatty(STDERR_FILENO) != 0) {
  auto sink = terminal_ ? spdlog::sink_ptr(std::make_shared<spdlog::sinks::stderr_color_sink_st>())
                        : spdlog::sink_ptr(std::make_shared<spdlog::sinks::stderr_sink_st>());
  auto logger = std::make_shared<spdlog::logger>("lobelia", std::move(sink));
  logger->set_level(verbosity == Verbosity::quiet    ? spdlog::level::err
                    : verbosity == Verbosity::normal ? spdlog::level::info
                                                     : spdlog::level::debug);
  logger->set_pattern("%^%l%$: %v");
  spdlog::set_default_logger(std::move(logger));
}

Console::~Console() { clearLine(); }

void Console::clearLine() {
  if (lineShown_) std::fputs("\r\033[K", stderr);
  lineShown_ = false;
}

void Console::message(Severity severity, std::string_view text) {
  const std::scoped_lock lock(mutex_);
  clearLine();
  switch (severity) {
    case Severity::debug:
      spdlog::debug("{}", text);
      break;
    case Severity::info:
      spdlog::info("{}", text);
      break;
    case Severity::warning:
      spdlog::warn("{}", text);
      break;
    case Severity::error:
      spdlog::error("{}", text);
      break;
  }
}

// On a terminal one line that renews itself; elsewhere, when verbose, a line every tenth.
void Console::progress(std::string_view stage, double fraction) {
  if (verbosity_ == Verbosity::quiet) return;
  const std::scoped_lock lock(mutex_);
  const int64_t now = nanosecondsNow();
  if (stage != stage_) {
    stage_ = stage;
    stageStart_ = now;
    lastTenth_ = -1;
  }
  const double elapsed = static_cast<double>(now - stageStart_) * 1e-9;
  const std::string left = fraction > 0.02 && elapsed > 1
                               ? ", " + duration(elapsed * (1 - fraction) / fraction) + " left"
                               : "";
  if (terminal_) {
    if (now - lastShown_ < 200'000'000) return;
    lastShown_ = now;
    std::fputs(fmt::format("\r\033[K{} {:.0f} %{}", stage, fraction * 100, left).c_str(), stderr);
    std::fflush(stderr);
    lineShown_ = true;
  } else if (verbosity_ == Verbosity::verbose && static_cast<int>(fraction * 10) > lastTenth_) {
    lastTenth_ = static_cast<int>(fraction * 10);
    spdlog::info("{} {:.0f} %{}", stage, fraction * 100, left);
  }
}

}  // namespace lobelia::app
