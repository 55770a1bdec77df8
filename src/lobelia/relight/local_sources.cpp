#include "lobelia/relight/local_sources.h"

#include <algorithm>

namespace lobelia::relight {

LocalSources::LocalSources(const Scene& scene) : lights_(scene) {
  const std::vector<float> shares = lights_.uniformWeights();
  for (uint32_t i = 0; i < scene.instances.size(); ++i) addArea(scene, i, shares);
  areaCount_ = sources_.size();
  for (uint32_t light = 0; light < lights_.size(); ++light)
    if (lights_.isPoint(light)) sources_.push_back({true, light, {}});
}

void LocalSources::addArea(const Scene& scene, uint32_t index, std::span<const float> shares) {
  const Instance& instance = scene.instances[index];
  const size_t triangles = scene[instance.mesh].triangles.size();
  if (!instance.emitter.valid() || triangles == 0) return;
  const std::optional<uint32_t> first =
      lights_.lightOf(surfacePoint(scene, {0, 1.f / 3, 1.f / 3, index, 0}));
  if (!first) return;
  Source source{false, *first, {}};
  if (lights_.isTriangle(*first)) {
    double sum = 0;
    for (const float share : shares.subspan(*first, triangles))
      source.end.push_back(static_cast<float>(sum += static_cast<double>(share)));
    if (!(sum > 0)) return;
    source.end.back() = 1;
  }
  sources_.push_back(std::move(source));
}

std::optional<LightSample> LocalSources::sample(size_t index, Vec3f p, Vec2f u) const {
  const Source& source = sources_[index];
  std::optional<LightSample> s;
  float share = 1;  // of the triangle
  if (source.end.empty()) {
    s = lights_.sampleOther(source.light, p, u);
  } else {
    const auto end = std::upper_bound(source.end.begin(), source.end.end() - 1, u.x);
    const auto triangle = static_cast<uint32_t>(end - source.end.begin());
    const float begin = triangle > 0 ? *(end - 1) : 0.f;
    share = *end - begin;
    if (!(share > 0)) return std::nullopt;
    u.x = std::clamp((u.x - begin) / share, 0.f, 0x1.fffffep-1f);
    s = lights_.sampleTriangle(source.light + triangle, p, u);
  }
  if (s && !source.point) s->value /= s->pdf * share;
  return s;
}

}  // namespace lobelia::relight
