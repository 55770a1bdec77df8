#include "lobelia/path/point_lights.h"

namespace lobelia {
namespace {

// The density of particles over a projector's picture: luminance, and a little everywhere.
Distribution2D filmOf(const Scene& scene, const Emitter& emitter, const Image* picture,
                      float meanLuminance) {
  const int nx = picture ? std::clamp(picture->width, 1, 1024) : 1;
  const int ny = picture ? std::clamp(picture->height, 1, 1024) : 1;
  std::vector<float> weights;
  weights.reserve(static_cast<size_t>(nx) * static_cast<size_t>(ny));
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) {
      TextureContext at;
      at.uv = {(static_cast<float>(x) + 0.5f) / static_cast<float>(nx),
               (static_cast<float>(y) + 0.5f) / static_cast<float>(ny)};
      weights.push_back(luminance(evaluate(scene, emitter.radiance, at)) + 0.05f * meanLuminance +
                        1e-20f);
    }
  }
  return Distribution2D(weights, nx, ny);
}

// Draws directions of a goniometric emitter as those of an environment with the same image.
EnvironmentSampler sphereOf(const Scene& scene, const Emitter& emitter) {
  Emitter image;
  image.type = EmitterType::environment;
  image.image = emitter.image;
  // The inverse of fromEmitterAxes().
  image.toWorld = Transform(Mat4{{{{0, 0, -1, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}}});
  return EnvironmentSampler(scene, image);
}

float brightestTexel(const SphericalImage& image) {
  float brightest = 0;
  for (int y = 0; y <= image.rows(); ++y)
    for (int x = 0; x < image.width(); ++x)
      brightest = std::max(brightest, luminance(image.texel(x, y)));
  return brightest;
}

}  // namespace

PointLight::PointLight(const Scene& scene, uint32_t index)
    : emitter_(index),
      type_(scene.emitters[index].type),
      position_(scene.emitters[index].toWorld.point({})),
      pattern_(scene, scene.emitters[index]) {
  const Emitter& emitter = scene.emitters[index];
  switch (type_) {
    case EmitterType::spot: {
      Rgb factor(1.f);
      if (emitter.pattern.valid()) factor = mean(scene, ColorParam(emitter.pattern));
      peak_ = luminance(pattern_.base() * factor);
      break;
    }
    case EmitterType::projector: {
      const float level = luminance(mean(scene, emitter.radiance));
      film_ = filmOf(scene, emitter, pattern_.picture(), level);
      peak_ = luminance(pattern_.base()) * level / (pattern_.cosCutoff() * pattern_.cosCutoff());
      break;
    }
    case EmitterType::goniometric:
      sphere_ = sphereOf(scene, emitter);
      peak_ = luminance(pattern_.base()) * brightestTexel(SphericalImage(scene[emitter.image]));
      break;
    default:
      peak_ = luminance(pattern_.base());
      break;
  }
}

float PointLight::flux() const {
  switch (type_) {
    case EmitterType::spot:  // the linear fall-off is taken half way
      return peak_ * kTwoPi * (1 - 0.5f * (pattern_.cosCutoff() + pattern_.cosBeam()));
    case EmitterType::projector:
      return peak_ * pattern_.cosCutoff() * pattern_.cosCutoff() * 4 * pattern_.tanX() *
             pattern_.tanY();
    case EmitterType::goniometric:
      return luminance(pattern_.base()) * static_cast<float>(sphere_->integral());
    default:
      return peak_ * 4 * kPi;
  }
}

TreeLight PointLight::treeLight() const {
  TreeLight out;
  out.bounds.add(position_);
  out.axis = pattern_.toWorld({0, 0, 1});
  out.cosThetaO = pattern_.cosCutoff();
  out.cosThetaE = 1;
  out.intensity = std::max(0.f, peak_);
  return out;
}

EmittedRay PointLight::sampleRay(Vec2f u) const {
  Vec3f local;
  float weight;  // 1 / pdf of the direction, solid angle
  if (type_ == EmitterType::spot) {
    const float oneMinusCos = 1 - pattern_.cosCutoff();
    local = sampleConeUniform(u, oneMinusCos);
    weight = kTwoPi * oneMinusCos;
  } else if (type_ == EmitterType::projector) {
    float pdf;
    const Vec2f uv = film_.sample(u, &pdf);
    local = normalize(Vec3f{(1 - 2 * uv.x) * pattern_.tanX(), (1 - 2 * uv.y) * pattern_.tanY(), 1});
    weight = 4 * pattern_.tanX() * pattern_.tanY() * local.z * local.z * local.z / pdf;
  } else if (type_ == EmitterType::goniometric) {
    float pdf;
    local = sphere_->sample({}, u, &pdf);
    weight = pdf > 0 ? 1 / pdf : 0.f;
  } else {
    local = sampleSphereUniform(u);
    weight = 4 * kPi;
  }
  EmittedRay out;
  out.emitter = emitter_;
  out.power = intensity(local) * weight;
  out.ray.d = pattern_.toWorld(local);
  out.ray.o = position_;
  out.ng = out.ray.d;
  return out;
}

}  // namespace lobelia
