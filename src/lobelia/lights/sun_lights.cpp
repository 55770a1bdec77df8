// Directional emitters and suns as directional lights. A sun's lights have equal irradiance and lie
// on its disc, one in each of `count` rings of equal solid angle, the azimuths a golden-ratio
// sequence; rings and azimuths are shifted by random numbers, so that another seed gives other
// places and the expected light is the disc's.
#include "lobelia/base/frame.h"
#include "lobelia/base/random.h"
#include "lobelia/base/sampling.h"
#include "lobelia/lights/light_pass.h"
#include "lobelia/path/infinite_lights.h"

namespace lobelia {
namespace {

constexpr uint64_t kStream = 0x73756e73ull;
constexpr float kGoldenRatio = 0.6180339887f;

void addDisc(const Emitter& e, Rgb irradiance, uint32_t index, size_t count, Rng& rng,
             std::vector<DirectionalLight>* lights) {
  const double half = std::sin(0.5 * static_cast<double>(e.angularRadius));
  const float oneMinusCos = static_cast<float>(2 * half * half);
  const Frame frame = frameFromNormal(-normalize(e.direction));
  // From the middle to a plane that faces the whole disc: the lights' cosines take back a part.
  const Rgb share = irradiance * (2 / (2 - oneMinusCos) / static_cast<float>(count));
  const float turn = rng.next1D();
  for (size_t i = 0; i < count; ++i) {
    const float ring = (static_cast<float>(i) + rng.next1D()) / static_cast<float>(count);
    const float cosine = 1 - oneMinusCos * ring;
    const float sine = std::sqrt(oneMinusCos * ring * (1 + cosine));
    const float phi = kTwoPi * (turn + static_cast<float>(i) * kGoldenRatio);
    const Vec3f local{std::cos(phi) * sine, std::sin(phi) * sine, cosine};
    lights->push_back({normalize(frame.toWorld(local)), share, index});
  }
}

}  // namespace

std::vector<DirectionalLight> sunLights(const Scene& scene, size_t count, uint64_t seed) {
  std::vector<DirectionalLight> lights;
  Rng rng(seed, kStream);
  for (uint32_t i = 0; i < scene.emitters.size(); ++i) {
    const Emitter& e = scene.emitters[i];
    if (e.type != EmitterType::directional && e.type != EmitterType::sun) continue;
    const Rgb irradiance = mean(scene, e.radiance);
    if (e.type == EmitterType::sun && e.angularRadius >= kSmallestDisc && count > 0)
      addDisc(e, irradiance, i, count, rng, &lights);
    else
      lights.push_back({-normalize(e.direction), irradiance, i});
  }
  return lights;
}

}  // namespace lobelia
