// The sum that gatherAll must give, pair by pair in double precision with evaluate() of bsdf.h.
#pragma once

#include <cmath>

#include "gather/random_input.h"
#include "lobelia/path/emission_pattern.h"

namespace lobelia::test {

inline Vec3d toDouble(Vec3f v) { return {double{v.x}, double{v.y}, double{v.z}}; }
inline Vec3f toFloat(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

class Oracle {
 public:
  Oracle(const Tracer& tracer, const Receivers& receivers, const VirtualLights& lights,
         const GatherSettings& settings)
      : tracer_(tracer), receivers_(receivers), lights_(lights), settings_(settings) {}

  Vec3d radiance(size_t i) const {
    const ReceiverPoint& point = receivers_.points[i];
    Vec3d sum;
    for (const OmniLight& light : lights_.omni)
      if (allowed(point, 0)) sum += omni(point, light);
    for (const DirectionalLight& light : lights_.directional)
      if (allowed(point, 0)) sum += directional(point, light);
    for (size_t l = 0; l < lights_.diffuse.size(); ++l)
      if (allowed(point, depthOf(lights_.diffuseDepthEnds, l)))
        sum += diffuse(point, lights_.diffuse[l]);
    for (size_t l = 0; l < lights_.glossy.size(); ++l)
      if (allowed(point, depthOf(lights_.glossyDepthEnds, l)))
        sum += glossy(point, lights_.glossy[l]);
    return sum * toDouble(point.weight);
  }

 private:
  static int depthOf(const std::vector<uint32_t>& ends, size_t l) {
    int depth = 0;
    while (l >= ends[static_cast<size_t>(depth)]) ++depth;
    return depth;
  }
  bool allowed(const ReceiverPoint& point, int lightDepth) const {
    if (lightDepth == 0 && !settings_.direct) return false;
    return settings_.maxDepth < 0 || point.depth + 1 + lightDepth <= settings_.maxDepth;
  }
  Vec3d lobes(const ReceiverPoint& point, Vec3d wi) const {
    Bsdf bsdf;
    bsdf.frames[0] = point.frame;
    bsdf.ng = point.ng;
    for (size_t l = 0; l < point.lobeCount; ++l) bsdf.add(receivers_.lobes[point.firstLobe + l]);
    return toDouble(evaluate(bsdf, point.wo, toFloat(wi)));
  }
  bool sees(const ReceiverPoint& point, Vec3f to) const {
    return tracer_.visible(offsetOrigin(point.p, point.ng, point.error, to - point.p), to);
  }
  // geometry x lobe of the light in `factor`.
  Vec3d finite(const ReceiverPoint& point, Vec3f to, double factor, Rgb intensity) const {
    const Vec3d f = lobes(point, normalize(toDouble(to) - toDouble(point.p))) * factor;
    const double largest = maxComponent(f), clamp = double{settings_.clamp};
    if (!(largest > 0) || !sees(point, to)) return {};
    return f * toDouble(intensity) * (clamp > 0 && largest > clamp ? clamp / largest : 1.0);
  }
  Rgb patternOf(uint32_t emitter, Vec3f d) const {
    const EmissionPattern pattern(tracer_.scene(), tracer_.scene().emitters[emitter]);
    return pattern.at(pattern.toLocal(d));
  }
  Vec3d omni(const ReceiverPoint& point, const OmniLight& light) const {
    const Vec3d d = toDouble(point.p) - toDouble(light.p);
    Rgb intensity = light.intensity;
    if (light.emitter != 0xffffffffu) intensity *= patternOf(light.emitter, toFloat(d));
    return finite(point, light.p, 1 / lengthSquared(d), intensity);
  }
  Vec3d directional(const ReceiverPoint& point, const DirectionalLight& light) const {
    const Vec3d f = lobes(point, toDouble(light.direction));
    const Ray ray{offsetOrigin(point.p, point.ng, point.error, light.direction), light.direction, 0,
                  3.4e38f};
    if (!(maxComponent(f) > 0) || tracer_.occluded(ray)) return {};
    return f * toDouble(light.irradiance);
  }
  static double share(const ReceiverPoint& point, Vec3d d) {
    if (point.nearDistance == 0) return 1;
    return std::clamp(2 * length(d) / double{point.nearDistance} - 1, 0.0, 1.0);
  }
  Vec3d diffuse(const ReceiverPoint& point, const DiffuseLight& light) const {
    const Vec3d d = toDouble(point.p) - toDouble(light.p);
    const double cosine = dot(toDouble(decodeOctahedral(light.normal)), normalize(d));
    return finite(point, light.p, std::max(0.0, cosine) * share(point, d) / lengthSquared(d),
                  light.intensity);
  }
  Vec3d glossy(const ReceiverPoint& point, const GlossyLight& light) const {
    const Vec3d d = toDouble(point.p) - toDouble(light.p), w = normalize(d);
    if (dot(toDouble(light.n), d) <= 0) return {};
    const double lobe =
        std::exp(-0.5 * double{light.sharpness} * lengthSquared(w - toDouble(light.axis)));
    return finite(point, light.p, lobe * share(point, d) / lengthSquared(d), light.intensity);
  }

  const Tracer& tracer_;
  const Receivers& receivers_;
  const VirtualLights& lights_;
  const GatherSettings& settings_;
};

}  // namespace lobelia::test
