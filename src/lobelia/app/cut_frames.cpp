#include "lobelia/app/cut_frames.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/relight/local_sources.h"

namespace lobelia::app {
namespace {

using relight::LightSamples;

const char* kindOf(const relight::VisibilityData& data) {
  return data.samples.kind == LightSamples::Kind::environment ? "environment" : "surfaces";
}

// What surfaces that transmit show: distant light knows visibility in front of surfaces alone;
// local light comes through by shadow rays, and what other surfaces send on by rays through smooth
// lobes (relight/local_mirror.h).
const char* transmittedBy(const CutData& data) {
  if (!data.surfaces) return "only their reflections are shown";
  if (!data.environment) return "light of other surfaces is shown through smooth ones only";
  return "no light from infinity is shown through them, and that of other surfaces through smooth "
         "ones only";
}

}  // namespace

CutData loadCutData(const std::vector<std::string>& files, const Scene& scene, Context& context) {
  const StageTimer timer(context, "data");
  CutData out;
  for (const std::string& file : files) {
    relight::VisibilityData data = relight::load(file, scene);
    auto& place =
        data.samples.kind == LightSamples::Kind::environment ? out.environment : out.surfaces;
    if (place)
      throw UsageError(fmt::format(
          "--data {}: these are a second file of --light {}; give one of each kind at most", file,
          kindOf(data)));
    place.emplace(std::move(data));
  }
  return out;
}

void requireKnownSides(const CutData& data, const Scene& scene, const Location& where) {
  for (const auto* one : {&data.environment, &data.surfaces})
    if (*one) relight::requireKnownSides(**one, scene, where);
}

void warnOfMissing(const CutData& data, const Scene& scene, Context& context) {
  const auto near = std::count_if(scene.emitters.begin(), scene.emitters.end(),
                                  [](const Emitter& e) { return relight::isLocal(e.type); });
  const auto far = std::ssize(scene.emitters) - near;
  if (data.environment && far == 0)
    context.warning("the scene has no light from infinity; add some with --environment or --sky");
  if (data.surfaces && near == 0)
    context.warning(
        "the scene has no local lights (point, spot, area, ...), which the data of --light "
        "surfaces are for");
  if (!data.surfaces && near > 0 && far > 0)
    context.warning(
        fmt::format("{} of {} emitters are not at infinity: they are seen but light nothing; add "
                    "--data of `lobelia precompute --light surfaces` for them",
                    near, scene.emitters.size()));
  if (!data.environment && far > 0)
    context.warning(
        fmt::format("{} of {} emitters are at infinity: they are seen but light nothing; add "
                    "--data of `lobelia precompute --light environment` for them",
                    far, scene.emitters.size()));
  const auto clear =
      std::count_if(scene.instances.begin(), scene.instances.end(),
                    [&](const Instance& i) { return relight::transmits(scene, i.material); });
  if (clear > 0)
    context.warning(fmt::format("{} surfaces transmit light: {}", clear, transmittedBy(data)));
}

CutFrames::CutFrames(const Tracer& tracer, const CutData& data) : tracer_(tracer), data_(data) {}

void CutFrames::relight(const EmitterSampler& emitters) {
  if (distant_) {
    distant_->relight(emitters);
  } else if (data_.environment) {
    distant_.emplace(tracer_, emitters, *data_.environment);
  }
  if (local_) {
    local_->relight(emitters);
  } else if (data_.surfaces) {
    local_.emplace(tracer_, emitters, *data_.surfaces);
  }
}

void CutFrames::render(const CutSettings& settings, const Camera& camera, Film& film,
                       Context& context) {
  const bool hide = tracer_.scene().hideEmitters;
  const bool direct = settings.component != "indirect", bounced = settings.component != "direct";
  if (distant_ && direct) {
    const relight::FrameLight light =
        distant_->light(settings.rotation, {.nodeCount = settings.lightCut}, context);
    distant_->render(light, camera,
                     {.spp = settings.spp, .refined = !settings.plainLobes, .hideEmitters = hide},
                     film, context);
  }
  if (!local_) return;
  const relight::LocalSettings local{
      .spp = settings.spp,
      .nodeCount = settings.lightCut,
      .areaPlaces = settings.areaPlaces,
      .direct = direct,
      .bounced = bounced,
      .hideEmitters = hide || !direct,
      .add = distant_.has_value() && direct,
      .toScene = transpose(relight::turnOfLight(tracer_.scene(), settings.rotation))};
  const relight::SurfaceLight light =
      bounced ? local_->light(local, context) : relight::SurfaceLight{};
  local_->render(light, camera, local, film, context);
}

}  // namespace lobelia::app
