#include "lobelia/app/bench_vmf_views.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/app/bench_cuts_frames.h"
#include "lobelia/base/error.h"
#include "lobelia/relight/local_sources.h"

namespace lobelia::app {
namespace {

constexpr uint64_t kReferenceSeed = 44;

Camera turnedAbout(const Camera& camera, Vec3f middle, double degrees) {
  const Vec3d centre{double{middle.x}, double{middle.y}, double{middle.z}};
  Camera turned = camera;
  turned.toWorld = Transform(translation(centre) * rotation({0, 1, 0}, degrees) *
                             translation(-centre) * camera.toWorld.to);
  return turned;
}

void subtract(Film* from, const Film& film) {
  std::vector<float>& values = from->layers.at("").values;
  const std::vector<float>& less = film.layers.at("").values;
  for (size_t i = 0; i < values.size(); ++i) values[i] -= less[i];
}

}  // namespace

VmfViews::VmfViews(const std::string& name, const VmfStudy& study)
    : name_(name),
      study_(study),
      samples_(study.options.spp > 0 ? study.options.spp : kPathSamples),
      scene_(sceneOf(kBounces)) {
  const std::vector<Emitter>& emitters = scene().emitters;
  if (std::all_of(emitters.begin(), emitters.end(),
                  [](const Emitter& e) { return relight::isLocal(e.type); }))
    throw UsageError(
        fmt::format("{}: pictures of transfer need light from infinity, of which the "
                    "scene has none; add some with --environment",
                    name));
  for (size_t v = 0; v < kViews; ++v) {
    cameras_.push_back(turnedAbout(scene_->camera(), tracer().bounds().centre(),
                                   360.0 * static_cast<double>(v) / kViews));
    objects_.push_back(objectsOf(tracer(), cameras_.back()));
  }
}

std::unique_ptr<BenchScene> VmfViews::sceneOf(int bounces) const {
  BenchOptions options = study_.options;
  options.scene.scene = name_;
  if (options.size.empty()) options.size = "320x240";
  options.maxDepth = bounces + 2;
  options.pixels = 0;  // for this study it limits vertices
  return std::make_unique<BenchScene>(
      options, BenchScene::Defaults{.scene = name_, .component = "all"}, study_.context);
}

std::string VmfViews::note() const {
  return fmt::format(
      "{}x{} from {} sides, {} samples of a pixel's filter, pixels whose neighbours all see a "
      "surface. Path tracing: as many reflections, {} samples in two halves.",
      camera(0).width, camera(0).height, kViews, kFrameSamples, samples_);
}

Film VmfViews::frame(transfer::TransferRenderer& renderer, size_t view, int first, int end) {
  Film film = emptyFrame(cameras_[view]);
  renderer.render({.spp = kFrameSamples,
                   .firstPass = first,
                   .endPass = end,
                   .hideEmitters = scene().hideEmitters || first > 0},
                  cameras_[view], film, study_.context);
  return film;
}

const Reference& VmfViews::path(size_t view, int bounces) {
  const auto key = std::pair(view, bounces);
  const auto known = paths_.find(key);
  if (known != paths_.end()) return known->second;
  study_.progress(name_, fmt::format("path tracing, {} bounces", bounces));
  const std::unique_ptr<BenchScene> scene = sceneOf(bounces);
  scene->setCamera(cameras_[view]);
  const uint64_t seed = kReferenceSeed + 16 * view + static_cast<uint64_t>(bounces);
  return paths_.emplace(key, pathReference(*scene, samples_, seed, study_.context)).first->second;
}

Reference VmfViews::path(size_t view, int first, int bounces) {
  Reference reference = path(view, bounces);
  if (first == 0) return reference;
  const Reference& before = path(view, first - 1);
  subtract(&reference.first, before.first);
  subtract(&reference.second, before.second);
  return reference;
}

std::vector<Film> VmfViews::frames(const transfer::TransferData& data, int first) {
  transfer::TransferRenderer shown(tracer(), data);
  light(&shown);
  std::vector<Film> films;
  for (size_t v = 0; v < kViews; ++v) films.push_back(frame(shown, v, first, kBounces + 1));
  return films;
}

std::vector<Reference> VmfViews::paths(int first) {
  std::vector<Reference> paths;
  for (size_t v = 0; v < kViews; ++v) paths.push_back(path(v, first, kBounces));
  return paths;
}

VmfError VmfViews::error(std::span<const Film> frames,
                         std::span<const Reference> references) const {
  VmfError sum;
  for (size_t v = 0; v < kViews; ++v) {
    const Comparison c = compared(frames[v], v, references[v]);
    sum.l2 += c.l2 / kViews, sum.meanRatio += c.meanRatio / kViews;
  }
  return sum;
}

}  // namespace lobelia::app
