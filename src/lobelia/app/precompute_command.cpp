#include "lobelia/app/precompute_command.h"

#include <fmt/format.h>

#include "lobelia/app/frame_setup.h"
#include "lobelia/app/precompute_methods.h"
#include "lobelia/app/signals.h"
#include "lobelia/base/parallel.h"

namespace lobelia::app {
namespace {

void requireFiles(const PrecomputeOptions& options) {
  for (const std::string& file : {options.output, options.stats})
    if (!file.empty()) requireWritable(file);
  if (options.output == options.stats)
    throw UsageError(
        fmt::format("{} would be written twice; give each output its own name", options.output));
  if (const std::string work = workFolder(options); options.method == "vmf" && !work.empty())
    requireWritableFolder(work);
  requireNoInput({options.output, options.stats},
                 {options.scene.scene, options.scene.design, options.scene.environment});
}

std::string stopped(const PrecomputeOptions& options) {
  const std::string folder = options.method == "vmf" ? workFolder(options) : "";
  if (folder.empty()) return "stopped: the data is not complete, none is written";
  return fmt::format(
      "stopped: the data is not complete, none is written; the same command goes on from what is "
      "done, in {}",
      folder);
}

}  // namespace

ExitCode precompute(const PrecomputeOptions& options, const GlobalOptions& global) {
  requireOfMethod(options);
  requireFiles(options);
  const ThreadLimit threads(global.threads);
  Console console(global.verbosity());
  Context context(&console);
  context.seed = options.seed;
  const SignalGuard signals(context);
  try {
    if (options.method == "vmf") {
      precomputeVmf(options, context);
    } else {
      precomputeCuts(options, context);
    }
    return ExitCode::done;
  } catch (const Cancelled&) {
    context.warning(stopped(options));
    return signalExitCode();
  }
}

}  // namespace lobelia::app
