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
  image_ = &scene[emitter.image];
  const auto& inverse = emitter.toWorld.from.m;
  const auto& forward = emitter.toWorld.to.m;
  for (size_t r = 0; r < 3; ++r) {
    inverseRows_[r] = {static_cast<float>(inverse[r][0]), static_cast<float>(inverse[r][1]),
                       static_cast<float>(inverse[r][2])};
    rows_[r] = {static_cast<float>(forward[r][0]), static_cast<float>(forward[r][1]),
                static_cast<float>(forward[r][2])};
  }
  inverseDeterminant_ = static_cast<float>(std::abs(emitter.toWorld.from.determinant3()));

  const int width = image_->width, height = image_->height;
  const int rows = height > 1 ? height - 1 : 8;  // a single row of texels is repeated
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
      const float weight = 0.25f * (nodeWeight(x, y) + nodeWeight(x1, y) + nodeWeight(x, y + 1) +
                                    nodeWeight(x1, y + 1));
      weights[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] =
          weight;
      sum += static_cast<double>(weight);
    }
  }
  cells_ = Distribution2D(weights, width, rows);
  mean_ = sum / static_cast<double>(weights.size());
  integral_ = 2.0 * kPi * kPi * mean_ * static_cast<double>(std::abs(emitter.scale));
}

Rgb EnvironmentSampler::texel(int x, int y) const {
  y = std::min(y, image_->height - 1);
  const size_t channels = static_cast<size_t>(image_->channels);
  const float* v =
      image_->pixels.data() +
      (static_cast<size_t>(y) * static_cast<size_t>(image_->width) + static_cast<size_t>(x)) *
          channels;
  return channels < 3 ? Rgb(v[0]) : Rgb(v[0], v[1], v[2]);
}

float EnvironmentSampler::nodeWeight(int x, int y) const {
  const Rgb c = texel(x, y);
  const float weight = luminance({std::abs(c.x), std::abs(c.y), std::abs(c.z)});
  return std::isfinite(weight) ? weight * rowSine_[static_cast<size_t>(y)] : 0.f;
}

// s: u moved by half a texel, so that cells have texels as corners.
EnvironmentSampler::Cell EnvironmentSampler::cellAt(Vec2f s) const {
  const int width = image_->width, rows = static_cast<int>(rowSine_.size()) - 1;
  const float x = s.x * static_cast<float>(width), y = s.y * static_cast<float>(rows);
  Cell cell{};
  cell.x0 = std::clamp(static_cast<int>(x), 0, width - 1);
  cell.y0 = std::clamp(static_cast<int>(y), 0, rows - 1);
  cell.x1 = cell.x0 + 1 == width ? 0 : cell.x0 + 1;
  cell.y1 = cell.y0 + 1;
  cell.fx = std::clamp(x - static_cast<float>(cell.x0), 0.f, 1.f);
  cell.fy = std::clamp(y - static_cast<float>(cell.y0), 0.f, 1.f);
  return cell;
}

float EnvironmentSampler::density(Vec2f s) const {
  if (!(mean_ > 0)) return 0;
  const Cell c = cellAt(s);
  const float top = lerp(nodeWeight(c.x0, c.y0), nodeWeight(c.x1, c.y0), c.fx);
  const float bottom = lerp(nodeWeight(c.x0, c.y1), nodeWeight(c.x1, c.y1), c.fx);
  return lerp(top, bottom, c.fy) / static_cast<float>(mean_);
}

Vec2f EnvironmentSampler::toSquare(Vec3f local) const {
  const float u = std::atan2(local.x, -local.z) / kTwoPi - 0.5f / static_cast<float>(image_->width);
  return {u - std::floor(u), std::acos(std::clamp(local.y, -1.f, 1.f)) * kInvPi};
}

Vec3f EnvironmentSampler::fromSquare(Vec2f s) const {
  const float phi = (s.x + 0.5f / static_cast<float>(image_->width)) * kTwoPi;
  const float theta = s.y * kPi, sine = std::sin(theta);
  return {std::sin(phi) * sine, std::cos(theta), -std::cos(phi) * sine};
}

// jacobian: solid angle in local space per solid angle in world space.
Vec3f EnvironmentSampler::toLocal(Vec3f d, float* jacobian) const {
  const Vec3f v{dot(inverseRows_[0], d), dot(inverseRows_[1], d), dot(inverseRows_[2], d)};
  const float len = length(v);
  *jacobian = inverseDeterminant_ / (len * len * len);
  return v / len;
}

Rgb EnvironmentSampler::radiance(Vec3f d) const {
  if (constant_) return value_;
  float jacobian;
  const Cell c = cellAt(toSquare(toLocal(d, &jacobian)));
  const Rgb top = lerp(texel(c.x0, c.y0), texel(c.x1, c.y0), c.fx);
  const Rgb bottom = lerp(texel(c.x0, c.y1), texel(c.x1, c.y1), c.fx);
  return lerp(top, bottom, c.fy) * value_;
}

Vec3f EnvironmentSampler::sample(Vec3f n, Vec2f u, float* pdf) const {
  if (constant_) {
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
  float cellPdf;
  const Cell c = cellAt(cells_.sample(u, &cellPdf));
  const float w00 = nodeWeight(c.x0, c.y0), w10 = nodeWeight(c.x1, c.y0);
  const float w01 = nodeWeight(c.x0, c.y1), w11 = nodeWeight(c.x1, c.y1);
  const float fy = sampleLinear(w00 + w10, w01 + w11, c.fy);
  const float fx = sampleLinear(lerp(w00, w01, fy), lerp(w10, w11, fy), c.fx);
  const Vec2f s{(static_cast<float>(c.x0) + fx) / static_cast<float>(image_->width),
                (static_cast<float>(c.y0) + fy) / static_cast<float>(rowSine_.size() - 1)};
  const Vec3f local = fromSquare(s);
  const Vec3f d =
      normalize(Vec3f{dot(rows_[0], local), dot(rows_[1], local), dot(rows_[2], local)});
  // The density is looked up again from the direction, so that both ways give the same number.
  *pdf = EnvironmentSampler::pdf(n, d);
  return d;
}

float EnvironmentSampler::pdf(Vec3f n, Vec3f d) const {
  if (constant_) {
    return n == Vec3f{} ? 0.25f * kInvPi : std::max(dot(n, d), 0.f) * kInvPi;
  }
  float jacobian;
  const Vec3f local = toLocal(d, &jacobian);
  const float sine = std::sqrt(std::max(local.x * local.x + local.z * local.z, 1e-14f));
  return density(toSquare(local)) * jacobian / (2 * kPi * kPi * sine);
}

}  // namespace lobelia
