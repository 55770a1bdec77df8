#include "lobelia/app/option_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <limits>

#include "lobelia/base/error.h"

namespace lobelia::app {

CLI::Validator finiteNumber(double least, double most, bool leastIncluded) {
  const std::string range =
      std::isinf(least) && std::isinf(most)
          ? std::string("a finite number")
          : fmt::format("a finite number {} {}{}", leastIncluded ? "from" : "above", least,
                        std::isinf(most) ? "" : fmt::format(" to {}", most));
  const auto check = [=](const std::string& text) {
    double value = 0;
    const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) &&
                      value <= most && (leastIncluded ? value >= least : value > least);
    return good ? std::string() : fmt::format("'{}' is not {}", text, range);
  };
  return CLI::Validator(check, "");
}

namespace {

// Decimal digits only: CLI11 would take 0x10, cut what is too large and wrap what is negative.
template <class T>
CLI::Validator integer(T least, T most, const std::string& mostText) {
  return CLI::Validator(
      [=](const std::string& text) {
        T value{};
        const char* end = text.data() + text.size();
        const auto [next, error] = std::from_chars(text.data(), end, value);
        const bool good = error == std::errc() && next == end && value >= least && value <= most;
        return good ? std::string()
                    : fmt::format("'{}' is not an integer from {} to {}", text, least, mostText);
      },
      "");
}

}  // namespace

CLI::Validator seedNumber() {
  return integer<uint64_t>(0, std::numeric_limits<uint64_t>::max(), "2^64-1");
}

CLI::Validator integerRange(int64_t least, int64_t most) {
  return integer<int64_t>(least, most, std::to_string(most));
}

CLI::Validator oneOf(const std::vector<std::string>& values) {
  return CLI::Validator(
      [=](const std::string& text) {
        if (std::find(values.begin(), values.end(), text) != values.end()) return std::string();
        return fmt::format("'{}' is not one of {}{}", text, fmt::join(values, ", "),
                           suggestion(text, values));
      },
      fmt::format("{{{}}}", fmt::join(values, ",")));
}

CLI::Validator byteCount() {
  return CLI::Validator(
      [](std::string& text) {
        uint64_t value = 0;
        const char* end = text.data() + text.size();
        auto [next, error] = std::from_chars(text.data(), end, value);
        constexpr std::string_view kUnits = "KMG";
        const size_t unit = next != end ? kUnits.find(static_cast<char>(std::toupper(*next)))
                                        : std::string_view::npos;
        const uint64_t factor = unit < kUnits.size() ? uint64_t{1024} << (10 * unit) : 1;
        if (factor > 1) ++next;
        if (error != std::errc() || next != end || value == 0 ||
            value > (uint64_t{1} << 50) / factor)
          return fmt::format("'{}' is not a number of bytes, as in 800M or 2G", text);
        text = std::to_string(value * factor);
        return std::string();
      },
      "");
}

CLI::Validator offered(const std::vector<std::string>& values) {
  return CLI::Validator([](const std::string&) { return std::string(); },
                        fmt::format("{{{}}}", fmt::join(values, ",")));
}

}  // namespace lobelia::app
