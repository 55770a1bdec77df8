// Checks of option values that CLI11 lacks, and how the definition names sets of values
// (docs/command_docs.h).
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class Validator;
}

namespace lobelia::app {

// CLI::Range lets NaN through and prints limits such as 1e308 in full.
CLI::Validator finiteNumber(double least, double most = HUGE_VAL, bool leastIncluded = true);
// Any seed.
CLI::Validator seedNumber();
// An integer within limits, which --help leaves out: they say little there.
CLI::Validator integerRange(int64_t least, int64_t most);
// Turns bytes, or K, M, G of them ("512M"; 1024 to the next), into a plain number of bytes.
CLI::Validator byteCount();
// One of a closed set.
CLI::Validator oneOf(const std::vector<std::string>& values);
// Makes a closed set known to --help, completion and documents. It accepts everything: the command
// itself refuses what is not in the set, with a better message than CLI11's.
CLI::Validator offered(const std::vector<std::string>& values);

}  // namespace lobelia::app
