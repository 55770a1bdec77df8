#include "lobelia/app/transfer_frames.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/base/error.h"
#include "lobelia/relight/local_sources.h"
#include "lobelia/relight/visibility_data.h"

namespace lobelia::app {

void warnOfMissing(const Scene& scene, Context& context) {
  const auto near = std::count_if(scene.emitters.begin(), scene.emitters.end(),
                                  [](const Emitter& e) { return relight::isLocal(e.type); });
  if (near == std::ssize(scene.emitters))
    context.warning(
        "the scene has no light from infinity, which is all that transfer shows; view it with "
        "--environment or --sky");
  if (near > 0)
    context.warning(
        fmt::format("{} of {} emitters are not at infinity: transfer shows them, but they light "
                    "nothing",
                    near, scene.emitters.size()));
  const auto clear =
      std::count_if(scene.instances.begin(), scene.instances.end(),
                    [&](const Instance& i) { return relight::transmits(scene, i.material); });
  if (clear > 0)
    context.warning(
        fmt::format("{} surfaces transmit light: transfer has only their reflections", clear));
}

std::string whyNoBounce(int bounce, int passes) {
  if (bounce < 0 || bounce < passes) return {};
  if (passes == 0)
    return "this is of data of `lobelia precompute --method vmf`, of which there is none; "
           "--component tells light of cuts apart";
  return fmt::format(
      "the data has light of 0 to {} bounces; more by `lobelia precompute --bounces {}`",
      passes - 1, bounce);
}

void requireBounce(int bounce, int passes) {
  if (const std::string why = whyNoBounce(bounce, passes); !why.empty())
    throw UsageError(fmt::format("--bounce {}: {}", bounce, why));
}

std::pair<int, int> passesOf(const TransferView& view) {
  if (view.bounce >= 0) return {view.bounce, view.bounce + 1};
  const transfer::TransferFrameSettings all;
  return {view.component == "indirect" ? 1 : all.firstPass,
          view.component == "direct" ? 1 : all.endPass};
}

TransferFrames::TransferFrames(const Tracer& tracer, const transfer::TransferData& data)
    : tracer_(tracer), renderer_(tracer, data) {}

// Whoever cancels a picture does not want its light half made: it has a context of its own.
void TransferFrames::relight(const EmitterSampler& emitters) {
  Context own;
  renderer_.relight(emitters, own);
}

void TransferFrames::render(const TransferView& view, const Camera& camera, Film& film,
                            Context& context) {
  const auto [first, end] = passesOf(view);
  renderer_.render({.spp = view.spp,
                    .rotation = view.rotation,
                    .firstPass = first,
                    .endPass = end,
                    .hideEmitters = tracer_.scene().hideEmitters || first > 0},
                   camera, film, context);
}

}  // namespace lobelia::app
