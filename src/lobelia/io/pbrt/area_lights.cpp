// Area lights, and what can only be said of them when all meshes are read.
//
// `power` goes to each of PBRT's shapes, so to each triangle of a mesh and each patch of a
// bilinearmesh. Emitters of ours have one radiance: all parts of a mesh get the same, so that their
// powers add up to what PBRT's do. Where the parts differ in area PBRT's smaller ones are brighter,
// which is said. Quadrilaterals of PLY files, one shape there, count as two triangles.
//
// Lights that shine from both sides get a second instance for the back, set back by 1e-4 of the
// shape's size, as an emitter of ours has one side.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "lobelia/io/light_backs.h"
#include "lobelia/io/pbrt/reader.h"

namespace lobelia::io::pbrt {
namespace {

constexpr double kSameArea = 1e-3;  // relative

struct Areas {
  double sum = 0, least = std::numeric_limits<double>::infinity(), most = 0;
  size_t count = 0;  // of triangles that have one
};

Areas areasOf(const Scene& scene, const Instance& instance) {
  const Mesh& mesh = scene[instance.mesh];
  Areas areas;
  for (const Vec3u t : mesh.triangles) {
    const Vec3f p = instance.toWorld.point(mesh.positions[t.x]);
    const Vec3f a = instance.toWorld.point(mesh.positions[t.y]) - p;
    const Vec3f b = instance.toWorld.point(mesh.positions[t.z]) - p;
    const double area = 0.5 * static_cast<double>(length(cross(a, b)));
    if (!(area > 0)) continue;
    areas.sum += area;
    areas.least = std::min(areas.least, area), areas.most = std::max(areas.most, area);
    ++areas.count;
  }
  return areas;
}

}  // namespace

void Reader::areaLightSource(const Token& token) {
  auto light = std::make_shared<AreaLight>();
  light->type = quoted(token, "type");
  light->where = token.where;
  light->parameters = readParameters(*in_);
  light->colorSpace = state_.colorSpace;
  if (light->type != "diffuse")
    throw InputError(token.where, unknownName("area light", light->type, {"diffuse"}));
  state_.areaLight = std::move(light);
}

EmitterHandle Reader::areaEmitter(size_t parts) {
  AreaLight& light = *state_.areaLight;
  if (light.emitter.valid()) return light.emitter;
  const bool isFirst = !light.wasUsed;
  light.wasUsed = true;
  std::swap(state_.colorSpace, light.colorSpace);
  Parameters in(light.parameters, state_.defaults["light"], light.where);
  Emitter e;
  e.type = EmitterType::area;
  PendingArea pending;
  if (const std::optional<std::string> file = in.string("filename")) {
    if (in.has("L"))
      throw InputError(light.where, "the area light has both L and filename; give one of them");
    Texture t;
    t.type = TextureType::bitmap;
    t.filter = Filter::nearest;  // as PBRT
    t.image = image(*file, {}, light.where);
    t.uvMatrix[1][1] = -1, t.uvMatrix[1][2] = 1;
    const ColorParam picture = add(std::move(t));
    pending.textureMean = static_cast<double>(luminance(mean(scene_, picture)));
    e.radiance = product(picture, Rgb(in.number("scale", 1.f)));
  } else {
    e.radiance = lightColor(in, "L");
  }
  pending.power = static_cast<double>(in.number("power", -1.f));
  pending.parts = parts;
  pending.where = light.where;
  pending.twoSided = in.boolean("twosided", false);
  if (isFirst) in.finish("area light", findings_);
  std::swap(state_.colorSpace, light.colorSpace);
  pending.emitter = add(std::move(e));
  if (pending.power > 0 || pending.twoSided) pendingAreas_.push_back(pending);
  // The radiance of a given power depends on the shape's area.
  if (!(pending.power > 0)) light.emitter = pending.emitter;
  return pending.emitter;
}

void Reader::finishAreaLights() {
  for (const PendingArea& pending : pendingAreas_) {
    Areas areas;  // a light of a given power has one instance
    const size_t count = scene_.instances.size();
    for (size_t i = 0; i < count; ++i) {
      if (scene_.instances[i].emitter != pending.emitter) continue;
      if (pending.power > 0) areas = areasOf(scene_, scene_.instances[i]);
      if (pending.twoSided) makeTwoSided(i);
    }
    const double sides = pending.twoSided ? 2 : 1;
    const double emitted = pending.textureMean * sides * areas.sum * static_cast<double>(kPi);
    if (!(pending.power > 0) || !(emitted > 0)) continue;
    const size_t parts = pending.parts > 0 ? pending.parts : areas.count;
    if (parts > 1 && areas.most > areas.least * (1 + kSameArea))
      findings_.inform(pending.where,
                       fmt::format("the light's power is that of each triangle or patch, which "
                                   "differ in area; all {} have the same radiance here, the power "
                                   "of all together is that of PBRT",
                                   parts));
    const double power = pending.power * static_cast<double>(parts);
    ColorParam& radiance = scene_.emitters[pending.emitter.index].radiance;
    radiance = product(radiance, Rgb(static_cast<float>(power / emitted)));
  }
}

void Reader::makeTwoSided(size_t index) { LightBacks(scene_).add(index); }

// The sensor's exposure scales the image, and so all light.
void Reader::applySensor() {
  if (imagingRatio_ == 1) return;
  for (Emitter& e : scene_.emitters) {
    if (e.type == EmitterType::environment || e.type == EmitterType::projector)
      e.scale *= imagingRatio_;
    else
      e.radiance = product(e.radiance, Rgb(imagingRatio_));
  }
}

}  // namespace lobelia::io::pbrt
