#include "lobelia/path/environment_sampling.h"

namespace lobelia {
namespace {

// Point in [0,1) with density proportional to lerp(a, b, x).
float sampleLinear(float a, float b, float u) {
  if (a + b <= 0) return u;
  const float x = u * (a + b) / (a + std::sqrt(lerp(a * a, b * b, u)));
  return std::min(x, 0x1.fffffep-1f);
}

}  // namespace

EnvironmentSampler::EnvironmentSampler(const Scene& scene, const Emitter& emitter) {
  constant_ = emitter.type == EmitterType::constant || !emitter.image.valid();
  value_ = constant_ ? emitter.radiance.value : Rgb(emitter.scale);
  if (constant_) {
    if (emitter.radiance.texture.valid()) value_ = mean(scene, emitter.radiance);
    integral_ = 4.0 * kPi * static_cast<double>(luminance(value_));
    return;
  }
  image_ = SphericalImage(scene[emitter.image]);
  toLocal_ = DirectionRows(emitter.toWorld.from);
  toWorld_ = DirectionRows(emitter.toWorld.to);

  const int width = image_.width(), rows = image_.rows();
  rowSine_.resize(static_cast<size_t>(rows) + 1);
  for (int y = 0; y <= rows; ++y) {
    // The poles' rows count a little: their texels reach into the cells beside them, where the
    // density must not vanish.
    const float inner =
        std::clamp(static_cast<float>(y), 0.125f, static_cast<float>(rows) - 0.125f);
    rowSine_[static_cast<size_t>(y)] = std::sin(inner / static_cast<float>(rows) * kPi);
  }
  std::vector<float> weights(static_cast<size_t>(width) * static_cast<size_t>(rows));
  double sum = 0;
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < width; ++x) {
      const int x1 = x + 1 == width ? 0 : x + 1;
      const Cell cell{x, x1, y, y + 1, 0, 0};
      const Corners w = corners(cell, image_.texels(cell));
      const float weight = 0.25f * (w.w00 + w.w10 + w.w01 + w.w11);
      weights[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] =
          weight;
      sum += static_cast<double>(weight);
    }
  }
  cells_ = Distribution2D(weights, width, rows);
  mean_ = sum / static_cast<double>(weights.size());
  integral_ = 2.0 * kPi * kPi * mean_ * static_cast<double>(std::abs(emitter.scale));
}

float EnvironmentSampler::nodeWeight(Rgb c, int y) const {
  const float weight = luminance({std::abs(c.x), std::abs(c.y), std::abs(c.z)});
  return std::isfinite(weight) ? weight * rowSine_[static_cast<size_t>(y)] : 0.f;
}

EnvironmentSampler::Corners EnvironmentSampler::corners(const Cell& c,
                                                        const SphericalImage::Texels& t) const {
  return {nodeWeight(t.c00, c.y0), nodeWeight(t.c10, c.y0), nodeWeight(t.c01, c.y1),
          nodeWeight(t.c11, c.y1)};
}

float EnvironmentSampler::density(const Cell& c, const Corners& w, Vec3f local,
                                  float jacobian) const {
  if (!(mean_ > 0)) return 0;
  const float top = lerp(w.w00, w.w10, c.fx), bottom = lerp(w.w01, w.w11, c.fx);
  const float sine = std::sqrt(std::max(local.x * local.x + local.z * local.z, 1e-14f));
  return lerp(top, bottom, c.fy) / static_cast<float>(mean_) * jacobian / (2 * kPi * kPi * sine);
}

// jacobian: solid angle in local space per solid angle in world space.
Vec3f EnvironmentSampler::toLocal(Vec3f d, float* jacobian) const {
  const Vec3f v = toLocal_ * d;
  const float len = length(v);
  *jacobian = toLocal_.determinant / (len * len * len);
  return v / len;
}

Rgb EnvironmentSampler::radiance(Vec3f d) const {
  if (constant_) return value_;
  float jacobian;
  return image_.at(toLocal(d, &jacobian)) * value_;
}

Rgb EnvironmentSampler::radiance(Vec3f d, Vec3f n, float* pdf) const {
  if (constant_) {
    *pdf = this->pdf(n, d);
    return value_;
  }
  float jacobian;
  const Vec3f local = toLocal(d, &jacobian);
  const Cell c = image_.cellAt(image_.toSquare(local));
  const SphericalImage::Texels texels = image_.texels(c);
  *pdf = density(c, corners(c, texels), local, jacobian);
  return SphericalImage::between(texels, c) * value_;
}

Vec3f EnvironmentSampler::sample(Vec3f n, Vec2f u, float* pdf, Rgb* radiance) const {
  if (constant_) {
    if (radiance) *radiance = value_;
    if (n == Vec3f{}) {
      *pdf = 0.25f * kInvPi;
      return sampleSphereUniform(u);
    }
    const Vec3f local = sampleHemisphereCosine(u);
    *pdf = std::max(local.z, 0.f) * kInvPi;
    return frameFromNormal(n).toWorld(local);
  }
  *pdf = 0;
  if (!(mean_ > 0)) return {0, 1, 0};
  Cell c = image_.cellAt(cells_.sample(u, nullptr));
  const SphericalImage::Texels texels = image_.texels(c);
  const Corners w = corners(c, texels);
  c.fy = sampleLinear(w.w00 + w.w10, w.w01 + w.w11, c.fy);
  c.fx = sampleLinear(lerp(w.w00, w.w01, c.fy), lerp(w.w10, w.w11, c.fy), c.fx);
  const Vec2f s{(static_cast<float>(c.x0) + c.fx) / static_cast<float>(image_.width()),
                (static_cast<float>(c.y0) + c.fy) / static_cast<float>(image_.rows())};
  const Vec3f d = normalize(toWorld_ * image_.fromSquare(s));
  // As pdf(d) has it but for the place in the cell: near the poles rounding of d matters.
  float jacobian;
  const Vec3f local = toLocal(d, &jacobian);
  *pdf = density(c, w, local, jacobian);
  if (radiance) *radiance = SphericalImage::between(texels, c) * value_;
  return d;
}

void EnvironmentSampler::prefetch(std::span<const Vec2f> u) const {
  if (constant_ || !(mean_ > 0)) return;
  std::vector<size_t> cells(u.size());
  cells_.prefetch(u, cells);
  const size_t width = static_cast<size_t>(image_.width());
  for (const size_t cell : cells)
    image_.prefetch(static_cast<int>(cell % width), static_cast<int>(cell / width));
}

float EnvironmentSampler::pdf(Vec3f n, Vec3f d) const {
  if (constant_) {
    return n == Vec3f{} ? 0.25f * kInvPi : std::max(dot(n, d), 0.f) * kInvPi;
  }
  float jacobian;
  const Vec3f local = toLocal(d, &jacobian);
  const Cell c = image_.cellAt(image_.toSquare(local));
  return density(c, corners(c, image_.texels(c)), local, jacobian);
}

}  // namespace lobelia
