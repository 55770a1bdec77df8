#include "lobelia/app/view_checks.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/app/frame_setup.h"

namespace lobelia::app {
namespace {

bool isGiven(const ViewOptions& options, const char* name) {
  const std::vector<std::string>& given = options.render.given;
  return std::find(given.begin(), given.end(), name) != given.end();
}

void warnOfUnused(const ViewOptions& options, const ViewData& data, Context& context) {
  const auto say = [&](const char* name, bool used, const char* why) {
    if (isGiven(options, name) && !used)
      context.warning(fmt::format("{} has no effect: {}", name, why));
  };
  const char* const cuts = "it is of frames by cuts, of which there is no --data";
  const bool any = data.cuts.any() != nullptr;
  say("--light-cut", any, cuts);
  say("--plain-lobes", data.cuts.environment.has_value(),
      any ? "it is of light from infinity, of which the --data of cuts have none" : cuts);
  say("--area-places", data.cuts.surfaces.has_value(),
      any ? "it is of local lights; add --data of `lobelia precompute --light surfaces`" : cuts);
  say("--component", any || data.transfer, "it is of frames by cuts and by transfer");
}

// Of frames of indirect light alone.
void warnOfBlack(const ViewData& data, Context& context) {
  if (data.cuts.any() != nullptr && !data.cuts.surfaces)
    context.warning(
        "--component indirect: the data are of direct light alone, so frames by cuts are black; "
        "add --data of `lobelia precompute --light surfaces`");
  if (data.transfer && data.transfer->passes.size() == 1)
    context.warning(
        "--component indirect: the data have no bounces, so frames by transfer are black; make "
        "them again with `lobelia precompute --method vmf --bounces 2`");
}

}  // namespace

void requireOwnFiles(const ViewOptions& options, const std::vector<ScriptStep>& script) {
  const SceneOptions& scene = options.render.scene;
  for (const ScriptStep& step : script) {
    if (step.kind != ScriptStep::Kind::save && step.kind != ScriptStep::Kind::screenshot) continue;
    std::vector<std::string> read = options.data;
    read.insert(read.end(), {options.script, scene.scene, scene.design, scene.environment});
    try {
      requireNoInput({step.file}, read);
    } catch (const UsageError& e) {
      throw InputError(step.where, e.what());
    }
  }
}

void requireTransferFrames(const ViewOptions& options, const ViewData& data,
                           const std::vector<ScriptStep>& script) {
  if (options.bounce < 0 || data.method == ViewMethod::transfer) return;
  const bool chosen = std::any_of(script.begin(), script.end(), [](const ScriptStep& step) {
    return step.kind == ScriptStep::Kind::method &&
           viewMethod(step.words[0]) == ViewMethod::transfer;
  });
  if (chosen) return;
  throw UsageError(fmt::format(
      "--bounce {} is of transfer, but frames are by cuts, of the first --data; name the data of "
      "transfer first, or choose `method transfer` in a script",
      options.bounce));
}

void warnOfOptions(const ViewOptions& options, const ViewData& data, Context& context) {
  warnOfUnused(options, data, context);
  if (options.render.component == "indirect") warnOfBlack(data, context);
}

}  // namespace lobelia::app
