#include "lobelia/path/emission_pattern.h"

#include "lobelia/path/spherical_image.h"
#include "lobelia/scene/emitter_frame.h"

namespace lobelia {
namespace {

const Image* pictureOf(const Scene& scene, TextureHandle texture) {
  while (texture.valid() && scene[texture].type == TextureType::scale) texture = scene[texture].a;
  if (!texture.valid() || !scene[texture].image.valid()) return nullptr;
  return &scene[scene[texture].image];
}

}  // namespace

EmissionPattern::EmissionPattern(const Scene& scene, const Emitter& emitter)
    : scene_(scene), emitter_(emitter), frame_(emitterFrame(emitter)) {
  switch (emitter.type) {
    case EmitterType::spot:
      cosCutoff_ = std::cos(emitter.cutoff);
      cosBeam_ = std::cos(std::min(emitter.beamWidth, emitter.cutoff));
      tanX_ = tanY_ = std::tan(emitter.cutoff);
      break;
    case EmitterType::projector: {
      // Pixels are square: the picture's shape is that of its bitmap.
      picture_ = pictureOf(scene, emitter.radiance.texture);
      tanX_ = tanY_ = std::tan(0.5f * emitter.fov);
      if (picture_)
        tanY_ *= static_cast<float>(picture_->height) / static_cast<float>(picture_->width);
      cosCutoff_ = cosBeam_ = 1 / std::sqrt(1 + tanX_ * tanX_ + tanY_ * tanY_);
      base_ = Rgb(kPi * emitter.scale);
      return;
    }
    default:
      break;
  }
  base_ = evaluate(scene, emitter.radiance, TextureContext{});
  if (emitter.type == EmitterType::goniometric) base_ *= emitter.scale;
}

Rgb EmissionPattern::at(Vec3f local) const {
  switch (emitter_.type) {
    case EmitterType::spot:
      return spot(local);
    case EmitterType::projector:
      return projector(local);
    case EmitterType::goniometric:
      return SphericalImage(scene_[emitter_.image]).at(fromEmitterAxes(normalize(local)));
    default:
      return Rgb(1.f);
  }
}

Rgb EmissionPattern::spot(Vec3f local) const {
  const float cosine = local.z / length(local);
  if (!(cosine > cosCutoff_)) return {};
  Rgb pattern(1.f);
  if (cosine < cosBeam_) {
    pattern *= (emitter_.cutoff - std::acos(cosine)) / (emitter_.cutoff - emitter_.beamWidth);
  }
  if (emitter_.pattern.valid()) {
    TextureContext at;
    at.uv = {0.5f + 0.5f * local.x / (local.z * tanX_), 0.5f + 0.5f * local.y / (local.z * tanY_)};
    pattern *= evaluate(scene_, emitter_.pattern, at);
  }
  return pattern;
}

Rgb EmissionPattern::projector(Vec3f local) const {
  if (!(local.z > 0)) return {};
  TextureContext at;
  at.uv = {0.5f - 0.5f * local.x / (local.z * tanX_), 0.5f - 0.5f * local.y / (local.z * tanY_)};
  if (at.uv.x < 0 || at.uv.x > 1 || at.uv.y < 0 || at.uv.y > 1) return {};
  const float cosine = local.z / length(local);
  return evaluate(scene_, emitter_.radiance, at) / (cosine * cosine * cosine);
}

}  // namespace lobelia
