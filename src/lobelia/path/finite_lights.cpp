// Shapes are sampled as Mitsuba 3 samples them: triangles uniformly by area, spheres by the cone
// they subtend, so that the variance is comparable image by image.
//
// A sphere is sampled on the true surface although rays meet a tessellation of it. The shadow ray
// ends before the tessellation begins; a hit outside of the true cone has density zero.
#include "lobelia/path/finite_lights.h"

#include "lobelia/base/parallel.h"

namespace lobelia {
namespace {

// Rounding of a sphere's world coordinates, relative.
constexpr float kRelativeError = 4e-7f;

float errorOf(Vec3f p) {
  return kRelativeError * std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), 1e-6f});
}

// The factor of a similarity, or nothing for any other transform.
std::optional<float> uniformScale(const Mat4& m) {
  Vec3d c[3];
  for (size_t i = 0; i < 3; ++i) c[i] = {m.m[0][i], m.m[1][i], m.m[2][i]};
  const double s = dot(c[0], c[0]), tolerance = 1e-5 * s;
  if (!(s > 0)) return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(dot(c[i], c[i]) - s) > tolerance) return std::nullopt;
    if (std::abs(dot(c[i], c[(i + 1) % 3])) > tolerance) return std::nullopt;
  }
  return static_cast<float>(std::sqrt(s));
}

float outerRadius(const Mesh& mesh) {
  float r2 = 1;
  for (const Vec3f& p : mesh.positions) r2 = std::max(r2, lengthSquared(p));
  return std::sqrt(r2) * 1.00001f;
}

bool masked(const Scene& scene, const Instance& instance) {
  return instance.material.valid() && hasOpacity(scene, instance.material);
}

// Emitters without a finite, positive estimate get none of the probability that goes by estimates,
// and do not spoil the sums in which the others take part.
float usable(float estimate) { return estimate > 0 && std::isfinite(estimate) ? estimate : 0.f; }

}  // namespace

FiniteLights::FiniteLights(const Scene& scene) : scene_(scene) {
  instances_.resize(scene.instances.size());
  std::vector<uint32_t> sphereInstances;
  for (uint32_t i = 0; i < scene.instances.size(); ++i) {
    const Instance& instance = scene.instances[i];
    if (!instance.emitter.valid() || scene[instance.emitter].type != EmitterType::area) continue;
    const Mesh& mesh = scene[instance.mesh];
    if (mesh.triangles.empty()) continue;
    ++emitterCount_;
    InstanceLights& lights = instances_[i];
    lights.emitter = instance.emitter.index;
    lights.radiance = scene[instance.emitter].radiance.value;
    lights.plain = !masked(scene, instance) && !scene[instance.emitter].radiance.texture.valid();
    // Spheres that emit inwards, or with a texture or mask (whose coordinates are the
    // tessellation's), are sampled as the triangles that they are.
    const auto scale = uniformScale(instance.toWorld.to);
    if (mesh.isUnitSphere && scale && !instance.flipNormals && lights.plain) {
      SphereLight sphere;
      sphere.centre = instance.toWorld.point({});
      sphere.radius = *scale;
      sphere.outer = *scale * outerRadius(mesh);
      sphere.instance = i;
      spheres_.push_back(sphere);
    } else {
      addInstance(i);
    }
  }
  for (uint32_t s = 0; s < spheres_.size(); ++s) {
    instances_[spheres_[s].instance].first = firstSphere() + s;
  }
  for (uint32_t e = 0; e < scene.emitters.size(); ++e) {
    if (!isPointLike(scene.emitters[e].type)) continue;
    points_.emplace_back(scene, e);
    ++emitterCount_;
  }
}

void FiniteLights::addInstance(uint32_t index) {
  const Instance& instance = scene_.instances[index];
  const Mesh& mesh = scene_[instance.mesh];
  const size_t first = triangles_.size();
  instances_[index].first = static_cast<uint32_t>(first);
  triangles_.resize(first + mesh.triangles.size());
  parallelFor(mesh.triangles.size(), 1024, [&](size_t t) {
    const Vec3u v = mesh.triangles[t];
    TriangleLight& light = triangles_[first + t];
    light.p0 = instance.toWorld.point(mesh.positions[v.x]);
    light.e1 = instance.toWorld.point(mesh.positions[v.y]) - light.p0;
    light.e2 = instance.toWorld.point(mesh.positions[v.z]) - light.p0;
    light.instance = index;
    light.triangle = static_cast<uint32_t>(t);
    const Vec3f normal = cross(light.e1, light.e2);
    const float scale = 1 / length(normal);
    if (!(scale > 0) || !std::isfinite(scale) || !std::isfinite(1 / scale)) return;
    light.n = normal * scale;
    light.inverseArea = 2 * scale;
    // Which side is outside (winding, mirrored transforms, flipped normals) is surfacePoint()'s.
    Vec3f ng;
    for (const Vec2f b : {Vec2f{0, 0}, Vec2f{1, 0}, Vec2f{0, 1}}) {
      const SurfacePoint at = surfacePoint(scene_, {0, b.x, b.y, index, light.triangle});
      ng = at.ng;
      light.error = std::max(light.error, at.error);
    }
    if (dot(light.n, ng) < 0) light.n = -light.n;
  });
  double area = 0;
  for (size_t t = first; t < triangles_.size(); ++t)
    area += static_cast<double>(triangles_[t].area());
  instances_[index].area = static_cast<float>(area);
}

