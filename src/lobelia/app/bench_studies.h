// The studies behind `lobelia bench`. Each appends its tables; cancelled, those rows it has.
#pragma once

#include "lobelia/app/bench.h"
#include "lobelia/app/bench_report.h"
#include "lobelia/base/context.h"

namespace lobelia::app {

// Prefix of the stages that a study reports its progress by.
inline constexpr std::string_view kBenchStage = "bench: ";

std::vector<BenchTable> benchRates(const BenchOptions& options, Context& context);
std::vector<BenchTable> benchPicture(const BenchOptions& options, Context& context);
std::vector<BenchTable> benchClamp(const BenchOptions& options, Context& context);
std::vector<BenchTable> benchConvergence(const BenchOptions& options, Context& context);
const std::vector<std::string>& vslFigures();  // what --figures may name
std::vector<BenchTable> benchVsl(const BenchOptions& options, Context& context);
const std::vector<std::string>& vsglFigures();
std::vector<BenchTable> benchVsgl(const BenchOptions& options, Context& context);
const std::vector<std::string>& sglcFigures();
const std::vector<std::string>& sglcMethodKeys();  // what --methods may name
std::vector<BenchTable> benchSglc(const BenchOptions& options, Context& context);
const std::vector<std::string>& cutsFigures();
std::vector<BenchTable> benchCuts(const BenchOptions& options, Context& context);
const std::vector<std::string>& vmfFigures();
std::vector<BenchTable> benchVmf(const BenchOptions& options, Context& context);

}  // namespace lobelia::app
