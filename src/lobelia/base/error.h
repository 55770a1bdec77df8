// Failures of input and of the machine. Programmer's mistakes are asserts; what may normally fail
// returns an optional.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace lobelia {

// Exit codes of the command line's contract (docs/options.md).
enum class ExitCode : int { done = 0, failed = 1, usage = 2, input = 3, interrupted = 130, terminated = 143 };

// A place in an input: file, and line and column where the format has them (1-based; 0: none).
struct Location {
  std::string file;
  int line = 0;
  int column = 0;
};
std::string toString(const Location& where);  // "file:line:column", leaving out what is 0

// Input that cannot be read or is invalid. what() reads "file:line: what is wrong; what would be right".
class InputError : public std::runtime_error {
 public:
  InputError(const Location& where, const std::string& message)
      : std::runtime_error(where.file.empty() ? message : toString(where) + ": " + message) {}
};

// The machine failed: disk full, out of memory, a file that cannot be written.
class RuntimeError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Wrong use of the command line.
class UsageError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The name of `known` nearest to `name` by edit distance, as "; did you mean 'x'?", or "" when
// none is near.
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

}  // namespace lobelia