Rgb FiniteLights::variedRadiance(const TriangleLight& light, float b1, float b2) const {
  const Instance& instance = scene_.instances[light.instance];
  const ColorParam& value = scene_[instance.emitter].radiance;
  const Mesh& mesh = scene_[instance.mesh];
  TextureContext at;
  at.mesh = &mesh;
  at.triangle = light.triangle;
  at.barycentrics = {b1, b2};
  at.uv = at.barycentrics;
  if (!mesh.uvs.empty()) {
    const Vec3u v = mesh.triangles[light.triangle];
    at.uv = mesh.uvs[v.x] * (1 - b1 - b2) + mesh.uvs[v.y] * b1 + mesh.uvs[v.z] * b2;
  }
  const Rgb radiance = evaluate(scene_, value, at);
  return masked(scene_, instance) ? radiance * opacity(scene_, instance.material, at) : radiance;
}

Rgb FiniteLights::radiance(const SphereLight& light) const {
  return scene_[scene_.instances[light.instance].emitter].radiance.value;
}

// Luminance; for textures from a few points, never below a part of the texture's mean.
float FiniteLights::meanRadiance(const TriangleLight& light) const {
  const Instance& instance = scene_.instances[light.instance];
  const ColorParam& value = scene_[instance.emitter].radiance;
  if (!value.texture.valid()) return std::max(0.f, luminance(value.value));
  static constexpr float kPoints[7][2] = {{1 / 3.f, 1 / 3.f}, {0.1f, 0.1f},   {0.8f, 0.1f},
                                          {0.1f, 0.8f},       {0.45f, 0.45f}, {0.1f, 0.45f},
                                          {0.45f, 0.1f}};
  float sum = 0;
  for (const auto& b : kPoints) sum += std::max(0.f, luminance(radiance(light, b[0], b[1])));
  return std::max(sum / 7, 0.1f * std::max(0.f, luminance(mean(scene_, value))));
}

std::vector<float> FiniteLights::uniformWeights() const {
  std::vector<float> weights(size(), 1.f);
  for (size_t i = 0; i < triangles_.size(); ++i) {
    const float total = instances_[triangles_[i].instance].area;
    weights[i] = total > 0 ? triangles_[i].area() / total : 0.f;
  }
  return weights;
}

std::vector<float> FiniteLights::fluxes() const {
  std::vector<float> result(size(), 0.f);
  parallelFor(triangles_.size(), 4096, [&](size_t i) {
    const TriangleLight& light = triangles_[i];
    if (light.inverseArea > 0) result[i] = kPi * light.area() * meanRadiance(light);
  });
  for (size_t i = 0; i < spheres_.size(); ++i) {
    const float r = spheres_[i].radius;
    result[firstSphere() + i] =
        4 * kPi * kPi * r * r * std::max(0.f, luminance(radiance(spheres_[i])));
  }
  for (size_t i = 0; i < points_.size(); ++i) result[firstPoint() + i] = points_[i].flux();
  for (float& flux : result) flux = usable(flux);
  return result;
}

std::vector<TreeLight> FiniteLights::treeLights() const {
  std::vector<TreeLight> result(size());
  parallelFor(triangles_.size(), 4096, [&](size_t i) {
    const TriangleLight& light = triangles_[i];
    if (!(light.inverseArea > 0)) return;
    TreeLight& out = result[i];
    for (const Vec3f p : {light.p0, light.p0 + light.e1, light.p0 + light.e2}) out.bounds.add(p);
    out.axis = light.n;
    out.intensity = light.area() * meanRadiance(light);
  });
  for (size_t i = 0; i < spheres_.size(); ++i) {
    TreeLight& out = result[firstSphere() + i];
    const float r = spheres_[i].radius;
    out.bounds.add(spheres_[i].centre - Vec3f(r));
    out.bounds.add(spheres_[i].centre + Vec3f(r));
    out.cosThetaO = -1;
    out.intensity = kPi * r * r * std::max(0.f, luminance(radiance(spheres_[i])));
  }
  for (size_t i = 0; i < points_.size(); ++i) result[firstPoint() + i] = points_[i].treeLight();
  for (TreeLight& light : result) light.intensity = usable(light.intensity);
  return result;
}

