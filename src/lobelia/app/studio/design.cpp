#include "lobelia/app/studio/design.h"

#include <fmt/format.h>

#include <algorithm>

#include "lobelia/scene/material_parameters.h"
#include "lobelia/scene/surface_hash.h"

namespace lobelia::app {
namespace {

constexpr uint32_t kGone = 0xffffffffu;

// Which of a kind's items stay, and where they go.
class Kept {
 public:
  Kept(size_t count, size_t always) : marks_(count, 0) {
    std::fill_n(marks_.begin(), std::min(count, always), uint8_t{1});
  }
  // True when it is marked only now. Handles of nothing and out of range are nobody's.
  bool mark(uint32_t index) {
    if (index >= marks_.size() || marks_[index] != 0) return false;
    return marks_[index] = 1, true;
  }
  std::vector<uint32_t> places() const {
    std::vector<uint32_t> to(marks_.size(), kGone);
    uint32_t next = 0;
    for (size_t i = 0; i < marks_.size(); ++i)
      if (marks_[i] != 0) to[i] = next++;
    return to;
  }

 private:
  std::vector<uint8_t> marks_;
};

template <class F>
void eachTexture(Material& m, const F& f) {
  eachColorParam(m, [&](ColorParam& p) { f(p.texture); });
  eachFloatParam(m, [&](FloatParam& p) { f(p.texture); });
  for (CapturedLobe& lobe : m.capturedLobes) f(lobe.amplitude.texture), f(lobe.sharpness.texture);
  f(m.clearcoatNormal), f(m.anisotropicDirection), f(m.map);
}
template <class F>
void eachTexture(Emitter& e, const F& f) {
  f(e.radiance.texture), f(e.pattern);
}
template <class F>
void eachTexture(Texture& t, const F& f) {
  f(t.a), f(t.b), f(t.c);
}

template <class Item>
void keep(std::vector<Item>& items, size_t first, const std::vector<uint32_t>& to) {
  for (size_t i = 0; i < to.size(); ++i)
    if (to[i] != kGone && to[i] != i) items[to[i] - first] = std::move(items[i - first]);
  const auto gone = std::count(to.begin(), to.end(), kGone);
  items.erase(items.end() - gone, items.end());
}

}  // namespace

Design designOf(const Scene& scene) {
  Design design;
  design.materials = scene.materials;
  design.textures = scene.textures;
  design.emitters = scene.emitters;
  design.cameras = scene.cameras;
  design.sceneMaterials = static_cast<uint32_t>(scene.materials.size());
  design.sceneTextures = static_cast<uint32_t>(scene.textures.size());
  design.sceneImages = static_cast<uint32_t>(scene.images.size());
  design.sceneEmitters = static_cast<uint32_t>(scene.emitters.size());
  return design;
}

Scene sceneOf(const Design& design) {
  Scene scene;
  scene.materials = design.materials;
  scene.textures = design.textures;
  scene.emitters = design.emitters;
  scene.cameras = design.cameras;
  scene.images.resize(design.sceneImages + design.images.size());  // handles alone count
  return scene;
}

TextureHandle addBitmap(Design& design, std::shared_ptr<StoredImage> image) {
  Texture texture;
  texture.type = TextureType::bitmap;
  texture.image = {design.sceneImages + static_cast<uint32_t>(design.images.size())};
  design.images.push_back(std::move(image));
  design.textures.push_back(texture);
  return {static_cast<uint32_t>(design.textures.size() - 1)};
}

void compact(Design& design) {
  Kept materials(design.materials.size(), design.sceneMaterials);
  Kept textures(design.textures.size(), design.sceneTextures);
  Kept images(design.sceneImages + design.images.size(), design.sceneImages);
  std::vector<uint32_t> open;
  for (uint32_t i = 0; i < design.sceneMaterials; ++i) open.push_back(i);
  std::vector<uint32_t> openTextures;
  for (uint32_t i = 0; i < design.sceneTextures; ++i) openTextures.push_back(i);
  const auto markTexture = [&](TextureHandle h) {
    if (textures.mark(h.index)) openTextures.push_back(h.index);
  };
  while (!open.empty()) {
    Material& m = design.materials[open.back()];
    open.pop_back();
    for (const MaterialHandle h : {m.a, m.b})
      if (materials.mark(h.index)) open.push_back(h.index);
    eachTexture(m, markTexture);
  }
  for (Emitter& e : design.emitters) {
    eachTexture(e, markTexture);
    images.mark(e.image.index);
  }
  while (!openTextures.empty()) {
    Texture& t = design.textures[openTextures.back()];
    openTextures.pop_back();
    eachTexture(t, markTexture);
    images.mark(t.image.index);
  }

  const std::vector<uint32_t> toMaterial = materials.places(), toTexture = textures.places(),
                              toImage = images.places();
  const auto move = [](auto& handle, const std::vector<uint32_t>& to) {
    if (handle.index < to.size()) handle.index = to[handle.index];
  };
  const auto moveTexture = [&](TextureHandle& h) { move(h, toTexture); };
  keep(design.materials, 0, toMaterial);
  keep(design.textures, 0, toTexture);
  // Those of the scene are not in the list.
  keep(design.images, design.sceneImages, toImage);
  for (Material& m : design.materials) {
    move(m.a, toMaterial), move(m.b, toMaterial);
    eachTexture(m, moveTexture);
  }
  for (Texture& t : design.textures) eachTexture(t, moveTexture), move(t.image, toImage);
  for (Emitter& e : design.emitters) eachTexture(e, moveTexture), move(e.image, toImage);
}

std::vector<Emitter> turnedEmitters(const Design& design, double degrees) {
  std::vector<Emitter> emitters = design.emitters;
  if (degrees == 0) return emitters;
  Vec3d axis{0, 1, 0};
  for (const Emitter& e : emitters)
    if (e.type == EmitterType::environment) {
      const Vec3f up = e.toWorld.vector({0, 1, 0});
      axis = {static_cast<double>(up.x), static_cast<double>(up.y), static_cast<double>(up.z)};
      break;
    }
  const Mat4 turn = rotation(axis, degrees);
  for (Emitter& e : emitters) {
    if (e.type != EmitterType::environment && e.type != EmitterType::sun &&
        e.type != EmitterType::directional)
      continue;
    e.toWorld = Transform(turn * e.toWorld.to);
    e.direction = normalize(turn.vector(e.direction));
  }
  return emitters;
}

bool sameLight(const std::vector<Emitter>& a, const std::vector<Emitter>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Emitter& x, const Emitter& y) {
    const bool textured = x.radiance.texture.valid() || x.pattern.valid() ||
                          y.radiance.texture.valid() || y.pattern.valid();
    return !textured && x.type == y.type && x.name == y.name && x.group == y.group &&
           x.toWorld.to == y.toWorld.to && x.radiance.value == y.radiance.value &&
           x.scale == y.scale && x.image == y.image && x.cutoff == y.cutoff &&
           x.beamWidth == y.beamWidth && x.fov == y.fov && x.direction == y.direction &&
           x.angularRadius == y.angularRadius;
  });
}

uint64_t materialsHash(const Design& design) { return surfaceHash(sceneOf(design)); }

std::string someOf(const std::vector<std::string>& names) {
  constexpr size_t kShown = 6;
  std::string text;
  for (size_t i = 0; i < std::min(names.size(), kShown); ++i)
    text += fmt::format("{}'{}'", i == 0 ? "" : ", ", names[i]);
  if (names.size() > kShown) text += fmt::format(" and {} more", names.size() - kShown);
  return text;
}

size_t sizeOf(const Design& design) {
  size_t bytes = design.materials.size() * sizeof(Material) +
                 design.textures.size() * sizeof(Texture) +
                 design.emitters.size() * sizeof(Emitter) + design.cameras.size() * sizeof(Camera);
  for (const Material& m : design.materials) bytes += m.capturedLobes.size() * sizeof(CapturedLobe);
  return bytes;
}

}  // namespace lobelia::app