uint32_t FiniteLights::emitter(uint32_t light) const {
  if (isPoint(light)) return points_[light - firstPoint()].emitter();
  const uint32_t instance =
      light < firstSphere() ? triangles_[light].instance : spheres_[light - firstSphere()].instance;
  return instances_[instance].emitter;
}

std::optional<LightSample> FiniteLights::sampleOther(uint32_t light, Vec3f p, Vec2f u) const {
  LightSample result;
  if (light < firstPoint()) {
    const SphereLight& sphere = spheres_[light - firstSphere()];
    const Vec3f to = sphere.centre - p;
    const float d2 = lengthSquared(to), sin2 = sphere.radius * sphere.radius / d2;
    if (!(sin2 < 1)) return std::nullopt;  // inside: nothing is emitted inwards
    const float oneMinusCos = sin2 / (1 + std::sqrt(1 - sin2));
    const Vec3f local = sampleConeUniform(u, oneMinusCos);
    result.wi = frameFromNormal(to / std::sqrt(d2)).toWorld(local);
    result.pdf = 1 / (kTwoPi * oneMinusCos);
    result.value = radiance(sphere);
    // Where the ray enters the outer sphere; a point between the two spheres sees it at once.
    const float along = dot(to, result.wi);
    const float half2 = sphere.outer * sphere.outer - lengthSquared(cross(to, result.wi));
    result.distance = std::max(0.f, along - std::sqrt(std::max(half2, 0.f)));
    result.target = p + result.wi * result.distance;
    return result;
  }
  const PointLight& point = points_[light - firstPoint()];
  const Vec3f to = point.position() - p;
  const float d2 = lengthSquared(to);
  if (!(d2 > 0)) return std::nullopt;
  result.distance = std::sqrt(d2);
  result.wi = to / result.distance;
  result.target = point.position();
  result.value = point.intensityTowards(-result.wi) / d2;
  if (result.value == Rgb{}) return std::nullopt;
  return result;
}

std::optional<uint32_t> FiniteLights::lightOf(const SurfacePoint& hit) const {
  const uint32_t first = instances_[hit.instance].first;
  if (first == kNone) return std::nullopt;
  return first < firstSphere() ? first + hit.texture.triangle : first;
}

float FiniteLights::pdf(uint32_t light, Vec3f p, const SurfacePoint& hit, Vec3f wi) const {
  if (light < firstSphere()) {
    const TriangleLight& triangle = triangles_[light];
    const float cosine = -dot(hit.ng, wi);
    if (!(cosine > 0)) return 0;
    return lengthSquared(hit.p - p) * triangle.inverseArea / cosine;
  }
  const SphereLight& sphere = spheres_[light - firstSphere()];
  const Vec3f to = sphere.centre - p;
  const float d2 = lengthSquared(to), sin2 = sphere.radius * sphere.radius / d2;
  if (!(sin2 < 1)) return 0;
  const float along = dot(to, wi);
  if (along <= 0 || lengthSquared(cross(to, wi)) > sphere.radius * sphere.radius) return 0;
  return (1 + std::sqrt(1 - sin2)) / (kTwoPi * sin2);
}

EmittedRay FiniteLights::sampleRay(uint32_t light, Vec2f uPosition, Vec2f uDirection) const {
  if (isPoint(light)) return points_[light - firstPoint()].sampleRay(uDirection);
  EmittedRay out;
  out.emitter = emitter(light);
  Vec3f at;
  if (light < firstSphere()) {
    const TriangleLight& triangle = triangles_[light];
    const Vec2f b = sampleTriangleUniform(uPosition);
    at = triangle.p0 + triangle.e1 * b.x + triangle.e2 * b.y;
    out.ng = triangle.n;
    out.power = radiance(triangle, b.x, b.y) * (kPi * triangle.area());
  } else {
    const SphereLight& sphere = spheres_[light - firstSphere()];
    out.ng = sampleSphereUniform(uPosition);
    at = sphere.centre + out.ng * sphere.outer;
    out.power = radiance(sphere) * (4 * kPi * kPi * sphere.radius * sphere.radius);
  }
  out.ray.d = frameFromNormal(out.ng).toWorld(sampleHemisphereCosine(uDirection));
  const float error = light < firstSphere() ? triangles_[light].error : errorOf(at);
  out.ray.o = offsetOrigin(at, out.ng, error, out.ray.d);
  return out;
}

}  // namespace lobelia
